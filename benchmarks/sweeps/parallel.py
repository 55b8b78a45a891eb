"""Independent runs side by side on several cores, with one progress bar over all their steps."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Callable, Iterable, Sequence
from contextlib import nullcontext
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final, TypeVar, cast

import numpy as np
from joblib import Parallel, delayed
from rich.console import Console, RenderableType
from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    Progress,
    TextColumn,
    TimeElapsedColumn,
    TimeRemainingColumn,
)

from benchmarks.interrupts import deaf_to_ctrl_c
from benchmarks.sweeps.dask_runs import completed
from benchmarks.sweeps.engines import Engine, running
from benchmarks.sweeps.orphans import end_with
from estimators.errors import GtEnvError

RETURNS: Final = {"loky": "generator_unordered", "ray": "list"}
"""How results come back from joblib: as soon as they are there, where the engine can."""
NAMED: Final = 3
"""How many reasons a message names, and how many of the tasks that failed for each."""
Task = TypeVar("Task")
Result = TypeVar("Result")


class StepCounter:
    """Counts the steps of one task where the parent process sees it: in a slot of a shared file.

    On another machine there is no such file; steps are then not counted.
    """

    def __init__(self, path: Path, slot: int) -> None:
        self._steps = np.memmap(path, np.int64, "r+") if path.exists() else None
        self._slot = slot
        if self._steps is not None:
            self._steps[slot] = 0  # a task may be run again

    def __call__(self) -> None:
        """Count one step."""
        if self._steps is not None:
            self._steps[self._slot] += 1


@dataclass(frozen=True, kw_only=True, slots=True)
class Failure:
    """A task that came to no result, and why."""

    task: str
    reason: str


class SweepError(GtEnvError):
    """Some tasks of a sweep came to no result.

    Attributes:
        failures: Which, and why.
        results: One per task in their order; None for those that failed.
    """

    def __init__(self, failures: Sequence[Failure], results: Sequence[Any]) -> None:
        tasks: dict[str, list[str]] = {}
        for failure in failures:
            tasks.setdefault(failure.reason, []).append(failure.task)
        said = "; ".join(f"{listed(named)}: {reason}" for reason, named in list(tasks.items())[:NAMED])
        said += f"; and {len(tasks) - NAMED} other reasons" if len(tasks) > NAMED else ""
        super().__init__(f"{len(failures)} of {len(results)} runs failed: {said}")
        self.failures = tuple(failures)
        self.results = list(results)


def run_side_by_side(
    function: Callable[[Task, Callable[[], None]], Result],
    tasks: Sequence[Task],
    steps: Sequence[int],
    *,
    jobs: int,
    label: str,
    console: Console,
    names: Sequence[str] | None = None,
    engine: Engine | None = None,
) -> list[Result]:
    """Call `function(task, on_step)` for every task and return the results in the order of the tasks.

    Every task must bring its own seed: then the results depend neither on `jobs` nor on the engine.

    Args:
        function: Importable by name, as it runs in other processes; it calls `on_step` after every step.
        tasks: What to run.
        steps: How many steps each task takes, for the bar; the longest are started first.
        jobs: How many at a time; 1 on this machine runs them in this process.
        label: Of the bar.
        console: Where the bar is drawn.
        names: Of the tasks, for messages; None for their numbers.
        engine: Who runs them; None for this machine's cores.

    Raises:
        ClusterError: If the engine's cluster does not answer.
        SweepError: If tasks raised, or the processes that they ran in died; all others were carried out.
    """
    if not tasks:
        return []
    engine = engine or Engine()
    order = sorted(range(len(tasks)), key=lambda i: -steps[i])
    with tempfile.TemporaryDirectory(prefix="gt-env-") as folder, running(engine, jobs):
        path = Path(folder) / "steps"
        np.zeros(len(tasks), np.int64).tofile(path)
        with _StepBar(path, label, sum(steps), console) as bar:

            def call(i: int) -> Any:
                bar.started(steps[i], jobs)
                return delayed(_run)(function, tasks[i], path, i, os.getpid())

            outcomes = (
                _dask_outcomes(call, order, jobs) if engine.name == "dask" else _outcomes(call, order, engine)
            )
    results = [None if isinstance(outcomes[i], _Raised) else outcomes[i] for i in range(len(tasks))]
    failures = [
        Failure(task=names[i] if names else f"run {i + 1}", reason=outcome.reason)
        for i in range(len(tasks))
        if isinstance(outcome := outcomes[i], _Raised)
    ]
    if failures:
        raise SweepError(failures, results)
    return cast(list[Result], results)


def listed(names: Sequence[str]) -> str:
    """The first few names, and how many more there are."""
    more = len(names) - NAMED
    return ", ".join(names[:NAMED]) + (f" and {more} more" if more > 0 else "")


@dataclass(frozen=True, slots=True)
class _Raised:
    """What a task comes back with instead of a result."""

    reason: str


def _outcomes(call: Callable[[int], Any], order: Sequence[int], engine: Engine) -> dict[int, Any]:
    """Results and failures by task.

    A process that dies takes the whole round with it, and nobody says which task it had: what is left is then
    run by halves, until the task is alone that no process survives.
    """
    outcomes: dict[int, Any] = {}
    parallel = Parallel(batch_size=1, pre_dispatch="n_jobs", return_as=RETURNS[engine.name])
    try:
        with deaf_to_ctrl_c() if engine.name == "loky" else nullcontext():  # joblib's processes start here
            done = parallel(call(i) for i in order)
        for i, outcome in done:
            outcomes[i] = outcome
    except Exception as error:
        left = [i for i in order if i not in outcomes]
        if len(left) == 1 and len(order) == 1:
            outcomes[left[0]] = _died(error)
            return outcomes
        half = (len(left) + 1) // 2
        for part in (left[:half], left[half:]):
            if part:
                outcomes |= _outcomes(call, part, engine)
    return outcomes


def _dask_outcomes(call: Callable[[int], Any], order: Sequence[int], jobs: int) -> dict[int, Any]:
    found = completed(call, order, jobs)
    return {i: _died(error) if error else result[1] for i, result, error in found}


def _died(error: Exception) -> _Raised:
    return _Raised(f"its process died ({type(error).__name__})")


def _run(
    function: Callable[[Task, Callable[[], None]], Result], task: Task, path: Path, slot: int, parent: int
) -> tuple[int, Result | _Raised]:
    end_with(parent)
    try:
        return slot, function(task, StepCounter(path, slot))
    except GtEnvError as error:
        return slot, _Raised(str(error))
    except Exception as error:
        return slot, _Raised(f"{type(error).__name__}: {error}")


class _StepBar(Progress):
    """A progress bar that reads the counters each time it is drawn, and knows what must be done by then."""

    def __init__(self, path: Path, label: str, total: int, console: Console) -> None:
        self._steps = np.memmap(path, np.int64, "r")
        self._started: list[int] = []
        self._done = 0
        super().__init__(
            TextColumn("{task.description}"),
            BarColumn(bar_width=None),
            MofNCompleteColumn(),
            TimeElapsedColumn(),
            TimeRemainingColumn(),
            console=console,
            transient=True,
            disable=not console.is_terminal,  # a file would get an empty line
        )
        self.add_task(label, total=total)

    def started(self, steps: int, jobs: int) -> None:
        """A task was handed out, so all but the last `jobs` before it are done, wherever they ran."""
        self._started.append(steps)
        self._done = sum(self._started[:-jobs])

    def get_renderables(self) -> Iterable[RenderableType]:
        """Read the counters, then draw."""
        for task_id in self.task_ids:
            self.update(task_id, completed=max(int(self._steps.sum()), self._done))
        return super().get_renderables()
