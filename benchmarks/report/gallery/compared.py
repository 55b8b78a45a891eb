"""The figures of harder drives, of other rooms, targets and rangefinders, and of other robots."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import partial

from benchmarks.figures.compared import Panel, compared_figure
from benchmarks.figures.style import PUBLISHED, method_color
from benchmarks.metrics import Score
from benchmarks.report.gallery.plate import Plate
from benchmarks.report.scores import DEGREES, MM, Scores, times
from benchmarks.validation.consistency import Consistency
from benchmarks.validation.goals import ELSEWHERE
from benchmarks.validation.robots import RobotScores
from benchmarks.validation.rooms import RoomScores

READ = (
    "RMSE of the position, mean absolute error of the heading, and NEES, one sample of each run; grey: between what "
    "that of an honest covariance lies in 998 of 1000 cases."
)
ONE_SCAN = "one scan"


def stress_plates(scores: Scores) -> Iterator[Plate]:
    """One figure, if there was anything harder."""
    kinds = list(next(iter(scores.stress.values()), {}))
    if kinds:
        by_kind = [{m: scores.stress[m][kind] for m in scores.methods} for kind in kinds]
        judged = [scores.stress_honesty[kind] for kind in kinds]
        yield Plate(
            name="stress",
            section="stress",
            repeats="",
            caption="Harder drives. " + READ,
            draw=partial(compared_figure, kinds, _panels(by_kind, judged), _colors(scores.methods)),
        )


def room_plates(rooms: RoomScores) -> Iterator[Plate]:
    """One figure."""
    names, of = list(rooms.settings), list(rooms.settings.values())
    if not of:
        return
    ratios = [[s.over_limit for s in setting.scans.values() if s.over_limit is not None] for setting in of]
    worst = Panel(
        title="one scan / limit",
        values={ONE_SCAN: [max(found, default=None) for found in ratios]},
        log=False,
        lines=(1.0, ELSEWHERE),
    )
    panels = [worst, *_panels([s.driving for s in of], [s.honesty for s in of])]
    yield Plate(
        name="rooms",
        section="rooms",
        repeats="",
        caption="Left: RMSE of one scan over its limit at the worst point; dashed: the limit, and "
        f"{ELSEWHERE:g} times it. Others: robots that drive about at random. " + READ,
        draw=partial(compared_figure, names, panels, {ONE_SCAN: PUBLISHED, **_colors(tuple(of[0].driving))}),
    )


def robot_plates(robots: RobotScores) -> Iterator[Plate]:
    """One figure."""
    names, of = list(robots.robots), list(robots.robots.values())
    if of:
        yield Plate(
            name="robots",
            section="robots",
            repeats="",
            caption="Several robots on the same ways. " + READ,
            draw=partial(
                compared_figure,
                names,
                _panels([s.driving for s in of], [s.honesty for s in of]),
                _colors(tuple(of[0].driving)),
            ),
        )


def _colors(methods: Sequence[str]) -> dict[str, str]:
    return {m: method_color(m) for m in methods}


def _panels(
    scores: Sequence[Mapping[str, Score]], judged: Sequence[Mapping[str, Consistency]]
) -> list[Panel]:
    """Of the errors and of how honest they are, a row per drive or setting."""
    panels = [
        Panel(
            title="RMSE [mm]",
            values=_by_method([{m: times(s.rmse_xy, MM) for m, s in of.items()} for of in scores]),
        ),
        Panel(
            title="heading [deg]",
            values=_by_method([{m: times(s.mae[2], DEGREES) for m, s in of.items()} for of in scores]),
        ),
    ]
    poses = [{m: c.nees["pose"] for m, c in of.items()} for of in judged]
    if all(poses):
        first = [next(iter(of.values())) for of in poses]
        panels.append(
            Panel(
                title="NEES (3)",
                values=_by_method([{m: n.mean for m, n in of.items()} for of in poses]),
                bands=[(n.low, n.high) for n in first],
                lines=(3.0,),
            )
        )
    return panels


def _by_method(rows: Sequence[Mapping[str, float | None]]) -> dict[str, list[float | None]]:
    methods = dict.fromkeys(m for row in rows for m in row)
    return {m: [row.get(m) for row in rows] for m in methods}
