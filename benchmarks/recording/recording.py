"""What a recording holds once it is read, from whatever format."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import TypeVar, overload

import numpy as np

from benchmarks.recording.frames import StoredFrame
from estimators.messages import LaserScan, Message
from estimators.poses import Array
from gt_env.config import EnvConfig

MessageT = TypeVar("MessageT", bound=Message)


def delivery(message: Message | StoredFrame) -> float:
    """When a message is there [s]: a swept scan is stamped at its first beam and delivered after its last."""
    if isinstance(message, LaserScan):
        return message.stamp + message.time_increment * (len(message.ranges) - 1)
    return message.stamp


class MessageLog(Sequence[Message]):
    """Messages in the order of delivery; frames are decoded each time they are asked for.

    Args:
        stored: Messages, and frames still in their PNG.
    """

    def __init__(self, stored: Iterable[Message | StoredFrame] = ()) -> None:
        self.stored = tuple(stored)

    def __len__(self) -> int:
        return len(self.stored)

    @overload
    def __getitem__(self, index: int) -> Message: ...
    @overload
    def __getitem__(self, index: slice) -> MessageLog: ...
    def __getitem__(self, index: int | slice) -> Message | MessageLog:
        if isinstance(index, slice):
            return MessageLog(self.stored[index])
        item = self.stored[index]
        return item.decoded() if isinstance(item, StoredFrame) else item

    def of_source(self, prefix: str) -> MessageLog:
        """Those messages whose source starts with `prefix`."""
        return MessageLog(m for m in self.stored if m.source.startswith(prefix))

    def of_type(self, kind: type[MessageT]) -> list[MessageT]:
        """Those messages that are of a type other than frames."""
        return [m for m in self.stored if isinstance(m, kind)]

    @property
    def frames(self) -> MessageLog:
        """The camera's frames."""
        return MessageLog(m for m in self.stored if isinstance(m, StoredFrame))

    @property
    def frame_count(self) -> int:
        """How many camera frames there are."""
        return sum(isinstance(m, StoredFrame) for m in self.stored)


def _no_truth() -> Array:
    return np.empty((0, 4))


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Recording:
    """One run of a station.

    Attributes:
        origin: File or folder that it was read from.
        messages: What the sensors said, in the order of delivery.
        truth: (N, 4) stamp [s], x, y [m], yaw [rad] of the robot, stamps increasing; (0, 4) where not known.
        config: What was simulated, or what is known of a real station; None if nothing was recorded.
        tool: What wrote it.
    """

    origin: str
    messages: MessageLog
    truth: Array = field(default_factory=_no_truth)
    config: EnvConfig | None = None
    tool: str = ""
