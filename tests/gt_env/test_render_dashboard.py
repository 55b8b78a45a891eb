import math

import numpy as np
import pytest

from estimators import Calibration, LaserScan, Pose2, PoseEstimate, Room
from gt_env.render import Dashboard
from gt_env.render.history import History
from gt_env.render.station_map import Goal

ROOM = Room(vertices=np.array([(-4.0, -0.03), (4.0, -0.03), (4.0, 4.0), (-4.0, 4.0)]))
NICHE = Room(vertices=np.array([(-1, -0.2), (30, -0.2), (30, 2), (1, 2), (1, 40), (-1, 40)], float))
POSE = Pose2(x=0.5, y=1.5, yaw=1.0)


def estimate(stamp=1.0, x=0.5, y=1.5, yaw=1.0, **kwargs):
    return PoseEstimate(stamp=stamp, pose=Pose2(x=x, y=y, yaw=yaw), covariance=1e-4 * np.eye(3), **kwargs)


def scan(beams=360):
    return LaserScan(
        stamp=1.0,
        ranges=np.full(beams, 2.0),
        bearing_min=0.0,
        bearing_increment=math.pi / beams,
        range_max=6.4,
    )


def draw(dashboard, **changes):
    defaults = {
        "scene": np.full((334, 400, 3), 90, np.uint8),
        "image": np.full((240, 320, 3), 120, np.uint8),
        "scan": scan(),
        "pan": 1.5,
        "t": 1.0,
        "true_pose": POSE,
        "wheel_speeds": [10.0, -10.0],
        "estimates": {"gt": estimate()},
    }
    return dashboard.draw(**{**defaults, **changes})


FAR_AWAY = Pose2(x=1e6, y=-1e6, yaw=0.0)


@pytest.mark.parametrize(
    "changes",
    [
        {},
        {"scene": None, "image": None, "scan": None, "pan": None, "estimates": {}},
        {"image": np.zeros((8, 8, 3), np.uint8)},
        {"image": np.zeros((960, 1280, 3), np.uint8)},
        {"image": np.zeros((8, 500, 3), np.uint8)},
        {"scene": np.zeros((1, 1, 3), np.uint8)},
        {"scan": scan(1)},
        {"estimates": {"gt": PoseEstimate.unknown()}},
        {"estimates": {"gt": estimate(yaw_valid=False)}},
        {"estimates": {"gt": PoseEstimate(stamp=1.0, pose=POSE, covariance=1e6 * np.eye(3))}},
        {"estimates": {"gt": PoseEstimate(stamp=1.0, pose=FAR_AWAY, covariance=np.zeros((3, 3)))}},
        {"estimates": {f"a rather long name {i}": estimate() for i in range(9)}},
        {"true_pose": FAR_AWAY},
        {"wheel_speeds": np.zeros(4, np.float32)},
        {"wheel_speeds": []},
    ],
)
@pytest.mark.parametrize("room", [ROOM, NICHE])
def test_every_frame_has_one_shape(changes, room):
    dashboard = Dashboard(Calibration(room=room), 0.9 * room.vertices)
    estimates = changes.get("estimates", {"gt": estimate()})
    for t in (0.0, 0.5, 1.0):
        dashboard.record(t, changes.get("true_pose", POSE), estimates)
    frame = draw(dashboard, **changes)

    assert frame.shape == (720, 1280, 3)
    assert frame.dtype == np.uint8
    assert frame.flags.c_contiguous


def test_frames_are_fresh_and_repeat():
    dashboard = Dashboard(Calibration(room=ROOM))
    first, second = draw(dashboard), draw(dashboard)

    assert first is not second
    assert np.array_equal(first, second)
    first[:] = 0
    assert np.array_equal(draw(dashboard), second)


@pytest.mark.parametrize("part", ["scene", "image", "scan", "pan"])
def test_every_part_is_to_be_seen(part):
    dashboard = Dashboard(Calibration(room=ROOM))

    assert not np.array_equal(draw(dashboard), draw(dashboard, **{part: None}))


