import math

import numpy as np
import pytest

from benchmarks.trajectory.csv_file import read_csv, read_trajectory, write_csv
from benchmarks.trajectory.trajectory import Trajectory, TrajectoryError
from benchmarks.trajectory.tum import read_tum, write_tum

GOOD = "0.1 1 2 0 0 0 0 1"


def trajectory(n=20, covariances=True):
    rng = np.random.default_rng(3)
    square = rng.normal(size=(n, 3, 3))
    return Trajectory(
        stamps=np.cumsum(rng.uniform(0.01, 0.1, n)),
        poses=np.column_stack([rng.normal(size=(n, 2)), rng.uniform(-math.pi, math.pi, n)]),
        covariances=square @ square.transpose(0, 2, 1) if covariances else None,
        valid=np.arange(n) % 5 > 0,
        yaw_valid=np.arange(n) % 5 > 1,
    )


def test_tum_reads_back_the_valid_poses(tmp_path):
    made = trajectory()
    write_tum(tmp_path / "a.tum", made)
    found = read_tum(tmp_path / "a.tum")

    assert np.array_equal(found.stamps, made.stamps[made.valid])
    assert np.array_equal(found.poses[:, :2], made.poses[made.valid, :2])
    assert np.allclose(found.poses[:, 2], made.poses[made.valid, 2], rtol=0, atol=1e-14)
    assert found.covariances is None


@pytest.mark.parametrize("covariances", [True, False])
def test_csv_reads_back_everything(tmp_path, covariances):
    made = trajectory(covariances=covariances)
    write_csv(tmp_path / "a.csv", made)
    found = read_csv(tmp_path / "a.csv")

    for name in ("stamps", "poses", "valid", "yaw_valid"):
        assert np.array_equal(getattr(found, name), getattr(made, name)), name
    assert (found.covariances is None) != covariances
    if covariances:
        assert np.allclose(found.covariances, made.covariances, rtol=0, atol=1e-15)


def test_yaw_of_a_tilted_quaternion_is_that_of_its_x_axis(tmp_path):
    # Turned by 90 deg about z, then rolled by 180 deg about its own x: x still points along y.
    half = math.sqrt(0.5)
    (tmp_path / "a.tum").write_text(f"0 0 0 0 {half!r} {half!r} 0 0\n")
    assert read_tum(tmp_path / "a.tum").poses[0, 2] == pytest.approx(math.pi / 2)


def test_comments_and_empty_lines_are_passed_over(tmp_path):
    (tmp_path / "a.tum").write_text(f"# stamp x y z ...\n\n{GOOD}\n0.2 1 2 0 0 0 0 1\n")
    assert read_tum(tmp_path / "a.tum").stamps.tolist() == [0.1, 0.2]


@pytest.mark.parametrize(
    ("lines", "line", "says"),
    [
        ([GOOD, "0.2 1 2 0 0 0 0 1.5"], 2, "length is 1.5"),
        ([GOOD, "0.05 1 2 0 0 0 0 1"], 2, "is before that of line 1"),
        ([GOOD, "#", GOOD], 3, "is the same as that of line 1"),
        ([GOOD, "0.2 1 nan 0 0 0 0 1"], 2, "y = nan: must be finite"),
        ([GOOD, "0.2 1 -1e200 0 0 0 0 1"], 2, "y = -1e200: must be within 1e+08 m"),
        ([GOOD, "0.2 1 2 0 0 0 1"], 2, "7 columns: must be 8"),
        ([GOOD, "0.2 1 two 0 0 0 0 1"], 2, "y = 'two': must be a number"),
    ],
)
def test_bad_tum_is_an_error_with_file_and_line(tmp_path, lines, line, says):
    path = tmp_path / "bad.tum"
    path.write_text("\n".join(lines))
    with pytest.raises(TrajectoryError) as error:
        read_trajectory(path)
    assert str(error.value).startswith(f"{path}:{line}: ")
    assert says in str(error.value)


COVARIANCES = "stamp,x,y,yaw,cov_xx,cov_xy,cov_xyaw,cov_yy,cov_yyaw,cov_yawyaw"


@pytest.mark.parametrize(
    ("lines", "line", "says"),
    [
        (["stamp,x,y", "0,1,2"], 1, "lacks the column(s) yaw"),
        (["stamp,x,y,yaw,cov_xx", "0,1,2,0,1"], 1, "cov_xy"),
        (["stamp,x,y,yaw,x", "0,1,2,0,1"], 1, "'x' is there twice"),
        (["stamp,x,y,yaw", "0,1,2,0", "0,1,2,0"], 3, "is the same as"),
        (["stamp,x,y,yaw", "0,1,2,0", "", "-1,1,2,0"], 4, "is before"),
        (["stamp,x,y,yaw", "0,1,2,inf"], 2, "yaw = inf: must be finite"),
        (["stamp,x,y,yaw", "0,1,2"], 2, "3 columns: must be 4"),
        ([COVARIANCES, "0,1,2,0,1,0,0,1,0,1", "1,1,2,0,1,2,0,1,0,1"], 3, "negative eigenvalue"),
    ],
)
def test_bad_csv_is_an_error_with_file_and_line(tmp_path, lines, line, says):
    path = tmp_path / "bad.csv"
    path.write_text("\n".join(lines))
    with pytest.raises(TrajectoryError) as error:
        read_trajectory(path)
    assert str(error.value).startswith(f"{path}:{line}: ")
    assert says in str(error.value)


@pytest.mark.parametrize("name", ["a.tum", "a.csv"])
def test_files_without_a_pose_or_that_are_not_there_are_refused(tmp_path, name):
    with pytest.raises(TrajectoryError, match="cannot be read"):
        read_trajectory(tmp_path / name)
    (tmp_path / name).write_text("")
    with pytest.raises(TrajectoryError, match=r"holds no pose|is empty"):
        read_trajectory(tmp_path / name)
    (tmp_path / name).write_bytes(b"\xff\xfe\x00\x80")
    with pytest.raises(TrajectoryError, match="not a text file"):
        read_trajectory(tmp_path / name)
