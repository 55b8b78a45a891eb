"""What is planned fits the room and is what it says; what scans tell is near its limit."""

import math

import numpy as np
import pytest

from benchmarks.driving.segments import SPEED, TURN_RATE
from benchmarks.experiments.course import ContactError, Course, follow
from benchmarks.experiments.moving import EIGHT, moving_runs
from benchmarks.experiments.random_poses import DRIVE_SECONDS, REST_SECONDS, dithered, drive_runs, rest_runs
from benchmarks.experiments.run import simulate
from benchmarks.experiments.scans import measure_scans, scan_runs
from benchmarks.experiments.stress import stress_runs
from estimators.errors import ConfigError
from gt_env.config import load_config

THESIS = load_config("thesis")
CORNER = load_config(
    {"room": {"vertices": [[-0.05, -0.05], [5, -0.05], [5, 4], [-0.05, 4]]}, "robot": {"start": [2, 2]}}
)
METHODS = ("fused", "smooth")


def seeds(n=0):
    return np.random.SeedSequence(n)


@pytest.mark.parametrize("config", [THESIS, CORNER], ids=["thesis", "corner"])
def test_robots_at_rest_stand_away_from_walls_and_lrf_at_headings_all_around(config):
    runs = rest_runs(config, METHODS, 40, seeds())
    room = config.room.in_station_frame()
    assert min(room.clearance((r.pose.x, r.pose.y)) for r in runs) >= 0.5
    assert min(math.hypot(r.pose.x, r.pose.y) for r in runs) >= 1.0
    assert np.histogram([r.pose.yaw for r in runs], 4, (-math.pi, math.pi))[0].min() > 0
    assert all(r.steps * config.timing.step == pytest.approx(REST_SECONDS) for r in runs)
    assert len({r.seed for r in runs}) == len(runs)
    assert all(not r.actions.any() for r in runs)


def test_a_room_without_a_place_to_stand_is_refused():
    tiny = load_config(
        {"room": {"vertices": [[-1, -0.03], [1, -0.03], [1, 1.2], [-1, 1.2]]}, "robot": {"start": [0, 0.6]}}
    )
    with pytest.raises(ConfigError, match=r"room\.vertices: no place found"):
        rest_runs(tiny, METHODS, 1, seeds())


def test_robots_that_drive_about_do_so_within_the_author_s_speeds():
    runs = drive_runs(THESIS, METHODS, 30, seeds())
    robot = THESIS.robot
    speeds = np.concatenate([r.actions for r in runs]) * robot.max_wheel_speed * robot.wheel_radius
    forward, turn = speeds.mean(axis=1), (speeds[:, 1] - speeds[:, 0]) / robot.track
    assert forward.max() <= SPEED + 1e-9
    assert np.abs(turn).max() <= TURN_RATE + 1e-9
    still = (np.abs(speeds) < 1e-9).all(axis=1)
    on_the_spot = (np.abs(forward) < 1e-9) & (np.abs(turn) > 0.1)
    bent = (forward > 0.1) & (np.abs(turn) > 0.05)
    assert min(share.mean() for share in (still, on_the_spot, bent)) > 0.05
    assert {len(r.actions) for r in runs} == {round(DRIVE_SECONDS / THESIS.timing.step)}


def test_further_drives_leave_those_of_the_thesis_as_they_were():
    few = moving_runs(THESIS, ("thesis",), [1, 2, 3], [4, 5])
    other = moving_runs(THESIS, METHODS, [1, 2, 3], [6, 7])
    assert list(few) == ["path", "spin", "tour", EIGHT, "spin-dithered"]
    for name in ("path", "spin", "tour"):
        assert few[name].seed == other[name].seed
        assert (few[name].actions == other[name].actions).all()
    assert few["spin-dithered"].config.pan.dither_deg > 0
    short = moving_runs(THESIS, ("thesis",), [1, 2, 3], [4, 5], longest=3.0)
    assert all(len(r.actions) * r.config.timing.step <= 3.0 + 1e-9 for r in short.values())


def test_without_a_camera_there_is_nothing_to_dither():
    blind = load_config("thesis", {"camera.enabled": False})
    assert dithered(blind) is None
    assert "spin-dithered" not in moving_runs(blind, ("lrf",), [1, 2, 3], [4, 5])


