"""What a validation comes to, one column per method; and its scans beside their limit, and the harder drives."""

from __future__ import annotations

from collections.abc import Iterator

from benchmarks.consistency import Consistency
from benchmarks.experiments.scans import TOGETHER
from benchmarks.experiments.stress import SECONDS
from benchmarks.metrics import Score, root_mean_square
from benchmarks.report.scores import MM, Scores, least_valid, times
from benchmarks.report.tables import NONE, Table, angle, named, number
from benchmarks.validation import DITHERED, STILL

SCORED = ("RMSE [mm]", "max [mm]", "heading [deg]", "99 % [deg]", "valid [%]", "NEES")
"""Heads of the columns that `_cells` fills."""
COMPARED = ("swept", "slip", "uneven-slip")
"""Hard drives that are the usual ones but for one thing."""
HARD = (
    "Robots are steered along their way by somebody who sees them. usual: path, tour and figure of eight; swept: the "
    "same with scans that take half their period; slip: with wheels that lose 5 % of their way; uneven-slip: each "
    "wheel a random 2 % more or less, anew every 0.1 m; fast: 1.2 m/s at 2 m or more from the camera; whirl: "
    "360 deg/s on the spot. heading: mean absolute error. more: RMSE beside that of the usual drives. "
)


def summary_table(scores: Scores) -> Table:
    """The figures that tell most."""
    return Table(
        title="At a glance: errors of the station by method",
        head=("", *scores.methods),
        rows=tuple(_rows(scores)),
        note="RMSE: root mean square of the distance in the plane. 99 %: of the errors are smaller. Dithered: the "
        "camera sweeps by 0.3 deg to either side, so that a target at rest is seen by other pixels each frame. "
        "valid: share of the time from 2 s after a start with nothing known, in the worst drive.",
        section="summary",
    )


def drive_table(scores: Scores) -> Table:
    """Every drive, those that the thesis did not make as well."""
    drives = next(iter(scores.moving.values()))
    rows = [
        (*named(drive, method, scores), *score_cells(scores.moving[method][drive]))
        for drive in drives
        for method in scores.methods
    ]
    return Table(
        title="Every drive",
        head=(*named("drive", "method", scores), *SCORED),
        rows=tuple(rows),
        note="99 %: of the errors of the heading are smaller. valid: share of the time from 2 s after the start. NEES: "
        "over x, y, heading and time; 3 for an honest covariance, - for a method that states none.",
        section="moving",
    )


def blind_table(scores: Scores) -> Table:
    """The drives that go somewhere, seen by the rangefinder alone."""
    rows = [
        (drive, method, *_mm_cells(s), number(times(s.valid_later, 100), 1))
        for drive in next(iter(scores.alone.values()))
        for method in scores.alone
        for s in (scores.alone[method][drive],)
    ]
    totals = [
        ("all", m, *_mm_cells(s), number(times(s.valid_later, 100), 1))
        for m, s in scores.alone_travels.items()
    ]
    return Table(
        title="Without the camera",
        head=("drive", "method", *SCORED[:2], "valid [%]"),
        rows=(*rows, *totals),
        totals=len(totals),
        note="The same drives and the same scans, position only.",
        section="moving",
    )


def _mm_cells(s: Score) -> tuple[str, str]:
    return _mm(s.rmse_xy), _mm(s.max_xy)


def _rows(scores: Scores) -> Iterator[tuple[str, ...]]:
    methods = scores.methods
    for kind, said in ((STILL, ""), (DITHERED, ", dithered")):
        of = [scores.rest[m][kind] for m in methods if kind in scores.rest[m]]
        if of:
            yield f"at rest after 10 s{said}: RMSE [mm]", *(_mm(s.rmse_xy) for s in of)
            yield f"at rest after 10 s{said}: heading, mean error [deg]", *(angle(s.mae[2]) for s in of)
    travels = [scores.travels[m] for m in methods]
    yield "path, tour, figure of eight: RMSE [mm]", *(_mm(s.rmse_xy) for s in travels)
    yield "path, tour, figure of eight: largest error [mm]", *(_mm(s.max_xy) for s in travels)
    yield "path, tour, figure of eight: heading, mean error [deg]", *(angle(s.mae[2]) for s in travels)
    yield "path, tour, figure of eight: heading, 99 % [deg]", *(angle(s.p99_yaw) for s in travels)
    for drive, said in (("spin", ""), ("spin-dithered", ", dithered")):
        if drive in scores.moving[methods[0]]:
            turned = [scores.moving[m][drive] for m in methods]
            yield (
                f"turning on the spot{said}: heading, mean error [deg]",
                *(angle(s.mae[2]) for s in turned),
            )
    yield "valid [%]", *(number(times(least_valid(scores, m), 100), 1) for m in methods)


