"""Who was not scored, in which runs and why."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from benchmarks.scoring.summary import SubjectSummary
from benchmarks.sweeps.parallel import listed
from estimators.errors import GtEnvError

NAMED: Final = 3
"""How many subjects a message gives the reasons of."""


class NobodyScoredError(GtEnvError):
    """No subject came to a score in any run."""


def problems(summaries: Sequence[SubjectSummary], source: str) -> list[str]:
    """What went wrong with whom, and who was not scored in which runs.

    Args:
        summaries: One per subject.
        source: What tells these runs from others of the same names, as the seed.
    """
    return [line for s in summaries for line in (*s.problems, *_not_scored(s, source))]


def refuse_nobody(summaries: Sequence[SubjectSummary], reference: str, source: str) -> None:
    """Raise unless somebody was scored.

    Args:
        summaries: One per subject.
        reference: The one that counts.
        source: See `problems`.

    Raises:
        NobodyScoredError: If nobody was; it names the first cause of each subject.
    """
    if any(s.by_reference[reference] is not None for s in summaries):
        return
    reasons = [(*s.problems, *s.why_not.values())[0] for s in summaries[:NAMED]]
    more = len(summaries) - NAMED
    raise NobodyScoredError(
        f"nobody could be scored in {listed(list(summaries[0].why_not))}{source}: {'; '.join(reasons)}"
        + (f"; and {more} more" if more > 0 else "")
    )


def _not_scored(s: SubjectSummary, source: str) -> list[str]:
    """One line for each reason."""
    runs: dict[str, list[str]] = {}
    for run, why in s.why_not.items():
        runs.setdefault(why, []).append(run)
    return [f"{s.name}: not scored in {listed(of)}{source}: {why}" for why, of in runs.items()]
