"""`gt-env train`: learn a policy for one of the tasks."""

from __future__ import annotations

import shlex
import sys
from collections.abc import Callable
from dataclasses import replace
from importlib.util import find_spec
from pathlib import Path
from time import perf_counter as clock
from time import process_time
from typing import Annotated, Any

import typer
from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

from benchmarks.commands.answer import say
from benchmarks.commands.options import SeedOption, SetOption, configuration
from benchmarks.output import check_writable
from benchmarks.policies.surroundings import ESTIMATES, TASKS
from benchmarks.training.folder import POLICY, Run, begun, best_policy, is_run, read_run, seed_folder
from benchmarks.training.settings import ALGORITHMS, load_settings, make_settings, shipped
from estimators.errors import ConfigError, GtEnvError, MissingExtraError

TaskOption = Annotated[str, typer.Option("--task", metavar="NAME", help=f"One of {', '.join(TASKS)}.")]
AlgoOption = Annotated[str, typer.Option("--algo", metavar="NAME", help=f"One of {', '.join(ALGORITHMS)}.")]
TasksConfigOption = Annotated[
    str, typer.Option("--config", metavar="NAME_OR_FILE", help="A preset's name or a TOML file.")
]
StepsOption = Annotated[
    int | None,
    typer.Option("--steps", metavar="N", min=1, help="Of the environment, in place of the file's."),
]
SeedsOption = Annotated[
    int,
    typer.Option(
        "--seeds",
        metavar="N",
        min=1,
        help="Trainings that differ in their seed only, from --seed on, each in a folder of its own within --out.",
    ),
]
ResumeOption = Annotated[bool, typer.Option("--resume", help="Go on with the training in --out.")]
EstimateOption = Annotated[
    str | None,
    typer.Option(
        "--estimate",
        metavar="NAME",
        help=f"What the policy sees while it learns, in place of the file's: {', '.join(ESTIMATES)}.",
    ),
]
HyperOption = Annotated[
    Path | None,
    typer.Option("--settings", metavar="FILE", help="Hyper-parameters in place of the shipped ones."),
]


class TrainingStoppedError(GtEnvError):
    """Ctrl-C in a training: what was learnt is saved."""


def train(
    task: TaskOption = "reach",
    algo: AlgoOption = "ppo",
    config: TasksConfigOption = "tasks",
    overrides: SetOption = None,
    seed: SeedOption = 0,
    seeds: SeedsOption = 1,
    steps: StepsOption = None,
    estimate: EstimateOption = None,
    settings_file: HyperOption = None,
    resume: ResumeOption = False,
    jobs: Annotated[
        int,
        typer.Option(
            "--jobs", metavar="N", min=1, help="With more than 1, each environment in a process of its own."
        ),
    ] = 1,
    out: Annotated[
        Path | None, typer.Option("--out", metavar="DIR", file_okay=False, help="Folder of the training.")
    ] = None,
) -> None:
    """Train a policy for a task by what the station sees.

    Ctrl-C leaves a checkpoint, --resume goes on from it.
    """
    folder = out or Path("out") / f"{task}_{algo}"
    default = shipped(task, algo)
    if estimate is not None and estimate not in ESTIMATES:
        raise ConfigError(f"--estimate {estimate}: must be one of {', '.join(ESTIMATES)}")
    places = {folder: seed} if seeds == 1 else {seed_folder(folder, n): n for n in range(seed, seed + seeds)}
    for place in dict.fromkeys([folder, *places]):
        if is_run(place) and not (resume and place in places):
            raise ConfigError(f"--out {place}: holds a training already: --resume goes on, or name another")
    from benchmarks.report.setup import versions

    settings = load_settings(settings_file or default, {"steps": steps, "estimate": estimate})
    world = configuration(config, overrides, default="tasks")
    setup = {"command": shlex.join(["gt-env", *sys.argv[1:]]), "versions": versions()}
    runs = [
        _resumed(place, task, algo, steps)
        if resume and (seeds == 1 or is_run(place))
        else Run(task=task, algo=algo, seed=number, settings=settings, config=world, setup=setup)
        for place, number in places.items()
    ]
    for package in ("torch", "stable_baselines3"):
        if find_spec(package) is None:
            raise MissingExtraError("gt-env train", package, "rl")
    for run, place in zip(runs, places, strict=True):
        check_writable(place)
        _train(run, place, resume and (place / POLICY).is_file(), jobs)
    say(Console(emoji=False), f"gt-env evaluate {folder} judges what was learnt")


def _resumed(folder: Path, task: str, algo: str, steps: int | None) -> Run:
    """The training in a folder, with as many steps as are asked for."""
    run = read_run(folder)
    if (run.task, run.algo) != (task, algo):
        raise ConfigError(f"--out {folder}: holds a training of --task {run.task} --algo {run.algo}")
    if run.algo == "bc" and (folder / POLICY).is_file():
        raise ConfigError("--resume: cloning is done in one go; train it anew")
    values = run.settings.as_dict()
    if steps is not None:
        values["steps"] = steps
    return Run(
        task=run.task,
        algo=run.algo,
        seed=run.seed,
        settings=make_settings(values, str(folder)),
        config=run.config,
        setup=run.setup,
    )


def _train(run: Run, folder: Path, resume: bool, jobs: int) -> None:
    from benchmarks.renderer import prepare_renderer
    from benchmarks.training.surroundings import training_env

    env = training_env(run.task, run.config, run.settings)
    try:
        base: Any = env.unwrapped
        prepare_renderer(base.config)
        env.reset(seed=run.seed)  # what is wrong with the set-up is said before anything is written
    finally:
        env.close()
    wall, cpu = clock(), process_time()
    console = Console(stderr=True, emoji=False)
    bar = Progress(
        TextColumn("training {task.fields[name]}"),
        BarColumn(bar_width=None),
        MofNCompleteColumn(),
        TimeRemainingColumn(),
        console=console,
        transient=True,
        disable=not console.is_terminal,  # a file would get an empty line
    )
    with begun(run, folder), bar:
        shown = bar.add_task("", total=run.settings.steps, name=f"{run.task} by {run.algo}, seed {run.seed}")
        try:
            done = _learn(run, folder, resume, jobs, lambda n: bar.update(shown, completed=n))
        except KeyboardInterrupt:
            raise TrainingStoppedError(f"interrupted: {_left_behind(run, folder)}") from None
        finally:
            spent = {"seconds": clock() - wall, "cpu_seconds": process_time() - cpu}
            spent = {key: value + run.setup.get(key, 0.0) for key, value in spent.items()}
            replace(run, setup={**run.setup, **spent}).write(folder)
    say(Console(emoji=False), f"{best_policy(folder)}: {done} steps in {clock() - wall:.0f} s")


def _left_behind(run: Run, folder: Path) -> str:
    """What there is after an interrupt, and how to go on."""
    if not (folder / POLICY).is_file():
        return f"nothing was learnt yet, and {folder} is as it was before"
    if run.algo == "bc":
        return f"{folder / POLICY} holds what the rounds before taught"
    return f"{folder / POLICY} is saved; the same command with --resume goes on from it"


def _learn(run: Run, folder: Path, resume: bool, jobs: int, progress: Callable[[int], None]) -> int:
    from benchmarks.training import sb3

    if run.algo == "bc":
        from benchmarks.training.cloning import clone

        return clone(run, folder, lambda env: sb3.Imitator(env, run), progress)
    return sb3.train(run, folder, resume=resume, jobs=jobs, progress=progress)
