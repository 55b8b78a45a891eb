"""A validation's files: `report.json`, figures, `report.html`."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from rich.console import Console

from benchmarks.report.cameras import cameras_json
from benchmarks.report.every_table import every_table
from benchmarks.report.goal import Goal
from benchmarks.report.goals import reached_goals
from benchmarks.report.robots import robot_goals, robots_json
from benchmarks.report.rooms import rooms_json
from benchmarks.report.scores import Scores
from benchmarks.report.summary import report_json
from benchmarks.report.tables import Table
from benchmarks.sweeps.parallel import SweepError
from benchmarks.validation.cameras import CameraScores
from benchmarks.validation.plan import Validation
from benchmarks.validation.robots import RobotScores
from benchmarks.validation.rooms import RoomScores


@dataclass(frozen=True, kw_only=True)
class Outcome:
    """Everything that a validation came to.

    Attributes:
        validation: What was planned and simulated.
        scores: Of it.
        rooms: Of other rooms, targets and rangefinders, if these were asked for.
        cameras: Likewise of cameras.
        robots: Likewise of several robots.
    """

    validation: Validation
    scores: Scores
    rooms: RoomScores | None = None
    cameras: CameraScores | None = None
    robots: RobotScores | None = None

    @property
    def failed(self) -> SweepError | None:
        """The first part of which runs failed."""
        parts = (self.validation, self.cameras, self.rooms, self.robots)
        return next((part.failed for part in parts if part is not None and part.failed), None)

    def goals(self) -> list[Goal]:
        """The documented targets beside what was reached; a quick run has too few samples to judge by."""
        plan = self.validation.plan
        goals = reached_goals(plan.config, self.scores, self.rooms)
        goals += robot_goals(self.robots) if self.robots is not None else []
        return [replace(goal, judged=False) for goal in goals] if plan.quick else goals

    def tables(self) -> list[Table]:
        """In the order of the page."""
        return every_table(self.scores, self.rooms, self.cameras, self.robots, self.goals())


def write_numbers(folder: Path, outcome: Outcome, setup: dict[str, Any]) -> str:
    """Write `report.json`; returns its name."""
    compared = None if outcome.cameras is None else cameras_json(outcome.cameras)
    elsewhere = None if outcome.rooms is None else rooms_json(outcome.rooms)
    others = None if outcome.robots is None else robots_json(outcome.robots)
    # Where runs failed there is not enough to hold against targets.
    goals = outcome.goals() if outcome.failed is None else []
    text = report_json(outcome.scores, setup, compared, elsewhere, others, goals)
    (folder / "report.json").write_text(text, encoding="utf-8")
    return "report.json"


def write_page(folder: Path, outcome: Outcome, setup: dict[str, Any], console: Console) -> str:
    """Write the figures and `report.html`; returns the page's name. Needs the extra `report`."""
    from benchmarks.experiments.cameras import camera_scenes
    from benchmarks.experiments.scenes import scenes
    from benchmarks.report.gallery.cameras import camera_plates
    from benchmarks.report.gallery.compared import robot_plates, room_plates, stress_plates
    from benchmarks.report.gallery.further import further_plates
    from benchmarks.report.gallery.thesis import thesis_plates
    from benchmarks.report.html import draw
    from benchmarks.report.page import html_page

    validation, scores = outcome.validation, outcome.scores
    config, seed = validation.plan.config, validation.plan.seed
    shown = [*stress_plates(scores)]
    if validation.static:
        shown = [
            *thesis_plates(validation, scores, scenes(config, seed)),
            *further_plates(validation, scores),
            *shown,
        ]
    if outcome.rooms is not None:
        shown += room_plates(outcome.rooms)
    if outcome.robots is not None:
        shown += robot_plates(outcome.robots)
    if outcome.cameras is not None:
        shown += camera_plates(outcome.cameras, camera_scenes(config, seed))
    draw(shown, folder, console)
    return html_page(scores, outcome.tables(), shown, folder, setup)
