"""`gt-env score` as people call it, and the tutorial as it stands."""

import json
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

pytest.importorskip("pybullet")

from benchmarks.__main__ import main

TUTORIAL = Path(__file__).parents[3] / "docs" / "your_localizer.md"
PARTS = {"gt_vs_true", "estimate_vs_gt", "estimate_vs_true", "ratios", "verdicts", "nees", "availability"}
SHORT = (
    "--duration",
    "3",
    "--seeds",
    "1",
    "--jobs",
    "1",
    "--set",
    "camera.width=160",
    "--set",
    "camera.height=120",
)


@pytest.fixture
def command(monkeypatch, tmp_path, capsys):
    """Run the command line in an empty folder; its exit status and what it printed."""
    monkeypatch.chdir(tmp_path)

    def run(*words):
        monkeypatch.setattr(sys, "argv", ["gt-env", *words])
        try:
            main()
            status = 0
        except SystemExit as end:
            status = end.code or 0
        said = capsys.readouterr()
        return status, said.out + said.err

    return run


def test_a_message_shows_names_as_they_were_typed(command):
    status, said = command("score", "nowhere:x:")  # :x: is a cross where emoji are on

    assert status == 1
    assert "nowhere:x:" in said


def test_the_command_line_starts_without_plotting_packages():
    code = "import sys; sys.modules.update(matplotlib=None, jinja2=None); import benchmarks.cli"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)

    assert done.returncode == 0, done.stderr


def test_the_tutorial_runs_as_it_stands(command, tmp_path):
    code = re.search(r"```python\n(.*?)```", TUTORIAL.read_text(), re.S).group(1)
    lines = [line for line in code.splitlines() if line.strip() and not line.startswith(("import", "from"))]
    assert len(lines) <= 20
    (tmp_path / "mine.py").write_text(code)

    status, said = command(
        "score", "mine:Mine", "odometry", "--path", "eight", *SHORT, "--no-figures", "--record"
    )
    assert status == 0, said
    kept = sorted(path.name for path in (tmp_path / "out/score").iterdir())
    assert kept == ["figure-of-eight-0.mcap", "report.json"]
    report = json.loads((tmp_path / "out/score/report.json").read_text())

    for name in ("mine:Mine", "odometry"):
        subject = report["subjects"][name]
        assert set(subject) >= PARTS
        assert set(subject["ratios"]) == set(subject["verdicts"]) == {"position", "yaw", "relative"}
        assert subject["estimate_vs_gt"]["ate_mm"] < 100  # it starts where it should and goes the right way
        assert subject["availability"] > 0.95
    assert [c["what"] for c in report["comparisons"]] == [
        w for w, r in subject["ratios"].items() if r is not None
    ]
    assert not any(c["of_other_runs"] for c in report["comparisons"])  # of one run


@pytest.mark.slow
def test_a_planted_clock_offset_and_lever_arm_are_found_on_the_figure_of_eight(command, tmp_path):
    shutil.copy(Path(__file__).parents[1] / "score_subjects.py", tmp_path / "planted_elsewhere.py")
    status, said = command(
        "score", "it=planted_elsewhere:Elsewhere", "--path", "eight", "--seeds", "1", "--duration", "60",
        "--jobs", "1", "--no-figures",
    )  # fmt: skip
    assert status == 0, said
    offsets = json.loads((tmp_path / "out/score/report.json").read_text())["subjects"]["it"]["offsets"]

    assert offsets["not_observable"] == []
    assert re.search(
        r"^it: beyond 3 standard errors: clock (19|20)\.\d ± 0\.\d ms, lever x -(49|50)\.\d ± ", said, re.M
    )
    assert "not observable" not in said
    for name, unit, planted in (
        ("clock", "ms", 20), ("lever_x", "mm", -50), ("lever_y", "mm", 0), ("lever_yaw", "deg", 0),
    ):  # fmt: skip
        error = offsets[f"{name}_error_{unit}"]
        assert abs(offsets[f"{name}_{unit}"] - planted) < 3 * error
        assert error < 0.05 * 50  # and so precisely that it is no wonder


def test_who_was_not_scored_is_named_with_the_runs_as_their_recordings_are(command, tmp_path):
    (tmp_path / "mute.py").write_text("def says_nothing(message):\n    return None\n")
    short = (
        "--path",
        "eight",
        "--duration",
        "1",
        "--seeds",
        "2",
        "--seed",
        "5",
        "--jobs",
        "1",
        "--no-figures",
    )

    status, said = command("score", "mute:says_nothing", "odometry", *short, "--record")
    assert status == 0, said
    assert "mute:says_nothing: not scored in figure-of-eight-0, figure-of-eight-1 of --seed 5: " in said
    report = json.loads((tmp_path / "out/score/report.json").read_text())
    kept = [path.stem for path in sorted((tmp_path / "out/score").glob("*.mcap"))]
    assert list(report["subjects"]["odometry"]["each_run"]) == report["setup"]["runs"] == kept


