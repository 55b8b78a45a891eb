"""The tutorial runs as it stands, block by block."""

import re
from pathlib import Path

import pytest

TUTORIAL = Path(__file__).parents[1] / "docs" / "tutorial_policies.md"


@pytest.mark.slow
def test_the_tutorial_makes_wraps_trains_evaluates_and_plots(tmp_path, monkeypatch, capsys):
    for package in ("pybullet", "torch", "stable_baselines3", "matplotlib"):
        pytest.importorskip(package)
    monkeypatch.chdir(tmp_path)
    names = {}
    for block in re.findall(r"```python\n(.*?)```", TUTORIAL.read_text(), re.S):
        exec(block, names)

    assert names["model"].num_timesteps >= 4000
    assert all(e.success and e.success_gt for e in names["episodes"]["polar"])
    assert len(names["episodes"]["trained"]) == 4
    assert (tmp_path / "ways.png").stat().st_size > 10_000
    assert "the station says" in capsys.readouterr().out
