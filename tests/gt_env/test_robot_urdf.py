import math

import numpy as np
import pytest

from estimators.errors import ConfigError
from gt_env.config import load_config
from gt_env.config.shape import kinematics
from gt_env.robot import action_for

OFF = {"camera": {"enabled": False}, "lrf": {"enabled": False}}
CART = """<robot name="cart">
  <link name="root"/>
  <link name="frame"><inertial><mass value="3"/><inertia ixx="0.03" iyy="0.03" izz="0.03" ixy="0" ixz="0" iyz="0"/>
  </inertial><visual><geometry>{looks}</geometry></visual></link>
  <joint name="up" type="fixed"><parent link="root"/><child link="frame"/><origin xyz="0.3 0 0.05"/></joint>
  <link name="wheel_l"><inertial><mass value="0.2"/><inertia ixx="1e-4" iyy="2e-4" izz="1e-4" ixy="0" ixz="0" iyz="0"/>
  </inertial></link>
  <joint name="left" type="continuous"><parent link="frame"/><child link="wheel_l"/>
    <origin xyz="0 0.11 0" rpy="{roll} 0 0"/><axis xyz="{axis}"/></joint>
  <link name="wheel_r"><inertial><mass value="0.2"/><inertia ixx="1e-4" iyy="2e-4" izz="1e-4" ixy="0" ixz="0" iyz="0"/>
  </inertial></link>
  <joint name="right" type="continuous"><parent link="frame"/><child link="wheel_r"/>
    <origin xyz="0 -0.11 0"/><axis xyz="0 1 0"/></joint>
</robot>"""
BOX = '<box size="0.2 0.15 0.04"/>'


@pytest.fixture
def cart(tmp_path):
    """A function that writes the description of a cart and gives the configuration that fits it."""

    def written(looks=BOX, roll=0.0, axis="0 1 0", **robot):
        file = tmp_path / "cart.urdf"
        file.write_text(CART.format(looks=looks, roll=roll, axis=axis))
        own = {"urdf": str(file), "wheel_joints": ["left", "right"], "track": 0.22, "wheel_radius": 0.05}
        return {**OFF, "robot": {**own, "urdf_base": [0.3, 0.0, 0.0], "pulses_per_turn": 1_000_000, **robot}}

    return written


def run(env, twist, steps=40, pose=(0.0, 1.7, 0.3)):
    """Way [m] and turn [rad] of a drive."""
    env.reset(seed=0, options={"pose": pose})
    action = action_for(env.unwrapped.config.robot, np.array(twist, float))
    x, y, yaw = pose
    way = turn = 0.0
    for _ in range(steps):
        env.step(action)
        for _, x2, y2, yaw2 in env.unwrapped.truth:
            way += math.hypot(x2 - x, y2 - y)
            turn += math.remainder(yaw2 - yaw, 2 * math.pi)
            x, y, yaw = x2, y2, yaw2
    return way, turn


@pytest.mark.parametrize(
    ("preset", "twist", "tolerance"),
    [
        ("husky", (0.4, 0.0, 0.0), 0.06),
        ("husky", (0.3, 0.0, 0.3), 0.1),
        ("husky", (0.2, 0.0, -0.5), 0.1),
        ("racecar", (0.3, 0.0, 0.0), 0.05),
        ("racecar", (0.3, 0.0, 0.4), 0.05),
        ("racecar", (-0.3, 0.0, 0.4), 0.05),
    ],
)
def test_models_of_others_drive_as_their_kinematics_says(make, preset, twist, tolerance):
    env = make({"preset": preset, **OFF})
    way, turn = run(env, twist)

    assert way == pytest.approx(4.0 * math.hypot(*twist[:2]), rel=tolerance)
    assert turn == pytest.approx(4.0 * twist[2], rel=tolerance, abs=0.01)


