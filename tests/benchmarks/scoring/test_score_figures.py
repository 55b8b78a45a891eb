"""What a score's figures show: running means over what was said, and who is not on the map."""

import math

import numpy as np
import pytest

pytest.importorskip("matplotlib")

from matplotlib.figure import Figure

from benchmarks.figures.score import MARGIN, outside, running_rms
from benchmarks.figures.score_curves import ratio_figure
from benchmarks.scoring.judge import Rules, judge
from benchmarks.scoring.summary import summarise
from benchmarks.scoring.watch import Answers
from benchmarks.trajectory.association import Pairs
from benchmarks.trajectory.trajectory import Trajectory
from gt_env.config import load_config

ROOM = load_config("thesis").room.in_station_frame()


def test_a_running_mean_is_of_the_second_around_each_answer():
    stamps = np.array([0.0, 0.5, 1.0, 5.0])
    assert running_rms(stamps, np.array([3.0, 4.0, 0.0, 7.0])) == pytest.approx(
        [math.sqrt(12.5), math.sqrt(25 / 3), math.sqrt(8.0), 7.0]
    )


def test_poses_off_the_map_are_counted():
    top = ROOM.bounds[3] + MARGIN
    poses = np.array([[0.0, 2.0, 0.0], [0.0, top - 0.01, 0.0], [0.0, top + 0.01, 0.0], [90.0, 2.0, 0.0]])
    there = Trajectory.of_poses(np.arange(4.0), poses)
    assert outside("it", Pairs(reference=there, estimate=there), ROOM) == "it: 50 % of the poses off the map"
    inside = there.where(np.array([True, True, False, False]))
    assert outside("it", Pairs(reference=inside, estimate=inside), ROOM) == ""


@pytest.mark.parametrize("count", [1, 4])
def test_every_mark_of_a_ratio_stands_inside_its_panel(count):
    t = np.arange(0.0, 20.0, 0.1)
    poses = np.column_stack([np.cos(0.4 * t), 2 + np.sin(0.4 * t), np.zeros(len(t))])
    reference = Trajectory.of_poses(t, poses, np.tile(1e-6 * np.eye(3), (len(t), 1, 1)))
    said = {
        f"subject {k}": Answers.of_file(Trajectory.of_poses(t, poses + 10.0 ** (k - 4))) for k in range(count)
    }
    run = judge("circle", 0, 0, said, {"fused": reference}, np.empty((0, 4)), Rules())
    figure = ratio_figure(summarise([run], "fused"))
    assert isinstance(figure, Figure)
    for ax in figure.axes:
        low, high = sorted(ax.get_ylim())
        left, right = ax.get_xlim()
        marks = [line.get_xydata()[0] for line in ax.lines]
        assert len(marks) == count
        for x, y in marks:
            assert low + 0.2 < y < high - 0.2
            assert left < x < right
