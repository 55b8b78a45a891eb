"""The README's example runs as it stands."""

import re
from pathlib import Path

import pytest

README = Path(__file__).parents[1] / "README.md"


def test_the_example_finds_the_robot(capsys):
    pytest.importorskip("pybullet")
    code = re.search(r"```python\n(.*?)```", README.read_text(), re.S).group(1)
    names = {}
    exec(code, names)

    info = names["info"]
    assert info["gt"]["valid"]
    assert info["gt"]["pose"][:2] == pytest.approx(info["true_pose"][:2], abs=0.02)
    assert "gt pose" in capsys.readouterr().out


def test_every_link_leads_somewhere():
    links = re.findall(r"\]\((?!https?:)([^)#]+)", README.read_text())

    assert links
    assert [link for link in links if not (README.parent / link).exists()] == []