@pytest.mark.parametrize("preset", ["husky", "racecar"])
def test_the_station_sees_the_target_above_models_of_others(make, preset):
    env = make({"preset": preset, "lrf": {"noise_sigma": 0.0}})
    obs, _ = env.reset(seed=0, options={"pose": (0.0, 2.0, 0.5)})
    believed = env.unwrapped.believed_calibration.target
    x = believed.mount.x
    distance = math.hypot(x * math.cos(0.5), 2.0 + x * math.sin(0.5)) - believed.radius

    assert obs["scan"].min() == pytest.approx(distance, abs=2e-3)
    bright = (obs["image"] > 120).all(axis=2)
    _, columns = np.nonzero(bright[:130])
    focal = 120 / math.tan(math.radians(14.8))
    assert np.ptp(columns) == pytest.approx(2 * 0.1 * focal / distance, rel=0.15)


def test_a_urdf_of_ones_own_drives(make, cart):
    env = make(cart())
    way, turn = run(env, (0.2, 0.0, 0.6))

    assert way == pytest.approx(0.8, rel=0.02)
    assert turn == pytest.approx(2.4, rel=0.02)


def test_axes_that_point_the_other_way_still_drive_forwards(make, cart):
    for config in (
        cart(axis="0 -1 0"),
        cart(roll=math.pi / 2, axis="0 0 -1"),
        cart(roll=math.pi / 2, axis="0 0 1"),
    ):
        env = make(config)
        way, turn = run(env, (0.2, 0.0, 0.0), pose=(-1.0, 2.0, 0.0))

        assert way == pytest.approx(0.8, rel=0.02)
        assert abs(turn) < 0.01
        assert env.unwrapped.truth[-1][1] > -0.5


def test_its_body_is_held_by_walls(make, cart):
    env = make(cart())
    env.reset(seed=0, options={"pose": (3.0, 2.0, 0.0)})
    for _ in range(40):
        *_, info = env.step(np.array([0.3, 0.3]))

    assert 3.8 < info["true_pose"][0] < 3.905


@pytest.mark.parametrize(
    ("robot", "problem"),
    [
        ({"wheel_joints": ["left", "wheel"]}, r"has no joint 'wheel'; its joints that move are left, right"),
        (
            {"track": 0.3},
            r"the wheel of 'left' in .* has its middle at \(0\.0000, 0\.1100, 0\.0500\).*put it at .*0\.1500",
        ),
        ({"wheel_radius": 0.06}, "put it at"),
        ({"urdf_base": [0.0, 0.0, 0.0]}, r"has its middle at \(0\.3000"),
        (
            {"urdf": "nowhere/robot.urdf"},
            "robot.urdf = 'nowhere/robot.urdf': must be a URDF file that exists",
        ),
        ({"urdf": __file__}, "must be a URDF file: "),
    ],
)
def test_what_does_not_fit_the_file_is_refused(make, cart, robot, problem):
    config = cart()
    with pytest.raises(ConfigError, match=problem):
        make({**config, "robot": {**config["robot"], **robot}})


def test_a_missing_mesh_and_a_crooked_axis_are_refused(make, cart):
    with pytest.raises(ConfigError, match=r"its mesh 'meshes/body\.stl' must exist"):
        make(cart(looks='<mesh filename="meshes/body.stl"/>'))
    with pytest.raises(ConfigError, match=r"joint 'left': its axis must point along"):
        make(cart(axis="1 0 0"))


@pytest.mark.parametrize(
    ("target", "problem"),
    [
        ({"z_min": 0.02}, "target.z_min = 0.02: must be above robot.ground_clearance"),
        (
            {"z_min": 0.08, "z_max": 0.2},
            "lrf.height = 0.225: must be between .* else the LRF does not see the target",
        ),
    ],
)
def test_a_target_that_the_station_would_not_see_is_refused(target, problem):
    with pytest.raises(ConfigError, match=problem):
        load_config({"target": target})


def test_a_target_within_a_tall_body_is_refused():
    with pytest.raises(ConfigError, match=r"robot\.height = 0\.41.*at most target\.z_min = 0\.3"):
        load_config("husky", {"target.z_min": 0.3})


def test_presets_have_the_measures_of_their_files():
    # What is measured from the files is checked when they are loaded; this is what follows from it.
    assert kinematics(load_config("racecar").robot).wheelbase == 0.325
    assert kinematics(load_config("husky").robot).equivalent.track > 0.5708
