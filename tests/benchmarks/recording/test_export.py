"""TUM and CSV hold what was estimated, and other tools read it."""

import csv
import math

import numpy as np
import pytest

from benchmarks.recording import track_of, write_csv, write_tum
from estimators import Pose2, PoseEstimate, RecordingError


def estimate(stamp, x=0.0, yaw=0.0, **flags):
    covariance = np.array([[4.0, 1.0, 0.5], [1.0, 3.0, 0.25], [0.5, 0.25, 1 / 3]])
    return PoseEstimate(stamp=stamp, pose=Pose2(x=x, y=1 / 3, yaw=yaw), covariance=covariance, **flags)


def test_track_keeps_the_last_valid_answer_of_each_stamp():
    estimates = [
        estimate(0.0, 1.0),
        estimate(0.2, 4.0),
        estimate(0.0, 2.0),
        estimate(0.1, 3.0),
        estimate(0.3, valid=False),
    ]
    assert track_of(estimates)[:, :2].tolist() == [[0.0, 2.0], [0.1, 3.0], [0.2, 4.0]]
    assert track_of([]).shape == (0, 4)


def test_tum_is_exact_and_planar(tmp_path):
    track = np.array([[0.1, 1 / 3, -2.0, math.pi], [0.2, 0.0, 1e-9, -1.0]])
    write_tum(tmp_path / "gt.tum", track)
    rows = np.loadtxt(tmp_path / "gt.tum")
    assert rows.shape == (2, 8)
    assert np.array_equal(rows[:, :3], track[:, :3])
    assert not rows[:, 3:6].any()
    assert np.allclose(2 * np.arctan2(rows[:, 6], rows[:, 7]), track[:, 3], atol=1e-15)


def test_evo_reads_the_tum_file(tmp_path):
    file_interface = pytest.importorskip("evo.tools.file_interface")
    rng = np.random.default_rng(0)
    track = np.column_stack([np.arange(50) / 10, rng.normal(size=(50, 2)), rng.uniform(-3, 3, 50)])
    write_tum(tmp_path / "gt.tum", track)
    trajectory = file_interface.read_tum_trajectory_file(tmp_path / "gt.tum")
    valid, _ = trajectory.check()
    assert valid
    assert np.array_equal(trajectory.timestamps, track[:, 0])
    assert np.array_equal(trajectory.positions_xyz[:, :2], track[:, 1:3])
    assert np.allclose(trajectory.get_orientations_euler("szyx")[:, 0], track[:, 3])


@pytest.mark.parametrize(
    "track",
    [np.empty((0, 4)), np.zeros((2, 3)), np.zeros((2, 4)), np.array([[0.0, np.nan, 0, 0]])],
)
def test_track_that_is_none_is_refused(tmp_path, track):
    with pytest.raises(RecordingError, match=r"gt\.tum"):
        write_tum(tmp_path / "gt.tum", track)
    assert not list(tmp_path.iterdir())


def test_csv_holds_pose_covariance_and_validity(tmp_path):
    estimates = [estimate(0.1, 1 / 3, 0.5), estimate(0.2, yaw_valid=False), PoseEstimate.unknown()]
    write_csv(tmp_path / "gt.csv", estimates)
    with (tmp_path / "gt.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert [float(r["stamp"]) for r in rows] == [0.1, 0.2, -1.0]
    assert [(r["valid"], r["yaw_valid"]) for r in rows] == [("1", "1"), ("1", "0"), ("0", "0")]
    first = {name: float(value) for name, value in rows[0].items()}
    assert (first["x"], first["y"], first["yaw"]) == (1 / 3, 1 / 3, 0.5)
    named = [first[f"cov_{n}"] for n in ("xx", "xy", "xyaw", "yy", "yyaw", "yawyaw")]
    assert named == [4.0, 1.0, 0.5, 3.0, 0.25, 1 / 3]
