"""Hyper-parameters: those that are shipped can be read, and what cannot be is said."""

import pytest

from benchmarks.policies.surroundings import TASKS
from benchmarks.training.settings import ALGORITHMS, load_settings, make_settings, shipped
from estimators import ConfigError


@pytest.mark.parametrize("task", TASKS)
def test_shipped_hyper_parameters_can_be_read(task):
    there = 0
    for algo in ALGORITHMS:
        try:
            path = shipped(task, algo)
        except ConfigError:
            continue
        settings, there = load_settings(path, {"steps": 7}), there + 1
        assert settings.steps == 7
        assert settings.estimate in ("surrogate", "lrf", "fused")
    assert there


@pytest.mark.parametrize(
    ("values", "said"),
    [
        ({"steps": 0}, "steps"),
        ({"steps": 10, "stpes": 3}, "stpes.*there are steps"),
        ({"steps": 10, "algorithm": 3}, "algorithm"),
    ],
)
def test_settings_that_cannot_be_are_refused(values, said):
    with pytest.raises(ConfigError, match=said):
        make_settings(values, "file")
