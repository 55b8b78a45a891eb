"""One run, judged: every subject against the station, and against the truth where it is known."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from benchmarks.scoring.errors import RunErrors, run_errors
from benchmarks.scoring.reference_errors import ReferenceErrors, reference_errors
from benchmarks.scoring.station import REFERENCES, Histories, Station, calibrated_to
from benchmarks.scoring.watch import Answers
from benchmarks.trajectory.alignment import Alignment
from benchmarks.trajectory.association import MAX_GAP, Pairs, associate
from benchmarks.trajectory.offsets import Offsets, estimate_offsets
from benchmarks.trajectory.trajectory import Flags, Trajectory, TrajectoryError
from estimators.poses import Array

TRUTH_GAP = 0.1
"""True poses farther apart than this are not interpolated [s]: the recording was paused there."""
TRUE_START = "the true pose"
"""Where localizers start whenever that is known."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Rules:
    """How runs are judged.

    Attributes:
        align: The alignment.
        max_gap: Up to which the reference is interpolated [s].
        seed: Of the error histories, the bootstrap and the localizers' own randomness.
        calibration: Standard deviations of the station's calibration, position [mm] and yaw [deg].
    """

    align: Alignment = "none"
    max_gap: float = MAX_GAP
    seed: int = 0
    calibration: tuple[float, float] = (0.0, 0.0)

    def station(self, reference: str) -> Station:
        """With the error model of one of `REFERENCES`."""
        return Station(model=calibrated_to(REFERENCES[reference], *self.calibration), seed=self.seed)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Judged:
    """A subject in one run against one reference.

    Attributes:
        errors: All of them; None where there is nothing to compare.
        why_not: Why there is nothing.
        availability: Share of the reference's stamps at which the subject had something valid to say.
        offsets: Clock, lever arm and frame, as far as the run shows them; None where there is nothing.
    """

    errors: RunErrors | None
    why_not: str
    availability: float
    offsets: Offsets | None


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class JudgedRun:
    """One run.

    Attributes:
        name: Of the path or the recording.
        turn: Which run of its path, counted from 0; None for a recording.
        judged: By reference, then by subject.
        answers: By subject.
        references: By name.
        truth: Where it is known.
        reference_errors: By reference, likewise.
        start: Where localizers were told that they start, in words; "" if none was told.
    """

    name: str
    turn: int | None
    judged: Mapping[str, Mapping[str, Judged]]
    answers: Mapping[str, Answers]
    references: Mapping[str, Trajectory] = field(default_factory=dict)
    truth: Trajectory | None = None
    reference_errors: Mapping[str, ReferenceErrors] = field(default_factory=dict)
    start: str = ""

    @property
    def called(self) -> str:
        """What it is called in reports and messages."""
        return called(self.name, self.turn)

    def without_series(self) -> JudgedRun:
        """The same for the numbers alone."""
        answers = {name: said.without_series() for name, said in self.answers.items()}
        return replace(self, answers=answers, references={}, truth=None)


def called(name: str, turn: int | None) -> str:
    """A run by its path and its number among the runs of that path, as the file is called that it is recorded in."""
    return name if turn is None else f"{name}-{turn}"


def judge(
    name: str,
    turn: int | None,
    number: int,
    answers: Mapping[str, Answers],
    references: Mapping[str, Trajectory],
    truth: Array,
    rules: Rules,
    start: str = "",
) -> JudgedRun:
    """Judge one run.

    Args:
        name: Of the path or recording.
        turn: Which run of its path; None for a recording.
        number: Of the run among all.
        answers: By subject.
        references: By reference.
        truth: (N, 4) t [s], x, y [m], yaw [rad]; (0, 4) where it is not known.
        rules: How.
        start: Where localizers were told that they start, in words.

    Raises:
        TrajectoryError: If an alignment is asked for that a run does not determine.
    """
    true = Trajectory.of_poses(truth[:, 0], truth[:, 1:], origin="true") if len(truth) else None
    judged = {}
    for reference, trajectory in references.items():
        histories = rules.station(reference).histories(trajectory, number)
        judged[reference] = {
            subject: _judged(said, trajectory, histories, true, rules) for subject, said in answers.items()
        }
    erred = {
        r: found
        for r, said in references.items()
        if true is not None and (found := reference_errors(said, true, TRUTH_GAP)) is not None
    }
    return JudgedRun(
        name=name,
        turn=turn,
        judged=judged,
        answers=answers,
        references=references,
        truth=true,
        reference_errors=erred,
        start=start,
    )


def _judged(
    said: Answers, reference: Trajectory, histories: Histories, true: Trajectory | None, rules: Rules
) -> Judged:
    moments = reference.stamps[reference.valid]
    availability = said.availability(moments)
    try:
        pairs = associate(reference, said.trajectory, rules.max_gap)
    except TrajectoryError as error:
        return Judged(errors=None, why_not=str(error), availability=availability, offsets=None)
    there = None
    if true is not None:
        there = true.at(pairs.stamps, TRUTH_GAP)
        if not there.valid.all():  # a pause in the recording: judged where everything is known
            pairs = _kept(pairs, there.valid)
            there = there.where(there.valid) if len(pairs) else None
    if not len(pairs):
        return Judged(
            errors=None,
            why_not="the truth is not known when it spoke",
            availability=availability,
            offsets=None,
        )
    return Judged(
        errors=run_errors(pairs, histories, rules.align, there),
        why_not="",
        availability=availability,
        offsets=estimate_offsets(reference, said.trajectory, rules.max_gap),
    )


def _kept(pairs: Pairs, chosen: Flags) -> Pairs:
    return Pairs(reference=pairs.reference.where(chosen), estimate=pairs.estimate.where(chosen))
