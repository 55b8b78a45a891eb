"""Named groups of runs as one sweep that keeps what came of it when some of them fail."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Generic, Protocol, TypeVar

from rich.console import Console

from benchmarks.sweeps.engines import Engine
from benchmarks.sweeps.parallel import SweepError, run_side_by_side


class Stepped(Protocol):
    """Any task that knows how long it takes."""

    @property
    def steps(self) -> int:
        """Of the progress bar."""
        ...


Task = TypeVar("Task", bound=Stepped)
Result = TypeVar("Result")


@dataclass(frozen=True, kw_only=True)
class Sweep(Generic[Result]):
    """What came of a sweep.

    Attributes:
        groups: Results by group, in the order of the runs; groups that lack a run are left out.
        failed: Which runs came to nothing; None if all are there.
    """

    groups: dict[str, tuple[Result, ...]]
    failed: SweepError | None


def sweep(
    function: Callable[[Task, Callable[[], None]], Result],
    groups: Mapping[str, Sequence[Task]],
    *,
    jobs: int,
    label: str,
    console: Console,
    engine: Engine | None = None,
) -> Sweep[Result]:
    """Carry out the runs of all groups side by side; see `benchmarks.sweeps.parallel.run_side_by_side`.

    Raises:
        ClusterError: If the engine's cluster does not answer.
    """
    named = {
        (group if len(runs) == 1 else f"{group}, run {i + 1}"): run
        for group, runs in groups.items()
        for i, run in enumerate(runs)
    }
    tasks = list(named.values())
    failed, results = None, list[Any]()
    try:
        results += run_side_by_side(
            function,
            tasks,
            [task.steps for task in tasks],
            jobs=jobs,
            label=label,
            console=console,
            names=list(named),
            engine=engine,
        )
    except SweepError as error:
        failed, results = error, error.results
    left = iter(results)
    found = {group: tuple(next(left) for _ in runs) for group, runs in groups.items()}
    return Sweep(
        groups={group: of for group, of in found.items() if None not in of},
        failed=failed,
    )
