"""The replay's figure holds what it should, at rest and in motion, with and without heading and truth."""

import math

import numpy as np
import pytest

pytest.importorskip("matplotlib")

from benchmarks.figures.map import draw_ellipse, draw_room, draw_scan, draw_zone
from benchmarks.figures.replay import replay_figure
from benchmarks.figures.style import save_png
from benchmarks.recording import MessageLog, Recording
from benchmarks.replay import replay
from estimators import LaserScan, Pose2, PoseEstimate, TargetSighting
from gt_env.config import load_config

CALIBRATION = load_config("thesis").calibration()


def scan(stamp, n=90):
    bearings = np.pi / n * np.arange(n)
    ranges, _ = CALIBRATION.room.cast((0.0, 0.0), bearings)
    ranges[n // 2 - 2 : n // 2 + 2] = 1.9
    return LaserScan(
        stamp=stamp, ranges=ranges - 0.2 * stamp, bearing_min=0.0, bearing_increment=np.pi / n, range_max=6.4
    )


def sighting(stamp):
    return TargetSighting(
        stamp=stamp,
        pan=1.5,
        top=60,
        bottom=180,
        left=120,
        right=200,
        marker_columns=[160.0],
        marker_colors=[0],
    )


@pytest.mark.parametrize("moving", [False, True])
@pytest.mark.parametrize("heading", [False, True])
@pytest.mark.parametrize("known", [False, True])
def test_panels(tmp_path, moving, heading, known):
    stamps = [i / 10 for i in range(20 if moving else 3)]
    messages = [m for t in stamps for m in ([scan(t), sighting(t)] if heading else [scan(t)])]
    truth = np.array([[t, 0.0, 2.0, math.pi] for t in stamps]) if known else np.empty((0, 4))
    recording = Recording(origin="some/run.mcap", messages=MessageLog(messages), truth=truth)
    figure = replay_figure(recording, replay(recording, "thesis", CALIBRATION), CALIBRATION)
    assert len(figure.axes) == (1 if moving else 2) + (3 if heading else 2)
    assert "run.mcap" in figure.get_suptitle()
    labels = {label for ax in figure.axes for label in ax.get_legend_handles_labels()[1]}
    assert {"gt", "last scan", "acceptance zone"} <= labels
    assert ("true" in labels) == known
    save_png(figure, tmp_path / "figure.png")
    assert (tmp_path / "figure.png").read_bytes().startswith(b"\x89PNG")


def test_nothing_found_still_gives_a_figure():
    recording = Recording(origin="x", messages=MessageLog([sighting(0.0)]))
    nothing = replay(recording, "thesis", CALIBRATION)

    assert not nothing.estimates
    assert replay_figure(recording, nothing, CALIBRATION).axes


def test_map_is_to_scale_and_an_ellipse_follows_its_covariance():
    from matplotlib.figure import Figure

    ax = Figure().subplots()
    draw_room(ax, CALIBRATION.room)
    assert ax.get_aspect() == 1.0
    draw_scan(ax, scan(0.0), Pose2(x=1.0))
    draw_zone(ax, np.array([1.0, np.inf]), np.zeros(2))
    assert len(ax.lines[-1].get_xdata()) == 1
    draw_ellipse(ax, PoseEstimate(stamp=0.0, pose=Pose2(x=1.0), covariance=np.diag([4.0, 1.0, 1.0])))
    x, y = ax.lines[-1].get_data()
    assert np.ptp(x) == pytest.approx(2 * np.ptp(y), rel=0.01)
    assert np.allclose((x - 1.0) ** 2 / 4 + y**2, 5.991)
