"""An evaluation's numbers: tables and `report.json`."""

from __future__ import annotations

import json
import shlex
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

from benchmarks.evaluation.candidates import Candidate
from benchmarks.evaluation.episode import Episode
from benchmarks.evaluation.run import Evaluation
from benchmarks.evaluation.scores import scored, spread
from benchmarks.report.setup import versions
from benchmarks.report.tables import Table
from benchmarks.training.folder import Run

NONE = "-"


@dataclass(frozen=True, kw_only=True)
class Findings:
    """What an evaluation found.

    Attributes:
        plan: What was driven.
        episodes: By policy.
        scores: By policy; see `scored`.
        groups: Trainings that differ in their seed only.
        command: That makes it again.
    """

    plan: Evaluation
    episodes: dict[str, list[Episode]]
    scores: dict[str, dict[str, Any]]
    groups: dict[str, list[str]]
    command: str


def findings(plan: Evaluation, episodes: dict[str, list[Episode]], command: str) -> Findings:
    """Score what was driven."""
    return Findings(
        plan=plan,
        episodes=episodes,
        scores={name: scored(driven) for name, driven in episodes.items()},
        groups=alike(plan.candidates),
        command=command,
    )


def alike(found: Sequence[Candidate]) -> dict[str, list[str]]:
    """Names of the trained policies whose trainings differ in nothing but their seed, by what they have in common."""
    kinds: dict[str, Run] = {}
    groups: dict[str, list[str]] = {}
    for c in found:
        if c.run is None:
            continue
        run = replace(c.run, seed=0, setup={})
        kind = f"{run.task} by {run.algo}, {run.settings.steps} steps, trained on {run.settings.estimate}"
        while kinds.setdefault(kind, run) != run:
            kind += ", otherwise"
        groups.setdefault(kind, []).append(c.name)
    return groups


def report_json(found: Findings) -> str:
    """Everything but the ways themselves."""
    plan = found.plan
    policies = {}
    for c in plan.candidates:
        trained = {} if c.run is None else {"training": {"settings": c.run.settings.as_dict(), **c.run.setup}}
        policies[c.name] = {"kind": c.kind, **found.scores[c.name], **trained}
    return json.dumps(
        {"policies": policies, "spread": spread(found.scores, found.groups), "setup": describe(found)},
        indent=1,
    )


def describe(found: Findings) -> dict[str, Any]:
    """What the numbers were made from."""
    plan = found.plan
    return {
        "command": found.command,
        "task": plan.task,
        "estimate": plan.estimate,
        "seed": plan.seed,
        "episodes": plan.episodes,
        "versions": versions(),
        "config": plan.config.as_dict(),
    }


def tables(found: Findings) -> list[Table]:
    """Success, driving, reward, and the spread over seeds."""
    shown = [_success(found), _driving(found), _reward(found)]
    apart = spread(found.scores, found.groups)
    return shown + ([_spread(apart, found.plan.task)] if apart else [])


def _success(found: Findings) -> Table:
    rows = []
    for name, s in found.scores.items():
        low, high = s["success_interval"]
        rows.append(
            (
                name,
                percent(s["success"]),
                f"{percent(low)} - {percent(high)}",
                percent(s["success_gt"]),
                points(s["gap"]),
                percent(s["undecided"]),
                percent(s["collisions"]),
            )
        )
    return Table(
        title=f"Success at {found.plan.task}, {found.plan.episodes} episodes each [%]",
        head=("policy", "true", "95 % interval", "by gt", "gap", "undecided", "collisions"),
        rows=tuple(rows),
        note="true: by the simulator's pose; by gt: by what the station said; gap: true minus by gt; undecided: the "
        "station's 95 % interval leaves its verdict open.",
    )


def _driving(found: Findings) -> Table:
    path = found.plan.task == "follow_path"
    patrol = found.plan.task == "patrol"
    head = ["policy", "time [s]", "way [m]", "speed [m/s]", "smoothness", "gt error [mm]"]
    head += ["cross-track [mm]"] if path else ["way-points / min"] if patrol else []
    rows = []
    for name, s in found.scores.items():
        cells = [
            number(s["time_s"], 1),
            number(s["path_length_m"], 2),
            number(s["speed_mps"], 3),
            number(s["smoothness"], 3),
            number(s["gt_error_m"], 1, 1e3),
        ]
        cells += [number(s["cross_track_m"], 1, 1e3)] if path else []
        if patrol:
            per_minute = [60 * e.measures["visited"] / e.time for e in found.episodes[name]]
            cells.append(number(sum(per_minute) / len(per_minute), 1))
        rows.append((name, *cells))
    return Table(
        title="Driving",
        head=tuple(head),
        rows=tuple(rows),
        note="Time, way, speed and cross-track over successful episodes. Smoothness: root mean square of the change of "
        "the action from step to step; less is smoother. gt error: root mean square of gt against true.",
    )


def _reward(found: Findings) -> Table:
    names = list(next(iter(found.scores.values()))["reward_terms"])
    rows = tuple(
        (name, number(s["return"], 2), *(number(s["reward_terms"][term], 2) for term in names))
        for name, s in found.scores.items()
    )
    return Table(title="Reward per episode, by terms", head=("policy", "return", *names), rows=rows)


def _spread(apart: dict[str, dict[str, Any]], task: str) -> Table:
    shown = [
        ("success", "success [%]", 100.0, 1),
        ("success_gt", "by gt [%]", 100.0, 1),
        ("time_s", "time [s]", 1.0, 1),
    ]
    if task == "follow_path":
        shown += [("cross_track_m", "cross-track [mm]", 1e3, 1), ("speed_mps", "speed [m/s]", 1.0, 3)]
    shown += [("smoothness", "smoothness", 1.0, 3)]
    rows = tuple(
        (
            f"{kind} ({s['runs']} seeds)",
            *(
                " / ".join(number(v, places, scale) for v in s.get(key, [])) or NONE
                for key, _, scale, places in shown
            ),
        )
        for kind, s in apart.items()
    )
    return Table(
        title="Spread over training seeds: smallest / mean / largest",
        head=("training", *(head for _, head, _, _ in shown)),
        rows=rows,
    )


def percent(share: float | None) -> str:
    """A share in percent."""
    return NONE if share is None else f"{100 * share:.1f}"


def points(share: float | None) -> str:
    """A difference of shares in percentage points, with its sign."""
    return NONE if share is None else f"{100 * share:+z.1f}"


def number(value: float | None, decimals: int, scale: float = 1.0) -> str:
    """A number, or a dash."""
    return NONE if value is None else f"{scale * value:z.{decimals}f}"


def evaluate_command(words: Sequence[str]) -> str:
    """The command line that makes the same report again."""
    return shlex.join(["gt-env", "evaluate", *words])
