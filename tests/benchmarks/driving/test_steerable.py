"""Every drive for every robot: arcs for those that cannot turn on the spot, steering for those that slide."""

import numpy as np
import pytest

from benchmarks.driving.drives import DRIVES
from benchmarks.driving.segments import actions, ideal_poses, script, start_pose
from benchmarks.driving.steerable import steerable, turning_radius
from benchmarks.experiments.moving import moving_runs
from benchmarks.experiments.random_poses import drive_runs
from benchmarks.experiments.run import simulate, standing
from gt_env.config import load_config
from gt_env.config.shape import kinematics

MODELS = ("differential", "skid_steer", "ackermann", "omni3")
STEERED = load_config("thesis", {"robot.model": "ackermann"})


def ends(moves):
    """Pose after each move, by complex numbers."""
    place, heading, found = 0j, 0.0, []
    for forward, turn in moves:
        chord = forward * np.sinc(0.5 * turn / np.pi)
        place += chord * np.exp(1j * (heading + 0.5 * turn))
        heading += turn
        found.append((place, heading))
    return found


def test_an_arc_in_place_of_a_corner_leads_onto_the_same_lines():
    corner = 0.5 * np.pi
    moves = [(2.0, 0.0), (0.0, 0.0), (0.0, corner), (1.5, 0.0), (0.0, -corner), (1.0, 0.0)]
    found = steerable(moves, 0.3)
    assert ends(found)[-1] == pytest.approx(ends(moves)[-1])
    assert all(forward >= 0.3 * abs(turn) - 1e-12 for forward, turn in found)
    assert found[0] == pytest.approx((1.7, 0.0))


def test_a_whole_turn_is_left_out_on_a_way_and_a_circle_where_there_is_none():
    assert steerable([(1.0, 0.0), (0.0, 2 * np.pi), (1.0, 0.0)], 0.3) == [(1.0, 0.0), (0.0, 0.0), (1.0, 0.0)]
    ((way, turn),) = steerable([(0.0, -4 * np.pi)], 0.3)
    assert (way, turn) == pytest.approx((0.3 * 4 * np.pi, -4 * np.pi))


def test_robots_that_turn_on_the_spot_keep_their_drives():
    for model in ("differential", "skid_steer", "omni3"):
        radius = turning_radius(load_config("thesis", {"robot.model": model}).robot)
        assert all(steerable(drive.moves, radius) == list(drive.moves) for drive in DRIVES.values())


def test_no_drive_asks_more_of_a_steered_robot_than_it_can():
    for name in DRIVES:
        commands = actions(script(name, STEERED), STEERED, STEERED.timing.step)
        driven = commands[np.abs(commands[:, 0]) > 1e-9]
        assert np.abs(driven[:, 1]).max() < 1
        assert driven[:, 0].min() > 0
    for run in drive_runs(STEERED, ("lrf",), 6, np.random.SeedSequence(5)):
        assert np.abs(run.actions).max() < 1


@pytest.mark.parametrize("model", MODELS)
def test_actions_are_those_with_which_the_robot_goes_where_one_with_two_wheels_would(model):
    config = load_config("thesis", {"robot.model": model})
    robot, segments = config.robot, [(0.5, 8.0, 10.0), (0.5, 9.0, 9.0)]
    commands = actions(segments, config, 0.1)
    assert commands.shape == (10, 3 if model == "omni3" else 2)
    assert standing(config, 4).shape == (4, commands.shape[1])
    poses = ideal_poses(start_pose("path", config), segments, config, 0.1)
    rate = (poses[1, 2] - poses[0, 2]) / 0.1
    if model == "ackermann":
        twist = kinematics(robot).driven(
            robot.max_wheel_speed * commands[0, 0], np.radians(30) * commands[0, 1]
        )
    else:
        twist = kinematics(robot).twist(robot.max_wheel_speed * commands[0])
    assert twist == pytest.approx([9.0 * robot.wheel_radius, 0.0, rate])


@pytest.mark.parametrize("model", ["skid_steer", "ackermann", "omni3"])
def test_every_robot_makes_every_drive(model):
    pytest.importorskip("pybullet")
    config = load_config("thesis", {"camera.enabled": False, "robot.model": model})
    runs = moving_runs(config, ("lrf",), [1, 2, 3], [4, 5], longest=6.0)
    assert {"path", "spin", "tour"} <= set(runs)
    for name, run in runs.items():
        found = simulate(run)
        off = np.hypot(*(found.true_pose[:, :2] - run.poses[1 : 1 + len(found.t), :2]).T)
        assert off.max() < 0.15, name
        assert np.ptp(found.true_pose[:, :2], axis=0).max() > 0.1 or name.startswith("spin")
