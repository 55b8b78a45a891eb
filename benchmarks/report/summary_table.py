"""What a validation comes to, one column per method; its drives, and its scans beside their limit."""

from __future__ import annotations

from collections.abc import Iterator

from benchmarks.experiments.scans import TOGETHER
from benchmarks.metrics import Score, root_mean_square
from benchmarks.report.cells import SCORED, millimetres, score_cells
from benchmarks.report.scores import MM, Scores, least_valid, times
from benchmarks.report.tables import NONE, Table, angle, named, number
from benchmarks.validation.plan import DITHERED, STILL


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
    return millimetres(s.rmse_xy), millimetres(s.max_xy)


def _rows(scores: Scores) -> Iterator[tuple[str, ...]]:
    methods = scores.methods
    for kind, said in ((STILL, ""), (DITHERED, ", dithered")):
        of = [scores.rest[m][kind] for m in methods if kind in scores.rest[m]]
        if of:
            yield f"at rest after 10 s{said}: RMSE [mm]", *(millimetres(s.rmse_xy) for s in of)
            yield f"at rest after 10 s{said}: heading, mean error [deg]", *(angle(s.mae[2]) for s in of)
    travels = [scores.travels[m] for m in methods]
    yield "path, tour, figure of eight: RMSE [mm]", *(millimetres(s.rmse_xy) for s in travels)
    yield "path, tour, figure of eight: largest error [mm]", *(millimetres(s.max_xy) for s in travels)
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
            number(times(s.joint_limit, MM), 2),
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
        number(times(root_mean_square([s.joint_limit for s in of]), MM), 2),
        NONE,
    )
    first = next(iter(of))
    return Table(
        title="One scan beside its limit, and many together [mm]",
        head=(
            "point", "limit along", "limit across", "limit RMSE", "RMSE", "over limit", "NEES",
            f"{TOGETHER} scans RMSE", "limit", "NEES",
        ),
        rows=(*rows, total),
        totals=1,
        note="The limit is the least root mean square error that any estimator can have: the mean covariance of the "
        "posterior, given walls, noise and radius (along and across the line of sight). "
        f"{first.n} scans a point of targets placed evenly over one beam spacing, and {first.groups} times "
        f"{TOGETHER} scans of a target at rest, which have a limit of their own. NEES: 2 for an honest "
        "covariance. Last row: root mean squares, and "
        "the worst point over its limit.",
        section="limits",
    )  # fmt: skip
