"""All tables of a validation in the order of the page: the thesis's own and what goes beyond them."""

from __future__ import annotations

from benchmarks.report.cameras import camera_tables
from benchmarks.report.consistency import consistency_tables
from benchmarks.report.goal import Goal, goal_table
from benchmarks.report.robots import robot_table
from benchmarks.report.rooms import room_tables
from benchmarks.report.scores import Scores
from benchmarks.report.stress import stress_table
from benchmarks.report.summary_table import blind_table, drive_table, limit_table, summary_table
from benchmarks.report.tables import Table, all_tables
from benchmarks.validation.cameras import CameraScores
from benchmarks.validation.robots import RobotScores
from benchmarks.validation.rooms import RoomScores


def every_table(
    scores: Scores,
    rooms: RoomScores | None = None,
    cameras: CameraScores | None = None,
    robots: RobotScores | None = None,
    goals: list[Goal] | None = None,
) -> list[Table]:
    """Those of chapter 5, then what else was done, last the summary and how it compares with the targets."""
    usual = any(scores.static.values())
    tables = [*all_tables(scores), drive_table(scores)] if usual else []
    if scores.alone:
        tables.append(blind_table(scores))
    if scores.scans:
        tables.append(limit_table(scores))
    tables += consistency_tables(scores)
    if any(scores.stress.values()):
        tables.append(stress_table(scores))
    if rooms is not None:
        tables += room_tables(rooms)
    if robots is not None:
        tables.append(robot_table(robots))
    if cameras is not None:
        tables += camera_tables(cameras)
    if usual:
        tables.append(summary_table(scores))
    return [*tables, goal_table(goals)] if goals else tables
