"""`gt-env evaluate`: policies put to the test, judged by the truth and by the station."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console

from benchmarks.commands.answer import show
from benchmarks.commands.options import (
    AddressOption,
    EngineOption,
    JobsOption,
    NoFiguresOption,
    OutOption,
    QuickOption,
    SeedOption,
    SetOption,
    require_one_of,
    require_report_extra,
    set_values,
)
from benchmarks.output import check_writable, staged
from benchmarks.policies.named import SCRIPTED
from benchmarks.policies.surroundings import ESTIMATES, TASKS
from benchmarks.sweeps.engines import Engine

QUICK_EPISODES = 10
"""Of each policy in a quick evaluation."""
PolicyArgument = Annotated[
    list[str],
    typer.Argument(
        metavar="POLICY",
        help="A folder of gt-env train, a file of stable-baselines3, module:Class (called with the environment), or "
        f"one of {', '.join(SCRIPTED)}.",
        show_default=False,
    ),
]


def evaluate(
    policies: PolicyArgument,
    task: Annotated[
        str | None,
        typer.Option(
            "--task", metavar="NAME", help=f"One of {', '.join(TASKS)}; by default what was trained for."
        ),
    ] = None,
    episodes: Annotated[int, typer.Option("--episodes", metavar="N", min=1, help="Of each policy.")] = 100,
    config: Annotated[
        str | None,
        typer.Option(
            "--config", metavar="NAME_OR_FILE", help="A preset or TOML file; by default what was trained in."
        ),
    ] = None,
    overrides: SetOption = None,
    estimate: Annotated[
        str,
        typer.Option("--estimate", metavar="NAME", help=f"What the policies see: {', '.join(ESTIMATES)}."),
    ] = "fused",
    seed: SeedOption = 0,
    quick: QuickOption = False,
    jobs: JobsOption = 2,
    engine: EngineOption = "loky",
    address: AddressOption = None,
    out: OutOption = Path("out/evaluate"),
    no_figures: NoFiguresOption = False,
    video: Annotated[bool, typer.Option("--video", help="Also film each policy's first episode.")] = False,
) -> None:
    """Let policies drive the same episodes, and judge them.

    By the true pose, and by what the station saw.
    """
    from benchmarks.evaluation.candidates import candidates
    from benchmarks.evaluation.report import evaluate_command, findings, report_json, tables
    from benchmarks.evaluation.run import plan_evaluation, run_evaluation

    require_one_of("--estimate", estimate, ESTIMATES)
    place = Engine(name=engine, address=address)
    if not no_figures:
        require_report_extra()
    count = min(episodes, QUICK_EPISODES) if quick else episodes
    plan = plan_evaluation(
        candidates(policies),
        task,
        config,
        overrides=set_values(overrides),
        estimate=estimate,
        seed=seed,
        episodes=count,
    )
    check_writable(out)
    console = Console(emoji=False)
    driven = run_evaluation(plan, jobs=jobs, console=console, engine=place)
    words = [
        *policies,
        "--task",
        plan.task,
        "--episodes",
        str(count),
        "--seed",
        str(seed),
        "--estimate",
        estimate,
    ]
    words += ["--config", config] if config else []
    for override in overrides or ():
        words += ["--set", override]
    words += ["--video"] * video
    found = findings(plan, driven, evaluate_command(words))
    with staged(out) as folder:
        (folder / "report.json").write_text(report_json(found) + "\n", encoding="utf-8")
        films = {}
        if video:
            from benchmarks.evaluation.video import write_videos

            films = write_videos(folder, plan)
        if not no_figures:
            from benchmarks.evaluation.page import write_page

            write_page(folder, found, films)
    show(console, tables(found), str(out / ("report.json" if no_figures else "report.html")))