def test_hard_drives_are_as_hard_as_they_say():
    runs = stress_runs(THESIS, METHODS, 2, seeds())
    step = THESIS.timing.step
    for kind in ("swept", "slip", "uneven-slip"):
        assert len(runs[kind]) == 6
        for usual, hard in zip(runs["usual"], runs[kind], strict=True):
            assert hard.seed == usual.seed
            assert (hard.poses == usual.poses).all()
            assert hard.steps * step <= 26
    assert runs["slip"][0].config.robot.slip == 0.05
    assert runs["uneven-slip"][0].config.robot.slip_sigma == 0.02
    assert runs["swept"][0].config.lrf.sweep_time == pytest.approx(0.05)
    whirl, fast = runs["whirl"][0], runs["fast"][0]
    rates = np.diff(whirl.poses[:, 2]) / step
    assert np.degrees([rates.min(), rates.max()]) == pytest.approx([-360, 360], rel=0.01)
    assert np.ptp(whirl.poses[:, :2], axis=0) == pytest.approx([0, 0])
    # What one and the same place does to pixels and beams would otherwise be in every run.
    assert len({tuple(course.poses[0, :2]) for course in runs["whirl"]}) == 6
    speeds = np.hypot(*np.diff(fast.poses[:, :2], axis=0).T) / step
    assert speeds.max() == pytest.approx(1.2, rel=0.01)
    assert np.hypot(fast.poses[:, 0], fast.poses[:, 1] - 0.1).min() >= 2
    for course in (whirl, fast):
        robot = course.config.robot
        moves = np.diff(course.poses, axis=0) / step
        outer = np.hypot(*moves[:, :2].T) + 0.5 * robot.track * np.abs(moves[:, 2])
        assert outer.max() < robot.max_wheel_speed * robot.wheel_radius


def test_a_robot_that_cannot_turn_on_the_spot_is_not_asked_to():
    steered = stress_runs(load_config("thesis", {"robot.model": "ackermann"}), METHODS, 1, seeds())
    assert set(stress_runs(THESIS, METHODS, 1, seeds())) - set(steered) == {"whirl"}


@pytest.mark.slow
def test_a_robot_that_slips_is_kept_on_its_way():
    pytest.importorskip("pybullet")
    blind = load_config("thesis", {"camera.enabled": False})
    tour = stress_runs(blind, ("lrf",), 1, seeds(4100))["uneven-slip"][1]
    found = follow(tour)
    off = np.hypot(*(found.true_pose - tour.poses[1:])[:, :2].T)
    assert off.max() < 0.25
    assert np.sqrt(np.mean(off**2)) < 0.10


def test_a_robot_that_may_touch_a_wall_is_an_error_that_says_when():
    pytest.importorskip("pybullet")
    blind = load_config("thesis", {"camera.enabled": False})
    poses = np.column_stack([np.linspace(3.5, 3.9, 21), np.full(21, 2.0), np.zeros(21)])
    with pytest.raises(
        ContactError, match=r"after .* s the robot was 0\.\d\d m from a wall, and it reaches 0\.15 m"
    ):
        follow(Course(config=blind, methods=("lrf",), poses=poses, seed=0))


def test_scans_alone_come_near_their_limit_and_many_do_better():
    run = scan_runs(THESIS, 150, 3, seeds())["D"]
    counted = []
    found = measure_scans(run, on_step=lambda: counted.append(1))
    assert len(counted) == run.steps
    rmse = np.sqrt(np.mean(np.sum(found.single**2, axis=1)))
    assert 0.85 < rmse / found.limit.rmse < 1.2
    assert found.single_nees.mean() == pytest.approx(2, abs=0.6)
    assert np.sqrt(np.mean(np.sum(found.joint**2, axis=1))) < 0.35 * rmse
    along, across = found.axes
    assert (found.single @ along).std() > 1.5 * (found.single @ across).std()


def test_scans_alone_are_left_out_where_there_is_no_limit():
    assert scan_runs(load_config("thesis", {"lrf.noise_sigma": 0.0}), 10, 1, seeds()) == {}
    assert scan_runs(load_config("thesis", {"lrf.enabled": False}), 10, 1, seeds()) == {}


def test_looking_back_watches_a_run_beside_the_method_it_looks_back_on():
    pytest.importorskip("pybullet")
    (run,) = drive_runs(load_config("narrow"), ("thesis", "fused", "smooth"), 1, seeds(3))
    found = simulate(run)
    assert list(found.tracks) == ["thesis", "fused", "smooth"]
    online, after = found.tracks["fused"], found.tracks["smooth"]
    assert after.stamp == pytest.approx(online.stamp)
    assert after.valid.all()
    later = online.stamp > 2
    errors = [(t.gt_pose - t.true_pose)[later, :2] for t in (online, after)]
    assert max(np.hypot(*e.T).mean() for e in errors) < 0.02
    # What all fixes of a drive this short have in common stays; noise is what looking back takes away.
    jumps = [np.hypot(*np.diff(e, axis=0).T).mean() for e in errors]
    assert jumps[1] < 0.5 * jumps[0]
    stamps = found.innovations["fused"]["frame"][:, 0]
    assert len(stamps) > 0.9 * 30 * DRIVE_SECONDS
    assert (np.diff(stamps) > 0).all()
    alone = simulate(
        type(run)(config=run.config, methods=("smooth",), pose=run.pose, actions=run.actions, seed=run.seed)
    )
    assert list(alone.tracks) == ["smooth"]
    assert (alone.tracks["smooth"].gt_pose == after.gt_pose).all()
