"""Runs put together: one score per subject and reference."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from benchmarks.scoring.bootstrap import Units, expected_interval, sums, units
from benchmarks.scoring.judge import JudgedRun
from benchmarks.scoring.quantities import Corrected, Quantity, corrected
from benchmarks.scoring.station import DOUBT
from benchmarks.scoring.verdicts import Verdict, ratios, verdict
from benchmarks.trajectory.offsets import Offsets, combined

Interval = tuple[float, float]


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Score:
    """A subject against one reference, over all runs in which there was something to compare.

    Attributes:
        runs: How many.
        scores: Root mean squared errors by quantity; None where there was no sample.
        expected: The interval of what very many such runs would bring, by quantity; empty where too few to say.
        ratios: Localizer over station, by what is judged.
        true_ratios: The same from errors as they were.
        nees: Of the localizer's covariance and the station's together; 3 is honest.
        nees_true: Of the localizer's, against the truth.
        end_drift: Mean over the runs of how wrong the motion from first to last pose is [m].
        way: Mean of the ways [m].
        offset: Mean error along and across the heading and of the yaw [m, m, rad].
        offsets: Clock, lever arm and frame.
    """

    runs: int
    scores: Mapping[str, Corrected | None]
    expected: Mapping[str, Interval]
    ratios: Mapping[str, float | None]
    true_ratios: Mapping[str, float | None]
    nees: float | None
    nees_true: float | None
    end_drift: float
    way: float
    offset: tuple[float, float, float]
    offsets: Offsets | None

    @property
    def verdicts(self) -> dict[str, Verdict]:
        """From the station's stated covariance."""
        return {judged: verdict(value) for judged, value in self.ratios.items()}

    @property
    def true_verdicts(self) -> dict[str, Verdict]:
        """As they would be if everything were known."""
        return {judged: verdict(value) for judged, value in self.true_ratios.items()}


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class SubjectSummary:
    """All about one subject.

    Attributes:
        name: Of the subject.
        by_reference: Its scores; None where there was nothing to compare.
        by_path: The same of each path alone, against the chosen reference.
        availability: Mean over all runs, also those without anything to compare.
        latency: Mean and largest age of its answers when they were given [s]; None if it gave none.
        update_time: Processor time of an update on this machine [s]; None if it did not run here.
        problems: One line for each kind of failure.
        why_not: Why runs are missing, by run.
        by_run: Position and yaw of each run alone, against the chosen reference.
    """

    name: str
    by_reference: Mapping[str, Score | None]
    by_path: Mapping[str, Score | None]
    availability: float
    latency: tuple[float, float] | None
    update_time: float | None
    problems: tuple[str, ...]
    why_not: Mapping[str, str]
    by_run: Mapping[str, Mapping[str, Corrected | None]]


def summarise(runs: Sequence[JudgedRun], reference: str, seed: int = 0) -> list[SubjectSummary]:
    """Put runs together.

    Args:
        runs: At least one.
        reference: Which reference counts where only one is shown.
        seed: Of the bootstrap.
    """
    return [_subject(name, runs, reference, seed) for name in runs[0].answers]


def _subject(name: str, runs: Sequence[JudgedRun], reference: str, seed: int) -> SubjectSummary:
    answers = [run.answers[name] for run in runs]
    ages = np.concatenate([a.latencies() for a in answers])
    timed = [a for a in answers if a.seconds is not None and a.updates]
    seconds = sum(a.seconds or 0.0 for a in timed) / sum(a.updates for a in timed) if timed else None
    chosen = [run.judged[reference][name] for run in runs]
    paths = dict.fromkeys(run.name for run in runs)
    return SubjectSummary(
        name=name,
        by_reference={r: _score(name, runs, r, seed) for r in runs[0].judged},
        by_path={p: _score(name, [r for r in runs if r.name == p], reference, seed) for p in paths},
        availability=float(np.mean([j.availability for j in chosen])),
        latency=(float(ages.mean()), float(ages.max())) if len(ages) else None,
        update_time=seconds,
        problems=_problems(name, runs),
        why_not={r.called: j.why_not for r, j in zip(runs, chosen, strict=True) if j.errors is None},
        by_run={
            r.called: {q: corrected([j.errors.quantities[q]], DOUBT) for q in ("position", "yaw")}
            for r, j in zip(runs, chosen, strict=True)
            if j.errors is not None
        },
    )


def _score(name: str, runs: Sequence[JudgedRun], reference: str, seed: int) -> Score | None:
    there = [(run.name, run.judged[reference][name]) for run in runs]
    there = [(path, judged) for path, judged in there if judged.errors is not None]
    if not there:
        return None
    errors = [judged.errors for _, judged in there if judged.errors is not None]
    quantities = {q: [e.quantities[q] for e in errors] for q in errors[0].quantities}
    scores = {q: corrected(of, DOUBT) for q, of in quantities.items()}
    resampled = units([path for path, _ in there])
    nees = [e.nees for e in errors if e.nees is not None]
    nees_true = [e.nees_true for e in errors if e.nees_true is not None]
    along, cross, yaw = np.nanmean(np.array([e.offset for e in errors]), axis=0).tolist()
    return Score(
        runs=len(errors),
        scores=scores,
        expected=_expected(quantities, scores, resampled, seed),
        ratios=ratios(scores),
        true_ratios=ratios(scores, of_truth=True),
        nees=float(np.mean(nees)) if nees else None,
        nees_true=float(np.mean(nees_true)) if nees_true else None,
        end_drift=float(np.mean([e.end_drift for e in errors])),
        way=float(np.mean([e.way for e in errors])),
        offset=(along, cross, yaw),
        offsets=combined([j.offsets for _, j in there if j.offsets is not None]),
    )


def _expected(
    quantities: Mapping[str, Sequence[Quantity]],
    scores: Mapping[str, Corrected | None],
    by: Units | None,
    seed: int,
) -> dict[str, Interval]:
    found: dict[str, Interval] = {}
    for name, of in quantities.items():
        score = scores[name]
        if by is None or score is None or any(q.n == 0 for q in of):
            continue
        found[name] = expected_interval(sums(of), by, score.value, score.stated, seed)
    return found


def _problems(name: str, runs: Sequence[JudgedRun]) -> tuple[str, ...]:
    """One line for each kind of failure: how often, of how many messages, in how many runs, and the first."""
    answers = [run.answers[name] for run in runs]
    total: dict[str, int] = {}
    within: dict[str, int] = {}
    first: dict[str, str] = {}
    for said in answers:
        for (reason, count), words in zip(said.failures, sorted(said.problems), strict=False):
            total[reason] = total.get(reason, 0) + count
            within[reason] = within.get(reason, 0) + 1
            first.setdefault(reason, words.partition("; first ")[2])
    updates = sum(a.updates for a in answers)
    return tuple(
        f"{name}: {reason}, {count} x of {updates} messages, in {within[reason]} of {len(runs)} runs; first "
        f"{first[reason]}"
        for reason, count in total.items()
    )