def limit_table(scores: Scores) -> Table:
    """One scan beside its limit at every test point, and many scans together."""
    rows = [
        (
            point,
            number(s.limit.radial_std * MM, 1),
            number(s.limit.tangential_std * MM, 1),
            number(s.limit.rmse * MM, 1),
            number(times(s.rmse, MM), 1),
            number(s.over_limit, 3),
            number(s.nees, 2),
            number(times(s.joint_rmse, MM), 2),
            number(times(s.joint_stated, MM), 2),
            number(s.joint_nees, 2),
        )
        for point, s in scores.scans.items()
    ]
    of = scores.scans.values()
    total = (
        "all",
        NONE,
        NONE,
        number(times(root_mean_square([s.limit.rmse for s in of]), MM), 1),
        number(times(root_mean_square([s.rmse for s in of]), MM), 1),
        number(max((s.over_limit for s in of if s.over_limit is not None), default=None), 3),
        NONE,
        number(times(root_mean_square([s.joint_rmse for s in of]), MM), 2),
        number(times(root_mean_square([s.joint_stated for s in of]), MM), 2),
        NONE,
    )
    first = next(iter(of))
    return Table(
        title="One scan beside its limit, and many together [mm]",
        head=(
            "point", "limit along", "limit across", "limit RMSE", "RMSE", "over limit", "NEES",
            f"{TOGETHER} scans RMSE", "stated", "NEES",
        ),
        rows=(*rows, total),
        totals=1,
        note="The limit is the least root mean square error that any estimator can have: the mean covariance of the "
        "posterior, given walls, noise and radius (along and across the line of sight). "
        f"{first.n} scans a point of targets placed evenly over one beam spacing, and {first.groups} times "
        f"{TOGETHER} scans of a target at rest; stated: the RMSE that their covariances expect, "
        "which with a NEES of 2 is the limit. NEES: 2 for an honest covariance. Last row: root mean squares, and "
        "the worst point over its limit.",
        section="limits",
    )  # fmt: skip


def stress_table(scores: Scores) -> Table:
    """Harder drives."""
    rows = []
    for kind in next(iter(scores.stress.values())):
        for method in scores.methods:
            s, usual = scores.stress[method][kind], scores.stress[method].get("usual")
            more = None
            if kind in COMPARED and usual is not None and s.rmse_xy is not None and usual.rmse_xy:
                more = s.rmse_xy / usual.rmse_xy - 1
            rows.append(
                (
                    *named(kind, method, scores),
                    *score_cells(s)[:-1],
                    *honest_cells(scores.stress_honesty[kind].get(method)),
                    number(times(more, 100), 0),
                )
            )
    return Table(
        title=f"Harder drives, the first {SECONDS:g} s of each ({_runs(scores)})",
        head=(*named("drive", "method", scores), *SCORED, "honest", "inside 95 % [%]", "more [%]"),
        rows=tuple(rows),
        note=HARD
        + "NEES: mean over runs, one sample of each; honest: what that of an honest covariance lies in, "
        "998 times in 1000.",
        section="stress",
    )


def _runs(scores: Scores) -> str:
    """How often each was driven."""
    judged = {
        kind: next(iter(of.values())).nees["pose"].runs for kind, of in scores.stress_honesty.items() if of
    }
    return ", ".join(f"{kind} {n}" for kind, n in judged.items())


def honest_cells(found: Consistency | None) -> tuple[str, str, str]:
    """NEES over runs, between what it should lie, and the share inside the 95 % ellipse."""
    if found is None:
        return NONE, NONE, NONE
    nees = found.nees["pose"]
    share = number(100 * found.coverage[-1].share, 0)
    return number(nees.mean, 1), f"{nees.low:.1f} to {nees.high:.1f}", share


def score_cells(s: Score) -> tuple[str, ...]:
    """For the columns `SCORED`."""
    valid = number(times(s.valid_later, 100), 1)
    return _mm(s.rmse_xy), _mm(s.max_xy), angle(s.mae[2]), angle(s.p99_yaw), valid, number(s.nees, 2)


def _mm(value: float | None) -> str:
    return number(times(value, MM), 1)
