import math

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

from estimators.errors import ConfigError
from estimators.kinematics import moved
from estimators.poses import Pose2
from gt_env.config import load_config
from gt_env.config.shape import kinematics, robot_shape
from gt_env.robot import action_for

OFF = {"camera": {"enabled": False}, "lrf": {"enabled": False}}
KINDS = ("differential", "skid_steer", "ackermann", "omni3")


def drive(make, robot, action, steps=40, pose=(0.0, 1.7, 0.3)):
    """Way [m] and turn [rad] of the base, true and by odometry, and the ends (2 poses) of a drive and a stop."""
    env = make({**OFF, "robot": {"pulses_per_turn": 1_000_000, **robot}})
    motion = kinematics(env.unwrapped.config.robot)
    env.reset(seed=0, options={"pose": pose})
    odometry, counted, went = Pose2.of(pose), np.zeros(2), np.zeros(2)
    x, y, yaw = pose
    for i in range(steps + 5):
        env.step(np.array(action if i < steps else np.zeros(len(action)), float))
        for m in env.unwrapped.measurements:
            if m.source == "robot/encoders":
                twist = motion.twist(m.speeds)
                odometry = moved(odometry, twist, 0.05)
                counted += 0.05 * np.array([math.hypot(twist[0], twist[1]), twist[2]])
        for _, x2, y2, yaw2 in env.unwrapped.truth:
            went += (math.hypot(x2 - x, y2 - y), math.remainder(yaw2 - yaw, 2 * math.pi))
            x, y, yaw = x2, y2, yaw2
    return went, counted, np.array([x, y, yaw]), odometry.as_array()


STRAIGHT = {
    "differential": (0.2, 0.2),
    "skid_steer": (0.2, 0.2),
    "ackermann": (0.2, 0.0),
    "omni3": (-0.2, 0.0, 0.2),
}


@pytest.mark.parametrize("kind", KINDS)
def test_it_drives_straight_as_far_as_the_wheels_say(make, kind):
    went, counted, end, odometry = drive(make, {"model": kind}, STRAIGHT[kind], pose=(-1.5, 1.7, 0.0))

    assert went[0] > 0.9
    assert went[0] == pytest.approx(counted[0], rel=1e-3)
    assert end[:2] == pytest.approx(odometry[:2], abs=1e-3)
    assert abs(end[2]) < 1e-3


@pytest.mark.parametrize(
    ("kind", "action", "tolerance"),
    [
        ("differential", (-0.1, 0.1), 1e-3),
        ("differential", (0.1, 0.2), 5e-3),
        ("skid_steer", (-0.15, 0.15), 0.01),
        ("skid_steer", (0.2, 0.3), 0.01),
        ("ackermann", (0.2, 0.6), 0.01),
        ("ackermann", (-0.2, 1.0), 0.01),
        ("omni3", (0.1, 0.1, 0.1), 1e-3),
        ("omni3", (0.1, 0.3, -0.1), 2e-3),
    ],
)
def test_it_turns_as_its_kinematics_says(make, kind, action, tolerance):
    went, counted, _, _ = drive(make, {"model": kind}, action)

    assert abs(went[1]) > 1.0
    assert went[1] == pytest.approx(counted[1], rel=tolerance)


@pytest.mark.parametrize("action", [(0.1, 0.3, -0.1), (-0.2, 0.1, 0.2), (0.2, -0.4, 0.2)])
def test_odometry_of_omnidirectional_wheels_is_right_to_a_thousandth(make, action):
    went, _, end, odometry = drive(make, {"model": "omni3"}, action)

    assert np.hypot(*(end - odometry)[:2]) < 1.5e-3 * went[0]


def test_omnidirectional_wheels_go_sideways(make):
    robot = load_config({"robot": {"model": "omni3"}}).robot
    _, _, end, _ = drive(
        make, {"model": "omni3"}, action_for(robot, np.array([0.0, 0.2, 0.0])), pose=(0.0, 1.0, 0.0)
    )

    # While the motors ramp, the slower wheels are there first.
    assert end == pytest.approx([0.0, 1.0 + 0.2 * 4.0, 0.0], abs=0.012)