def test_an_image_of_the_scene_size_is_shown_as_it_is():
    width, height = Dashboard.scene_size
    scene = np.random.default_rng(0).integers(0, 255, (height, width, 3), np.uint8)
    frame = draw(Dashboard(Calibration(room=ROOM)), scene=scene)

    windows = np.lib.stride_tricks.sliding_window_view(frame[:80, :80, 0], (5, 5))
    assert (windows == scene[:5, :5, 0]).all(axis=(2, 3)).any()


def test_an_estimate_keeps_its_color():
    dashboard = Dashboard(Calibration(room=ROOM))
    both = {"gt": estimate(), "odometry": estimate(x=1.0)}
    draw(dashboard, estimates=both)
    alone = draw(dashboard, estimates={"odometry": estimate(x=1.0)})

    assert not np.array_equal(
        alone, draw(Dashboard(Calibration(room=ROOM)), estimates={"odometry": estimate(x=1.0)})
    )


def test_reset_forgets_the_trail():
    dashboard = Dashboard(Calibration(room=ROOM))
    before = draw(dashboard)
    for i in range(5):
        dashboard.record(0.1 * i, Pose2(x=0.1 * i, y=1.0), {})
    assert not np.array_equal(draw(dashboard), before)
    dashboard.reset()

    assert np.array_equal(draw(dashboard), before)


def test_errors_are_taken_at_the_stamp():
    history = History()
    history.record(0.0, Pose2(x=0.0, yaw=3.1), {})
    history.record(1.0, Pose2(x=1.0, yaw=-3.1), {})
    distance, yaw = history.error(estimate(stamp=0.5, x=0.5, y=0.002, yaw=math.pi))

    assert distance == pytest.approx(0.002)
    assert yaw == pytest.approx(0.0, abs=1e-9)
    assert history.error(estimate(stamp=1.0, x=1.0, y=0.0, yaw=-3.0)) == pytest.approx((0.0, 0.1))


@pytest.mark.parametrize("said", [PoseEstimate.unknown(), estimate(stamp=2.0), estimate(stamp=-1.0)])
def test_what_cannot_be_compared_has_no_error(said):
    history = History()
    history.record(0.0, POSE, {})
    history.record(1.0, POSE, {})

    assert np.isnan(history.error(said)).all()


def test_history_is_bounded_replaces_the_same_moment_and_starts_anew_when_time_goes_back():
    history = History(length=3)
    for t in (0.0, 1.0, 2.0, 3.0, 3.0):
        history.record(t, Pose2(x=0.5 * t), {"gt": PoseEstimate.unknown() if t == 2.0 else estimate(stamp=t)})

    assert history.times().tolist() == [1.0, 2.0, 3.0]
    assert history.speeds()[1:] == pytest.approx([0.5, 0.5])
    assert np.isnan(history.trail("gt")[:, 0]).tolist() == [False, True, False]
    assert np.isnan(history.errors("odometry")).all()
    history.record(0.0, POSE, {})
    assert len(history) == 1


@pytest.mark.parametrize("is_path", [False, True])
def test_a_goal_is_drawn_in_both_maps_and_named(is_path):
    goal = Goal(points=np.array([(0.4, 1.4), (0.6, 1.6)]), radius=0.1, is_path=is_path)
    without, shown = (draw(Dashboard(Calibration(room=ROOM)), goal=g).astype(int) for g in (None, goal))
    changed = np.abs(shown - without).sum(axis=2) > 0
    panels = {
        "legend": changed[:36, 427:],
        "map": changed[40:460, 427:],
        "close-up": changed[505:705, 427:653],
    }

    assert all(panel.sum() > 20 for panel in panels.values())
    assert sum(panel.sum() for panel in panels.values()) == changed.sum()  # and nowhere else
