"""`gt-env validate`: the thesis's validation, repeated and put beside its published numbers."""

from __future__ import annotations

import shlex
from pathlib import Path
from typing import Annotated, Any

import typer
from rich.console import Console

from benchmarks.commands.answer import show
from benchmarks.commands.options import (
    AddressOption,
    CalibrationOption,
    ConfigOption,
    EngineOption,
    JobsOption,
    NoFiguresOption,
    OutOption,
    SeedOption,
    SetOption,
    configuration,
    require_one_of,
    require_report_extra,
)
from benchmarks.hindsight import WATCHED
from benchmarks.output import check_writable, staged
from benchmarks.sweeps.engines import Engine

MethodOption = Annotated[
    list[str] | None,
    typer.Option(
        "--method", metavar="NAME", help=f"A ground-truth method ({', '.join(WATCHED)}); repeatable."
    ),
]
CamerasOption = Annotated[
    bool,
    typer.Option("--cameras", help="Also put renderers, lenses, resolutions and shadows side by side."),
]


QuickLookOption = Annotated[
    bool,
    typer.Option(
        "--quick",
        help="A look of about 20 s where all takes 4 minutes (two cores): few samples, short drives, no verdicts.",
    ),
]
StressOption = Annotated[
    bool, typer.Option("--stress", help="Also swept scans, slipping wheels and high speed.")
]
RoomsOption = Annotated[bool, typer.Option("--rooms", help="Also other rooms, targets and rangefinders.")]
RobotsOption = Annotated[bool, typer.Option("--robots", help="Also other robots, all on the same ways.")]
PARTS = ("cameras", "stress", "rooms", "robots")
"""What goes beyond the usual validation, by the name of its option."""
OnlyOption = Annotated[
    list[str] | None,
    typer.Option(
        "--only", metavar="PART", help=f"One of these ({', '.join(PARTS)}) and nothing usual; repeatable."
    ),
]
DEFAULT_METHODS = ("thesis", "fused", "smooth")


def validate(
    config: ConfigOption = "thesis",
    overrides: SetOption = None,
    seed: SeedOption = 0,
    quick: QuickLookOption = False,
    jobs: JobsOption = 2,
    engine: EngineOption = "loky",
    address: AddressOption = None,
    method: MethodOption = None,
    calibration: CalibrationOption = None,
    out: OutOption = Path("out/validate"),
    no_figures: NoFiguresOption = False,
    cameras: CamerasOption = False,
    stress: StressOption = False,
    rooms: RoomsOption = False,
    robots: RobotsOption = False,
    only: OnlyOption = None,
) -> None:
    """Repeat the thesis's validation beside its published numbers.

    And go beyond it: limits of the measurements, honesty of what is stated, other methods.
    """
    from benchmarks.renderer import prepare_renderer
    from benchmarks.report.scores import score_validation
    from benchmarks.report.setup import describe, validate_command
    from benchmarks.report.write import Outcome, write_numbers, write_page
    from benchmarks.rollout import watched_arena
    from benchmarks.validation.cameras import plan_cameras, run_cameras
    from benchmarks.validation.plan import plan_validation, run_validation
    from benchmarks.validation.robots import plan_robots, run_robots
    from benchmarks.validation.rooms import plan_rooms, run_rooms

    parts = _parts(only, dict(zip(PARTS, (cameras, stress, rooms, robots), strict=True)))
    methods, settings = _methods(method), configuration(config, overrides, calibration)
    place = Engine(name=engine, address=address)
    if not no_figures:
        require_report_extra()
    check_writable(out)
    plan = plan_validation(
        settings, methods, seed=seed, quick=quick, stress="stress" in parts, usual=not only
    )
    camera_plan = plan_cameras(settings, methods, seed=seed, quick=quick) if "cameras" in parts else None
    room_plan = plan_rooms(settings, methods, seed=seed, quick=quick) if "rooms" in parts else None
    robot_plan = plan_robots(settings, methods, seed=seed, quick=quick) if "robots" in parts else None
    compared_cameras = camera_plan.runs.values() if camera_plan is not None else ()
    for simulated in (settings, *(runs[0].config for runs in compared_cameras)):
        prepare_renderer(simulated)
    watched_arena(settings, methods).close()  # what is wrong with the set-up is said here, not by a worker
    console = Console(emoji=False)
    running: dict[str, Any] = {"jobs": jobs, "console": console, "engine": place}
    validation = run_validation(plan, **running)
    whole = validation.failed is None
    compared = run_cameras(camera_plan, **running) if camera_plan is not None and whole else None
    whole = whole and (compared is None or compared.failed is None)
    elsewhere = run_rooms(room_plan, **running) if room_plan is not None and whole else None
    whole = whole and (elsewhere is None or elsewhere.failed is None)
    others = run_robots(robot_plan, **running) if robot_plan is not None and whole else None
    outcome = Outcome(
        validation=validation,
        scores=score_validation(validation),
        cameras=compared,
        rooms=elsewhere,
        robots=others,
    )
    command = validate_command(
        config, overrides or [], seed, methods, quick=quick, only=bool(only), parts=parts
    )
    command += "" if calibration is None else f" --calibration {shlex.quote(str(calibration))}"
    setup = describe(plan, command)
    if outcome.failed is not None:
        # What was simulated is kept; the tables and figures want all of it.
        setup["failed"] = {failure.task: failure.reason for failure in outcome.failed.failures}
        with staged(out) as folder:
            write_numbers(folder, outcome, setup)
        raise outcome.failed
    with staged(out) as folder:
        report = write_numbers(folder, outcome, setup)
        if not no_figures:
            report = write_page(folder, outcome, setup, console)
    show(console, outcome.tables(), str(out / report))


def _parts(only: list[str] | None, beside: dict[str, bool]) -> list[str]:
    """What is done beyond the usual, in one order whatever the order of the options."""
    for name in only or ():
        require_one_of("--only", name, PARTS)
    return [part for part in PARTS if beside[part] or part in (only or ())]


def _methods(names: list[str] | None) -> tuple[str, ...]:
    """What was asked for, each once, in order; without a wish the thesis's own and the best there are."""
    for name in names or ():
        require_one_of("--method", name, WATCHED)
    return tuple(dict.fromkeys(names or DEFAULT_METHODS))
