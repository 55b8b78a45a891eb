"""Who is scored: a localizer of this project, somebody's own class or function, or a trajectory file."""

from __future__ import annotations

import importlib
import inspect
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final, Literal

import numpy as np

from benchmarks.rollout import pose_at
from estimators.errors import ConfigError
from estimators.localizers import LOCALIZERS, Guarded, RobotCalibration, as_estimator, embedded_localizer
from estimators.messages import Message, PoseEstimate
from estimators.poses import Array, Pose2
from estimators.room import Room

Kind = Literal["localizer", "import", "file"]
OFFERED: Final = ("start", "robot", "room", "seed")
"""What a class or function that makes a localizer is given, if it has parameters of these names."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Subject:
    """Who is to be scored.

    Attributes:
        name: In tables and in `report.json`.
        kind: Where it comes from.
        target: Name of the localizer, `module:Class`, or path of the file.
        folder: Where imports are looked for, besides the import path.
    """

    name: str
    kind: Kind
    target: str
    folder: str = ""


class Witness:
    """A localizer that is shown the truth, to check the scorer itself: it is no localizer.

    Args:
        localizer: With `reset()`, `update(message)` and `observe_truth(stamp, pose)`.

    Attributes:
        truth: (N, 4) t [s], x, y [m], yaw [rad] around the stamps of the next messages.
    """

    def __init__(self, localizer: Any) -> None:
        self._localizer = localizer
        self.truth: Array = np.empty((0, 4))

    def reset(self) -> None:
        """Reset the localizer."""
        self._localizer.reset()

    def update(self, message: Message) -> PoseEstimate | None:
        """Show it the true pose at the stamp of the message, then the message."""
        if len(self.truth):
            pose = pose_at(np.array([message.stamp]), self.truth[:, 0], self.truth[:, 1:])[0]
            self._localizer.observe_truth(message.stamp, pose)
        answer: PoseEstimate | None = self._localizer.update(message)
        return answer


def parse_subject(text: str, folder: Path) -> Subject:
    """What a SUBJECT of the command line stands for.

    Args:
        text: A name of `LOCALIZERS`, `module:Class`, `module:function`, or `NAME=` and one of these or the path
            of a trajectory file.
        folder: Where imports are looked for first.

    Raises:
        ConfigError: If it is none of these.
    """
    name, equals, target = text.partition("=")
    target = target if equals else name
    if not name or not target:
        raise ConfigError(f"SUBJECT {text!r}: must be {_allowed()}")
    if target in LOCALIZERS:
        return Subject(name=name, kind="localizer", target=target)
    module, colon, attribute = target.partition(":")
    if colon and all(part.isidentifier() for part in (*module.split("."), attribute)):
        subject = Subject(name=name, kind="import", target=target, folder=str(folder))
        thing = _imported(subject)
        if _wanted(thing) is None:
            as_estimator(thing)
        return subject
    if equals:
        return Subject(name=name, kind="file", target=target)
    raise ConfigError(f"SUBJECT {text!r}: must be {_allowed()}")


def all_subjects(
    texts: Sequence[str], trajectories: Sequence[str], folder: Path, default: bool
) -> tuple[Subject, ...]:
    """Everybody who is to be scored.

    Args:
        texts: See `parse_subject`.
        trajectories: As NAME=FILE.
        folder: Where imports are looked for first.
        default: Whether to take all localizers of this project if nobody is named.

    Raises:
        ConfigError: If one cannot be, a name is there twice, or there is nobody.
    """
    found = [parse_subject(text, folder) for text in texts]
    for text in trajectories:
        name, equals, file = text.partition("=")
        if not (name and equals and file):
            raise ConfigError(f"--trajectory {text}: must be NAME=FILE")
        found.append(Subject(name=name, kind="file", target=file))
    if not found and default:
        found = [parse_subject(name, folder) for name in LOCALIZERS]
    names = [s.name for s in found]
    twice = sorted({name for name in names if names.count(name) > 1})
    if twice:
        raise ConfigError(f"SUBJECT {twice[0]}: is there twice: give one another name, as NAME={twice[0]}")
    if not found:
        raise ConfigError("--gt: needs trajectory files as NAME=FILE to compare with it")
    return tuple(found)


def make_localizer(
    subject: Subject, robot: RobotCalibration, room: Room, start: Pose2 | None, seed: int
) -> Guarded:
    """The localizer of a subject that is no file, guarded.

    Args:
        subject: Whose.
        robot: What the robot believes of itself.
        room: The map that it has.
        start: Where it starts; None if that is not known.
        seed: Of its own randomness.

    Raises:
        ConfigError: If it cannot be made.
    """
    if subject.kind == "localizer":
        made: Any = embedded_localizer(subject.target, robot, room, start, seed)
    else:
        thing = _imported(subject)
        try:
            made = _made(thing, {"start": start, "robot": robot, "room": room, "seed": seed})
        except ConfigError:
            raise
        except (Exception, SystemExit) as error:  # somebody's constructor may do anything
            raise ConfigError(f"SUBJECT {subject.name}: cannot be made: {_words(error)}") from None
        if getattr(made, "wants_truth", False):
            made = Witness(made)
    return Guarded(made, subject.name)


def _made(thing: Any, offered: Mapping[str, Any]) -> Any:
    """A localizer made of what was imported, which is given what it asks for by name."""
    names = _wanted(thing)
    return as_estimator(thing if names is None else thing(**{name: offered[name] for name in names}))


def _wanted(thing: Any) -> tuple[str, ...] | None:
    """Which of `OFFERED` something that makes localizers has parameters for; None if it has none or wants others.

    Raises:
        ConfigError: If it is a class that cannot be made.
    """
    if not callable(thing) or not (inspect.isclass(thing) or inspect.isfunction(thing)):
        return None
    parameters = inspect.signature(thing).parameters.values()
    names = tuple(p.name for p in parameters if p.name in OFFERED)
    others = [
        p.name for p in parameters if p.default is p.empty and p.name not in OFFERED and p.kind not in _REST
    ]
    if inspect.isclass(thing) and others:
        raise ConfigError(
            f"SUBJECT {thing.__name__}: wants {', '.join(others)}: a class may have parameters of the names "
            f"{', '.join(OFFERED)}, and others only with defaults"
        )
    return names if names and not others else None


_REST: Final = (inspect.Parameter.VAR_POSITIONAL, inspect.Parameter.VAR_KEYWORD)


def _imported(subject: Subject) -> Any:
    if subject.folder not in sys.path:
        sys.path.insert(0, subject.folder)
    module, _, attribute = subject.target.partition(":")
    try:
        return getattr(importlib.import_module(module), attribute)
    except AttributeError:
        raise ConfigError(f"SUBJECT {subject.target}: module {module} has no {attribute!r}") from None
    except (Exception, SystemExit) as error:  # somebody's module may do anything when it is imported
        raise ConfigError(f"SUBJECT {subject.target}: cannot be imported: {_words(error)}") from None


def _words(error: BaseException) -> str:
    return " ".join(f"{type(error).__name__}: {error}".split())


def _allowed() -> str:
    return f"one of {', '.join(LOCALIZERS)}, MODULE:CLASS, MODULE:FUNCTION, or NAME=FILE beside a recording"
