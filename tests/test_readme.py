"""The README's example runs as it stands."""

import re
from pathlib import Path

import pytest

from benchmarks.report.readme import readme_table

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


def test_the_table_of_results_has_the_rows_and_columns_that_reports_fill():
    numbers = {"rmse_xy_mm": 3.14, "max_xy_mm": 15.0, "max_yaw_deg": 6.44}
    methods = ("thesis", "fused", "smooth")
    report = {
        "static": {m: {"all": {"mae": [1.04, 2.0, 0.02]}} for m in methods},
        "moving": {d: {m: numbers for m in methods} for d in ("path", "spin", "tour")},
    }
    expected = readme_table({"simtwo": report, "thesis": report}).splitlines()
    lines = README.read_text().splitlines()
    shown = lines[lines.index(expected[0]) :][: len(expected)]

    assert [line.split("|")[1:3] for line in shown] == [line.split("|")[1:3] for line in expected]
    assert {line.count("|") for line in shown} == {expected[0].count("|")}
    assert expected[2].split("|")[3:5] == [" 1.0 / 2.0 ", " 1.0 / 2.0 "]
    assert expected[3].split("|")[3] == " 0.020 "
    assert expected[-1].split("|")[3] == " 6.4 "
