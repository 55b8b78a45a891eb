"""A score's files: `report.json`, figures, `report.html`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

from rich.console import Console

from benchmarks.report.gallery.plate import Plate
from benchmarks.report.scores import MM
from benchmarks.report.tables import NONE, Table
from benchmarks.scoring.checks import checked
from benchmarks.scoring.comparison import Comparison, compare, ranks
from benchmarks.scoring.failed import problems, refuse_nobody
from benchmarks.scoring.judge import JudgedRun, Rules
from benchmarks.scoring.report import OFFSET_UNITS, report
from benchmarks.scoring.summary import SubjectSummary, summarise
from benchmarks.scoring.tables import STANDS_OUT, ordered, score_tables
from benchmarks.scoring.verdicts import verdict
from benchmarks.trajectory.offsets import NAMES
from estimators.room import Room

HEADLINES = 6
"""Subjects at the top of the page."""
MAPS = 4
"""Runs that are drawn over the map."""
WORTH_NAMING = {"ms": 1.0, "mm": 1.0, "deg": 0.1}
"""Smaller offsets are not named beneath the tables: many runs tell them from none, but they are the station's."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Result:
    """Everything that a score came to.

    Attributes:
        runs: All of them.
        rules: How they were judged.
        reference: Which reference counts where only one is shown.
        summaries: One per subject.
        comparisons: Of all pairs.
        ranks: By subject.
    """

    runs: Sequence[JudgedRun]
    rules: Rules
    reference: str
    summaries: Sequence[SubjectSummary]
    comparisons: Sequence[Comparison]
    ranks: Mapping[str, int]

    @classmethod
    def of(cls, runs: Sequence[JudgedRun], rules: Rules, reference: str) -> Result:
        """Summarise and compare."""
        summaries = summarise(runs, reference, rules.seed)
        comparisons = compare(runs, reference, rules.seed)
        values = {
            s.name: position.value
            for s in summaries
            if (score := s.by_reference[reference]) and (position := score.scores["position"])
        }
        order = ranks([s.name for s in summaries], values, comparisons)
        return cls(
            runs=runs,
            rules=rules,
            reference=reference,
            summaries=summaries,
            comparisons=comparisons,
            ranks=order,
        )

    def tables(self) -> list[Table]:
        """For terminal and page."""
        return score_tables(
            self.summaries,
            self.comparisons,
            self.ranks,
            self.reference,
            self.rules.align,
            checked(self.runs),
        )

    def problems(self) -> list[str]:
        """What went wrong with whom, and who was not scored in which runs."""
        return problems(self.summaries, self._source)

    def refuse_nobody(self) -> None:
        """Raise `NobodyScoredError` unless somebody was scored."""
        refuse_nobody(self.summaries, self.reference, self._source)

    @property
    def _source(self) -> str:
        """What tells simulated runs from others of the same names."""
        return "" if self.runs[0].turn is None else f" of --seed {self.rules.seed}"

    def json(self, setup: Mapping[str, Any]) -> str:
        """The text of `report.json`."""
        return report(self.summaries, self.comparisons, self.ranks, self.reference, setup, checked(self.runs))


def write_page(folder: Path, result: Result, room: Room, setup: Mapping[str, Any], console: Console) -> None:
    """Write the figures and `report.html`. Needs the extra `report`."""
    from benchmarks.report.html import draw, write_html

    shown = plates(result, room)
    draw(shown, folder, console)
    write_html(
        folder,
        "score",
        [plate.name for plate in shown],
        setup,
        facts=_facts(result),
        tables=result.tables(),
        problems=result.problems(),
        plates=shown,
    )


def plates(result: Result, room: Room) -> list[Plate]:
    """The figures: of the first run of each path, and of all runs together."""
    from benchmarks.figures.score import map_figure, run_pairs, time_figure
    from benchmarks.figures.score_curves import ellipse_figure, ratio_figure, rpe_figure

    reference, rules = result.reference, result.rules
    drawn = [run for run in result.runs if reference in run.references]
    first = list({run.name: run for run in reversed(drawn)}.values())[::-1][:MAPS]
    of_run = [run_pairs(run, reference, rules.align, rules.max_gap) for run in first]
    names = [s.name for s in result.summaries]
    return [
        _plate(
            "ratios",
            "Who may be judged: green, the station is good enough; yellow, it shows the error but stands out itself; "
            "red, it cannot tell. Filled: by its stated covariance, as in a lab; open: by the truth, if known.",
            partial(ratio_figure, result.summaries),
        ),
        _plate(
            "trajectories",
            "Ways over the map, the first run of each path; the station's dashed. Poses off the map are counted.",
            partial(map_figure, first, of_run, room, reference, rules.align),
        ),
        *(
            _plate(
                f"errors-{run.name}",
                "Errors over time, root mean squares over a second. Grey: up to where the station itself may be off, "
                "as it says. An error within the grey cannot be told from the station's.",
                partial(time_figure, run, pairs, reference, rules.align),
            )
            for run, pairs in zip(first, of_run, strict=True)
        ),
        _plate(
            "rpe",
            "Errors of relative motion over the way, less the station's own; bars: 95 %, of these runs. Dashed: "
            "what the station's errors make of a motion, as stated.",
            partial(rpe_figure, result.summaries, reference),
        ),
        _plate(
            "ellipses",
            f"Errors along and across the heading in one run ({first[0].name}), with the ellipses that localizer "
            "and station state.",
            partial(ellipse_figure, of_run[0], names),
        ),
    ]


def _plate(name: str, caption: str, draw: Any) -> Plate:
    return Plate(name=name, section="score", repeats="", caption=caption, draw=draw)


def offset_lines(result: Result) -> list[str]:
    """Which clock offsets, lever arms and frames stand out, and which the runs do not show, by subject."""
    lines = []
    for s in result.summaries:
        score = s.by_reference[result.reference]
        found = score.offsets if score else None
        if found is None:
            continue
        out = [
            f"{name.replace('_', ' ')} {factor * value:z.1f} ± {factor * error:.1f} {unit}"
            for name, value, error, seen in zip(
                NAMES, found.values, found.errors, found.observable, strict=True
            )
            for unit, factor in (OFFSET_UNITS[name],)
            if seen and abs(value) > STANDS_OUT * error and factor * abs(value) > WORTH_NAMING[unit]
        ]
        if out:
            lines.append(f"{s.name}: beyond {STANDS_OUT:g} standard errors: {', '.join(out)}")
        if found.unseen:
            unseen = ", ".join(name.replace("_", " ") for name in found.unseen)
            lines.append(f"{s.name}: not observable (by this path, or for its drift): {unseen}")
    return lines


def _facts(result: Result) -> list[dict[str, str]]:
    facts = []
    for s in ordered(result.summaries, result.ranks, result.reference)[:HEADLINES]:
        score = s.by_reference[result.reference]
        position = score.scores["position"] if score else None
        value = score.ratios["position"] if score else None
        facts.append(
            {
                "what": s.name,
                "value": NONE if position is None else f"{MM * position.value:.1f}",
                "unit": "mm",
                "verdict": verdict(value),
                "ratio": NONE if value is None else f"{value:.1f}\u00a0:\u00a01",
            }
        )
    return facts
