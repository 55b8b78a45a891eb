"""A sweep keeps the groups of runs that are whole, and names what failed."""

import io
from dataclasses import dataclass

from rich.console import Console

from benchmarks.sweeps.sweep import sweep


@dataclass(frozen=True)
class Squared:
    value: int
    steps: int = 1


def square(task, on_step):
    on_step()
    if task.value < 0:
        raise ValueError("negative")
    return task.value**2


def swept(groups):
    return sweep(square, groups, jobs=1, label="", console=Console(file=io.StringIO()))


def test_results_come_back_in_their_groups_and_in_order():
    found = swept({"a": [Squared(3), Squared(2)], "b": [Squared(5)], "none": []})
    assert found.groups == {"a": (9, 4), "b": (25,), "none": ()}
    assert found.failed is None


def test_a_group_that_lacks_a_run_is_left_out_and_its_run_is_named():
    found = swept({"a": [Squared(3), Squared(-1)], "b": [Squared(5)], "c": [Squared(-2)]})
    assert found.groups == {"b": (25,)}
    assert [f.task for f in found.failed.failures] == ["a, run 2", "c"]
    assert found.failed.failures[0].reason == "ValueError: negative"
