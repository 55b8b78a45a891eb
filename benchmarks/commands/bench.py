"""`gt-env bench`: how fast the project is, in ratios measured side by side."""

from __future__ import annotations

from pathlib import Path

from rich.console import Console

from benchmarks.commands.answer import show
from benchmarks.commands.options import (
    ConfigOption,
    NoFiguresOption,
    OutOption,
    QuickOption,
    SeedOption,
    SetOption,
    configuration,
    require_report_extra,
)
from benchmarks.output import check_writable, staged
from gt_env.config import load_config


def bench(
    config: ConfigOption = "thesis",
    overrides: SetOption = None,
    seed: SeedOption = 0,
    quick: QuickOption = False,
    out: OutOption = Path("out/bench"),
    no_figures: NoFiguresOption = False,
) -> None:
    """Measure speed and memory, in ratios.

    Of sensors, steps, vector environments and estimators.
    """
    from benchmarks.bench.report import bench_command, left_out, report_json, tables
    from benchmarks.bench.run import plan_bench, run_bench
    from benchmarks.renderer import prepare_renderer

    settings = configuration(config, overrides)
    if not no_figures:
        require_report_extra()
    check_writable(out)
    prepare_renderer(
        load_config({"camera": {"renderer": "fast"}})
    )  # whichever is asked for, all are measured
    console = Console(emoji=False)
    setup = plan_bench(settings, seed=seed, quick=quick)
    findings = run_bench(setup, console)
    command = bench_command(config, overrides or [], seed, quick=quick)
    shown, skipped = tables(findings), left_out(findings)
    with staged(out) as folder:
        (folder / "report.json").write_text(report_json(setup, command, findings), encoding="utf-8")
        if not no_figures:
            from benchmarks.bench.page import write_page

            write_page(folder, setup, command, findings)
    show(console, shown, *skipped, str(out / ("report.json" if no_figures else "report.html")))