@pytest.mark.parametrize("kind", KINDS)
def test_an_action_for_a_twist_gives_that_twist(make, kind):
    robot = load_config({"robot": {"model": kind}}).robot
    twist = np.array([0.25, 0.1 if kind == "omni3" else 0.0, 0.5])
    went, _, _, _ = drive(make, {"model": kind}, action_for(robot, twist), steps=60)

    assert went[0] == pytest.approx(6.0 * math.hypot(*twist[:2]), rel=0.02)
    assert went[1] == pytest.approx(6.0 * twist[2], rel=0.03)


@pytest.mark.parametrize("kind", KINDS)
def test_at_rest_it_stays_and_walls_hold_it(make, kind):
    env = make({**OFF, "robot": {"model": kind}})
    env.reset(seed=0, options={"pose": (2.5, 2.0, 0.0)})
    for _ in range(30):
        *_, info = env.step(np.zeros(env.action_space.shape))
    assert info["true_pose"] == pytest.approx([2.5, 2.0, 0.0], abs=3e-4)

    room = env.unwrapped.config.calibration().room
    for _ in range(60):
        *_, info = env.step(np.array(STRAIGHT[kind], float) * 2.5)
        assert room.clearance(info["true_pose"][:2]) > 0.05
    assert info["true_pose"][0] > 3.5


@pytest.mark.parametrize("kind", KINDS)
def test_it_repeats_and_passes_the_checker(kind):
    pytest.importorskip("pybullet")
    config = {"camera": {"enabled": False}, "robot": {"model": kind}}
    env = gym.make("gt_env/Arena-v0", config=config)
    check_env(env.unwrapped, skip_render_check=True)
    ends = []
    for _ in range(2):
        env.reset(seed=3)
        env.action_space.seed(1)
        for _ in range(20):
            obs, *_, info = env.step(env.action_space.sample())
        ends.append([*info["true_pose"], *obs["scan"][::50], *obs["wheel_speeds"]])
    env.close()

    assert ends[0] == ends[1]


@pytest.mark.parametrize("kind", KINDS)
def test_the_tops_of_its_wheels_are_ranged_where_the_plane_cuts_them(make, kind):
    robot = {"model": kind, "ground_clearance": 0.02}
    target = {"z_min": 0.05, "z_max": 0.2, "radius": 0.03}
    lrf = {"height": 0.06, "noise_sigma": 0.0, "beams": 361}
    config = load_config({"robot": robot, "target": target, "camera": {"enabled": False}, "lrf": lrf})
    shape = robot_shape(config.robot, config.target)
    wheel = shape.wheels[0]
    # Stand so that the first wheel's middle is straight ahead of the LRF, and nothing before it.
    bearing = math.atan2(wheel.y, wheel.x)
    pose = Pose2(x=0.0, y=1.0, yaw=-0.5 * math.pi - bearing)
    env = make(config)
    obs, _ = env.reset(seed=0, options={"pose": tuple(pose)})

    distance = 1.0 - math.hypot(wheel.x, wheel.y)
    assert 0.0 < distance - obs["scan"][180] < 0.05
    assert obs["scan"].min() > distance - 0.07


@pytest.mark.parametrize(
    ("robot", "problem"),
    [
        (
            {"model": "tracked"},
            "robot.model = 'tracked'.*'differential', 'skid_steer', 'ackermann' or 'omni3'",
        ),
        ({"model": "skid_steer", "wheelbase": 0.05}, "robot.wheelbase = 0.05: must be above 0.09 m"),
        ({"model": "ackermann", "wheelbase": 0.05}, "robot.wheelbase = 0.05: must be above 0.09 m"),
        ({"height": 0.2}, "robot.height = 0.2: must be above .* and at most target.z_min = 0.0775"),
        (
            {"wheel_joints": ["a", "b"]},
            r"robot.wheel_joints = \['a', 'b'\]: must be 0 names without robot.urdf",
        ),
        ({"urdf": "a.urdf", "wheel_joints": ["a"]}, r"robot.wheel_joints = \['a'\]: must be 2 names with"),
        ({"urdf": "a.urdf", "wheel_joints": ["a", "a"]}, "must be different joints"),
    ],
)
def test_what_cannot_be_is_refused(robot, problem):
    with pytest.raises(ConfigError, match=problem):
        load_config({"robot": robot})