def test_a_score_of_nobody_is_one_line_a_failure_and_no_report(command, tmp_path):
    (tmp_path / "unlucky.py").write_text("def raises(message):\n    raise RuntimeError('no idea')\n")

    status, said = command(
        "score", "unlucky:raises", "--path", "eight", "--duration", "1", "--seed", "5", "--jobs", "1",
        "--no-figures",
    )  # fmt: skip
    assert status == 1
    assert said.startswith(
        "gt-env: nobody could be scored in figure-of-eight-0, figure-of-eight-1, figure-of-eight-2 of --seed 5: "
        "unlucky:raises: raised, "
    )
    assert "RuntimeError: no idea" in said
    assert said.count("\n") == 1
    assert [path.name for path in tmp_path.iterdir() if path.name != "__pycache__"] == ["unlucky.py"]


def test_it_writes_a_page_with_its_figures(command, tmp_path):
    pytest.importorskip("matplotlib")
    status, said = command(
        "score", "odometry", "--path", "eight", "--path", "far", "--align", "origin", *SHORT
    )
    assert status == 0, said
    page = (tmp_path / "out/score/report.html").read_text()
    assert page.count("data:image/png") == 6
    assert "aligned at the first pose" in page
    assert "aligned at the first pose" in said


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (("nobody",), "SUBJECT 'nobody': must be one of odometry"),
        (("odometry", "odometry"), "is there twice"),
        (("a=poses.tum",), "needs --recording or --gt"),
        (("odometry", "--path", "moon"), "--path moon: must be one of figure-of-eight"),
        (
            ("ekf", "--set", "robot.model=omni3"),
            "SUBJECT ekf: takes the speeds of two wheels; robot.model = 'omni3' has 3",
        ),
        (("odometry", "--align", "sim3"), "--align sim3: must be one of none, origin, se2, yaw"),
        (("odometry", "--reference", "true"), "--reference true: must be one of fused, smooth"),
        (("a=poses.tum", "--gt", "gt.csv"), "gt.csv: cannot be read"),
        (("odometry", "--gt", "gt.csv"), "only trajectory files can be scored"),
        (("odometry", "--recording", "no.mcap"), "no.mcap: there is no such file"),
        (("odometry", "--trajectory", "poses.tum"), "must be NAME=FILE"),
        (("odometry", "--set", "onboard.lidar.beam=3"), "onboard.lidar.beam"),
    ],
)
def test_what_cannot_be_is_one_line_and_nothing_is_written(command, tmp_path, words, says):
    status, said = command("score", *words, "--no-figures", "--jobs", "1")
    assert status == 1
    assert says in said
    assert said.count("\n") == 1
    assert not list(tmp_path.rglob("report*"))


def test_files_alone_are_compared_with_a_file(command, tmp_path):
    t = [0.1 * i for i in range(100)]
    rows = [f"{s},{0.2 * s},2.0,0.0,4e-6,0,0,4e-6,0,1e-8" for s in t]
    head = "stamp,x,y,yaw,cov_xx,cov_xy,cov_xyaw,cov_yy,cov_yyaw,cov_yawyaw"
    (tmp_path / "gt.csv").write_text("\n".join([head, *rows]))
    (tmp_path / "a.tum").write_text("".join(f"{s} {0.2 * s + 0.003} 2.004 0 0 0 0 1\n" for s in t))

    status, said = command("score", "a=a.tum", "--gt", "gt.csv", "--no-figures")
    assert status == 0, said
    found = json.loads((tmp_path / "out/score/report.json").read_text())["subjects"]["a"]
    assert found["estimate_vs_gt"]["ate_uncorrected_mm"] == pytest.approx(5.0)
    assert found["estimate_vs_gt"]["ate_mm"] == pytest.approx((25 - 8) ** 0.5, rel=0.1)
    assert found["ratios"]["position"] == pytest.approx((25 / 8 - 1) ** 0.5, rel=0.1)
    assert found["verdicts"]["position"] == "insufficient"
    assert found["estimate_vs_true"] is None
    assert {"lever_x", "frame_x"} <= set(found["offsets"]["not_observable"])  # it goes straight on
    assert re.search(r"^a: not observable .*lever x", said, re.M)
