"""Localizers of other people's: whatever they do, the run goes on, and what they did is counted."""

from __future__ import annotations

import inspect
import re
from collections import Counter
from collections.abc import Callable
from dataclasses import replace
from time import perf_counter
from typing import Any, Final

import numpy as np

from estimators.errors import ConfigError, MeasurementError
from estimators.messages import NO_COVARIANCE, Message, PoseEstimate
from estimators.poses import Array, Pose2
from estimators.protocol import Estimator

ROBOT: Final = "robot/"
"""What the sources of the messages begin with that a localizer hears."""
LATEST: Final = 0.5
"""An answer older than this against the message that it answers is late [s]."""
FARTHEST: Final = 1e8
"""No position is farther from the origin, not even on a map of the Earth [m]."""

RAISED, NOT_FINITE, MALFORMED, LATE, AHEAD, BACKWARDS = (
    "raised", "not finite", "malformed", "late", "ahead of time", "backwards in time"
)  # fmt: skip


class FunctionEstimator:
    """A plain function from message to pose as an estimator.

    Args:
        function: Answers a message with a `PoseEstimate`, with x, y [m], yaw [rad], or with None. Three
            numbers count at the stamp of the message; they state no covariance, which 1e6 I stands for.
    """

    def __init__(self, function: Callable[[Message], Any]) -> None:
        self._function = function

    def reset(self) -> None:
        """Nothing that a function could forget."""

    def update(self, message: Message) -> PoseEstimate | None:
        """Ask the function."""
        answer = self._function(message)
        if answer is None or isinstance(answer, PoseEstimate):
            return answer
        return PoseEstimate(stamp=message.stamp, pose=Pose2.of(answer), covariance=NO_COVARIANCE * np.eye(3))


def as_estimator(localizer: Any) -> Estimator:
    """Whatever somebody hands over for a localizer, as an estimator.

    Args:
        localizer: An object with `reset` and `update`; a class or a function without arguments that makes
            one; or a function from message to pose.

    Raises:
        ConfigError: If it is none of these.
    """
    if not inspect.isclass(localizer) and _answers(localizer):
        return localizer  # type: ignore[no-any-return]
    if callable(localizer):
        if not _takes_nothing(localizer):
            if inspect.isclass(localizer):
                raise ConfigError(f"localizer {localizer.__name__}: its class must take no argument")
            return FunctionEstimator(localizer)
        made = localizer()
        if _answers(made):
            return made  # type: ignore[no-any-return]
    raise ConfigError(
        f"localizer = {localizer!r}: must have reset() and update(message), make something that has, or be "
        f"a function from message to pose"
    )


def _answers(thing: Any) -> bool:
    return all(callable(getattr(thing, name, None)) for name in ("reset", "update"))


def _takes_nothing(function: Callable[..., Any]) -> bool:
    try:
        parameters = inspect.signature(function).parameters.values()
    except (TypeError, ValueError):  # some built-in ones do not say
        return False
    return not any(
        p.default is p.empty and p.kind not in (p.VAR_POSITIONAL, p.VAR_KEYWORD) for p in parameters
    )


class Guarded:
    """A localizer whose failures are answered by an invalid estimate and counted by reason.

    It hears the robot's messages only. An exception, a pose or covariance that is not finite, a position off the
    Earth, an answer of another type, one that is late against its message or ahead of it, and one that goes
    backwards in time make the localizer unavailable until its next good answer; `estimate` then is the last good
    one, marked invalid.

    Args:
        localizer: See `as_estimator`.
        name: What the problems are reported under.
        latest: Largest age of an answer against its message [s].

    Attributes:
        failures: How often each thing went wrong since the last reset, by reason.
        first_words: What was said the first time, by reason.
        updates: Messages that it was given since then.
        seconds: What it took for them [s], on this machine's clock.
        estimate: What there is to say now.
    """

    def __init__(self, localizer: Any, name: str = "localizer", latest: float = LATEST) -> None:
        self.localizer = as_estimator(localizer)
        self.name = name
        self._latest = latest
        self._clear()

    def _clear(self) -> None:
        self.failures: Counter[str] = Counter()
        self.first_words: dict[str, str] = {}
        self.updates = 0
        self.seconds = 0.0
        self.estimate = PoseEstimate.unknown()

    def reset(self) -> None:
        """Start anew, with a localizer that is reset, if it can be."""
        self._clear()
        try:
            self.localizer.reset()
        except (Exception, SystemExit) as error:
            self._fail(RAISED, f"reset: {_words(error)}")

    def update(self, message: Message) -> PoseEstimate | None:
        """Give the localizer a message; its answer, an invalid one where it failed, or None."""
        if not message.source.startswith(ROBOT):
            return None
        self.updates += 1
        before = perf_counter()
        try:
            answer: Any = self.localizer.update(message)
        except (Exception, SystemExit) as error:
            reason = NOT_FINITE if _speaks_of_finiteness(error) else RAISED
            return self._fail(reason, f"at {message.stamp:g} s: {_words(error)}")
        finally:
            self.seconds += perf_counter() - before
        if answer is None:
            return None
        problem = self._problem(message, answer)
        if problem is not None:
            return self._fail(*problem)
        self.estimate = answer
        return self.estimate

    @property
    def problems(self) -> list[str]:
        """One line for each kind of failure: who, what, how often, and the first one's words."""
        return [
            f"{self.name}: {reason}, {count} x of {self.updates} messages; first {self.first_words[reason]}"
            for reason, count in self.failures.items()
        ]

    def _problem(self, message: Message, answer: Any) -> tuple[str, str] | None:
        at = f"at {message.stamp:g} s"
        if not isinstance(answer, PoseEstimate):
            return MALFORMED, f"{at}: {type(answer).__name__} in place of a PoseEstimate"
        if not np.isfinite(answer.stamp):
            return NOT_FINITE, f"{at}: stamp {answer.stamp}"
        if not max(abs(answer.pose.x), abs(answer.pose.y)) <= FARTHEST:
            return MALFORMED, f"{at}: a position of {answer.pose.x:g}, {answer.pose.y:g} m"
        if answer.stamp > message.stamp + 1e-9:
            return AHEAD, f"{at}: stamp {answer.stamp:g} s"
        if self.estimate.stamp >= 0 and answer.stamp < self.estimate.stamp - 1e-9:
            return BACKWARDS, f"{at}: stamp {answer.stamp:g} s after {self.estimate.stamp:g} s"
        if answer.valid and answer.stamp < message.stamp - self._latest:
            return LATE, f"{at}: stamp {answer.stamp:g} s"
        if _smallest_eigenvalue(answer.covariance) < 0:
            return MALFORMED, f"{at}: a covariance with a negative eigenvalue"
        return None

    def _fail(self, reason: str, words: str) -> PoseEstimate:
        self.failures[reason] += 1
        self.first_words.setdefault(reason, words)
        self.estimate = replace(self.estimate, valid=False, yaw_valid=False)
        return self.estimate


def _words(error: BaseException) -> str:
    return " ".join(f"{type(error).__name__}: {error}".split())


def _speaks_of_finiteness(error: BaseException) -> bool:
    """Whether a message type has refused a NaN that the localizer put into it."""
    return isinstance(error, MeasurementError) and re.search(r"\b(nan|inf)\b", str(error)) is not None


def _smallest_eigenvalue(covariance: Array) -> float:
    """Over the largest, beyond rounding."""
    values = np.linalg.eigvalsh(covariance)
    return float(min(values[0] + 1e-9 * max(values[-1], 0.0), 0.0))
