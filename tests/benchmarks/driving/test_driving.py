import numpy as np
import pytest

from benchmarks.driving.drives import DRIVES
from benchmarks.driving.segments import (
    SPEED,
    TURN_RATE,
    actions,
    ideal_poses,
    into_room,
    room_scale,
    script,
    start_pose,
)
from estimators.errors import ConfigError
from gt_env.config import load_config


def driven(name, config):
    return ideal_poses(start_pose(name, config), script(name, config), config, period=0.02)


@pytest.mark.parametrize("name", DRIVES)
def test_a_drive_stays_well_inside_the_thesis_room(name):
    config = load_config("thesis")
    room = config.room.in_station_frame()
    assert min(room.clearance((x, y)) for x, y, _ in driven(name, config)) > 0.5


@pytest.mark.parametrize("name", DRIVES)
def test_speeds_are_those_of_the_author(name):
    config = load_config("thesis")
    r, track = config.robot.wheel_radius, config.robot.track
    for _, left, right in script(name, config):
        assert abs(left + right) / 2 * r <= SPEED + 1e-9
        assert abs(right - left) * r / track <= TURN_RATE + 1e-9
    commands = actions(script(name, config), config, step=config.timing.step)
    assert np.abs(commands).max() <= 1.0


def test_path_ends_where_it_began():
    poses = driven("path", load_config("thesis"))
    assert poses[-1, :2] == pytest.approx(poses[0, :2], abs=1e-9)
    assert np.ptp(poses[:, 0]) > 5
    assert np.ptp(poses[:, 1]) > 2


def test_spin_turns_at_least_once_each_way_on_the_spot():
    poses = driven("spin", load_config("thesis"))
    yaw = poses[:, 2]
    turned = np.diff(yaw)
    assert turned[turned > 0].sum() >= 2 * np.pi - 1e-9
    assert -turned[turned < 0].sum() >= 2 * np.pi - 1e-9
    assert np.ptp(poses[:, :2], axis=0).max() < 1e-9


def test_ideal_motion_along_an_arc_is_exact_whatever_the_period():
    config = load_config("thesis")
    quarter = [(2.0, 5.0, 8.0)]
    fine = ideal_poses(start_pose("path", config), quarter, config, period=0.01)[-1]
    coarse = ideal_poses(start_pose("path", config), quarter, config, period=0.5)[-1]
    assert coarse == pytest.approx(fine, abs=1e-9)


def test_a_smaller_room_gets_a_shorter_drive():
    config = load_config("thesis", {"room.vertices": [[-3.0, -0.03], [3.0, -0.03], [3.0, 3.2], [-3.0, 3.2]]})
    assert room_scale(config) == pytest.approx(0.75)
    assert into_room((-4.0, 4.0), config) == pytest.approx((-3.0, 3.2))
    room = config.room.in_station_frame()
    assert min(room.clearance((x, y)) for x, y, _ in driven("tour", config)) > 0.4


def test_a_larger_room_gets_the_same_drive():
    config = load_config("thesis", {"room.vertices": [[-9.0, -0.03], [9.0, -0.03], [9.0, 9.0], [-9.0, 9.0]]})
    assert room_scale(config) == 1.0


def test_a_room_too_small_is_refused_by_name():
    config = load_config(
        "thesis",
        {"room.vertices": [[-1.0, -0.03], [1.0, -0.03], [1.0, 1.2], [-1.0, 1.2]], "robot.start": [0.0, 0.6]},
    )
    with pytest.raises(ConfigError, match=r"room\.vertices: the drive 'path'"):
        script("path", config)


def test_slow_motors_are_refused_with_the_speed_that_is_needed():
    config = load_config("thesis", {"robot.max_wheel_speed": 8.0})
    with pytest.raises(ConfigError, match=r"robot\.max_wheel_speed = 8\.0: must be at least"):
        script("tour", config)
