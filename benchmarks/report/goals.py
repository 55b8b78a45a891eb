"""Which documented targets a validation can be held against, and what it reached, from the same scores."""

from __future__ import annotations

from collections.abc import Iterator
from math import inf

from benchmarks.metrics import root_mean_square
from benchmarks.report.goal import Goal, at_most, degrees, millimetres, valid_share
from benchmarks.report.scores import Scores, least_valid
from benchmarks.validation.consistency import PARTS, Consistency
from benchmarks.validation.goals import (
    ALONE,
    COVERED,
    ELSEWHERE,
    ONE_SCAN,
    TARGETS,
    VALID,
    VALID_HARD,
    WORSE,
    Targets,
    targeted_preset,
)  # fmt: skip
from benchmarks.validation.plan import DITHERED, STILL
from benchmarks.validation.rooms import RoomScores
from gt_env.config import EnvConfig

ONLINE, AFTER = "fused", "smooth"
"""Methods that the targets are for."""
DRIVES = "path, tour, figure of eight"
SITUATIONS = {"rest-still": "at rest", "rest-dithered": "at rest, dithered", "driving": "driving at random"}


def reached_goals(config: EnvConfig, scores: Scores, rooms: RoomScores | None = None) -> list[Goal]:
    """All targets that this validation can be held against; none for a configuration that has no targets."""
    preset = targeted_preset(config)
    if preset is None:
        return []
    targets = TARGETS[preset]
    found = [
        *_scan_goals(targets, scores),
        *_rest_goals(targets, scores),
        *_drive_goals(targets, scores),
        *_alone_goals(scores),
    ]
    for situation, of in scores.consistency.items():
        for method in (ONLINE, AFTER):
            if method in of:
                found += [_honest(situation, method, of[method]), _covered(situation, method, of[method])]
    return [*found, *_stress_goals(scores), *_room_goals(rooms)]


def _scan_goals(targets: Targets, scores: Scores) -> Iterator[Goal]:
    of = list(scores.scans.values())
    if of:
        ratios = [s.over_limit for s in of]
        worst = None if None in ratios else max(r for r in ratios if r is not None)
        yield at_most("one scan: RMSE over its limit, worst point", "scans alone", "", ONE_SCAN, worst, 3)
        joint = root_mean_square([s.joint_rmse for s in of])
        yield millimetres("100 scans together: RMSE", "scans alone", targets.joint, joint)


def _rest_goals(targets: Targets, scores: Scores) -> Iterator[Goal]:
    rest = scores.rest.get(ONLINE, {})
    if STILL in rest:
        yield millimetres("at rest after 10 s: RMSE", ONLINE, targets.rest, rest[STILL].rmse_xy)
        yield degrees("at rest after 10 s: heading", ONLINE, targets.rest_heading, rest[STILL].mae[2])
    if STILL in scores.rest.get(AFTER, {}):
        after = scores.rest[AFTER][STILL].rmse_xy
        yield millimetres("100 scans together and their frames: RMSE", AFTER, targets.joint, after)
    if DITHERED in rest:
        swept = rest[DITHERED].mae[2]
        yield degrees("at rest after 10 s: heading, dithered", ONLINE, targets.rest_heading_dithered, swept)


def _drive_goals(targets: Targets, scores: Scores) -> Iterator[Goal]:
    if ONLINE in scores.travels:
        s, spins = scores.travels[ONLINE], scores.moving[ONLINE]
        yield millimetres(f"{DRIVES}: RMSE", ONLINE, targets.online, s.rmse_xy)
        yield millimetres(f"{DRIVES}: largest error", ONLINE, targets.online_max, s.max_xy)
        yield degrees(f"{DRIVES}: heading", ONLINE, targets.heading, s.mae[2])
        yield degrees(f"{DRIVES}: heading, 99 %", ONLINE, targets.heading_p99, s.p99_yaw)
    if AFTER in scores.travels:
        s = scores.travels[AFTER]
        yield millimetres(f"{DRIVES}: RMSE", AFTER, targets.smoothed, s.rmse_xy)
        yield degrees(f"{DRIVES}: heading", AFTER, targets.heading_smoothed, s.mae[2])
    if ONLINE in scores.travels:
        yield degrees("turning on the spot: heading", ONLINE, targets.spin, spins["spin"].mae[2])
        if "spin-dithered" in spins:
            swept = spins["spin-dithered"].mae[2]
            yield degrees("turning on the spot: heading, dithered", ONLINE, targets.spin_dithered, swept)
        yield valid_share("valid from 2 s on, worst drive", ONLINE, VALID, least_valid(scores, ONLINE))


def _alone_goals(scores: Scores) -> Iterator[Goal]:
    for method, target in ALONE.items():
        if method in scores.alone:
            rmse = scores.alone_travels[method].rmse_xy
            yield millimetres(f"{DRIVES}: RMSE", method, target, rmse)


def _honest(situation: str, method: str, found: Consistency) -> Goal:
    """Every part's NEES within its bounds."""
    return Goal(
        what=f"{SITUATIONS.get(situation, situation)}: NEES of pose, position, heading",
        method=method,
        unit="",
        asked=tuple((found.nees[part].low, found.nees[part].high) for part in PARTS),
        reached=tuple(found.nees[part].mean for part in PARTS),
        decimals=1,
    )


def _covered(situation: str, method: str, found: Consistency) -> Goal:
    low, high = COVERED
    return Goal(
        what=f"{SITUATIONS.get(situation, situation)}: inside the 95 % ellipse",
        method=method,
        unit="%",
        asked=((100 * low, 100 * high),),
        reached=(100 * found.coverage[-1].share,),
        decimals=0,
    )


def _stress_goals(scores: Scores) -> Iterator[Goal]:
    for method in (m for m in (ONLINE, AFTER) if m in scores.stress):
        of, honest = scores.stress[method], scores.stress_honesty
        for kind in ("swept", "slip"):
            if kind in of and "usual" in of:
                pairs = ((of[kind].rmse_xy, of["usual"].rmse_xy), (of[kind].mae[2], of["usual"].mae[2]))
                worse = tuple(100 * (hard / usual - 1) if hard and usual else None for hard, usual in pairs)
                yield Goal(
                    what=f"{kind}: RMSE and heading, worse by",
                    method=method,
                    unit="%",
                    asked=((-inf, 100 * WORSE),) * 2,
                    reached=worse,
                    decimals=0,
                )
        for kind in ("fast", "whirl"):
            if kind in of:
                yield valid_share(f"{kind}: valid from 2 s on", method, VALID_HARD, of[kind].valid_later)
                if method in honest[kind]:
                    yield _honest(kind, method, honest[kind][method])


def _room_goals(rooms: RoomScores | None) -> Iterator[Goal]:
    if rooms is None:
        return
    ratios = [s.over_limit for of in rooms.settings.values() for s in of.scans.values()]
    known = [r for r in ratios if r is not None]
    if known:
        worst = max(known) if len(known) == len(ratios) else None
        what = "other rooms: one scan over its limit, worst point"
        yield at_most(what, "scans alone", "", ELSEWHERE, worst, 3)
