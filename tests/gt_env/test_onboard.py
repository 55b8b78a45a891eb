"""The robot's own sensors: what they measure, and that nothing changes where they are off."""

import math

import numpy as np
import pytest

from estimators import ImuSample, LaserScan, LocalizerWrapper, Pose2, WheelOdometry
from estimators.errors import ConfigError
from gt_env import load_config
from gt_env.config.onboard import LEAST_SLIP, robot_calibration
from gt_env.config.sections import ImuConfig
from gt_env.sensors.onboard_imu import Imu
from gt_env.sensors.onboard_lidar import MovingRanging

STATION_OFF = {"camera": {"enabled": False}, "lrf": {"enabled": False}}
ON = {**STATION_OFF, "onboard": {"imu": {"enabled": True}, "lidar": {"enabled": True}}}
QUIET = {
    **dict.fromkeys(("gyro_walk_deg", "gyro_bias_sigma_deg", "gyro_bias_walk_deg", "gyro_scale_sigma"), 0.0),
    **dict.fromkeys(("accel_walk", "accel_bias_sigma", "accel_bias_walk", "accel_scale_sigma"), 0.0),
}


def samples(config, yaw_rate=0.0, seconds=100.0, seed=0):
    """Of an IMU that turns evenly (N, 3)."""
    imu, rng = Imu(config), np.random.default_rng(seed)
    imu.reset(rng, (0.0, 0.0, 0.0))
    n = round(seconds * config.rate)
    said = [imu.measure(i / config.rate, (0.0, 0.0, yaw_rate * i / config.rate)) for i in range(1, n + 1)]
    return np.array([[s.yaw_rate, *s.acceleration] for s in said])


def test_they_are_off_unless_asked_for(make):
    env = make(STATION_OFF)
    obs, _ = env.reset(seed=0)

    assert set(obs) == {"wheel_speeds", "stamps"}
    assert {m.source for m in env.unwrapped.measurements} == {"robot/encoders"}


def test_on_they_have_keys_stamps_and_bounds(make, drive):
    env = make(ON)
    obs, _ = env.reset(seed=0)
    assert obs["stamps"].tolist() == [0.0, 0.0, 0.0]
    obs, _ = drive(env, 3, (0.3, 0.2))

    assert {k: (v.shape, v.dtype) for k, v in obs.items()} == {
        "wheel_speeds": ((2,), np.float32),
        "imu": ((3,), np.float32),
        "robot_scan": ((72,), np.float32),
        "stamps": ((3,), np.float64),
    }
    assert obs["stamps"] == pytest.approx([0.3] * 3)
    assert env.observation_space.contains(obs)
    assert all(np.isfinite(s.low).all() and np.isfinite(s.high).all() for s in env.observation_space.values())
    sources = [m.source for m in env.unwrapped.measurements]
    assert sources.count("robot/imu") == 6
    assert sources[-3:] == [
        "robot/imu",
        "robot/encoders",
        "robot/lidar",
    ]  # what predicts before what corrects


def test_they_leave_every_other_sensors_noise_as_it_is_over_episodes(make, drive):
    def seen(config):
        env = make({"camera": {"enabled": False}, **config})
        scans = [env.reset(seed=4)[0]["scan"]]
        for _ in range(2):
            scans += [drive(env, 2, (0.3, 0.2))[0]["scan"], env.reset()[0]["scan"]]
        return scans

    assert np.array_equal(seen({}), seen({"onboard": ON["onboard"]}))


def test_one_that_is_off_leaves_the_other_ones_noise(make, drive):
    def seen(**onboard):
        env = make({**STATION_OFF, "onboard": {k: {"enabled": v} for k, v in onboard.items()}})
        env.reset(seed=4)
        return drive(env, 2, (0.3, 0.2))[0]

    both = seen(imu=True, lidar=True)
    assert np.array_equal(both["imu"], seen(imu=True, lidar=False)["imu"])
    assert np.array_equal(both["robot_scan"], seen(imu=False, lidar=True)["robot_scan"])


def test_a_quiet_gyro_integrates_to_the_true_turn_and_the_accelerometer_to_the_true_speed(make):
    env = make({**STATION_OFF, "onboard": {"imu": {"enabled": True, **QUIET}}})
    env.reset(seed=0, options={"pose": (0.0, 1.0, 0.5)})
    turn = speed = 0.0
    for i in range(20):
        *_, info = env.step(np.array([0.2, 0.26] if i < 15 else [0.2, 0.2]))
        for m in env.unwrapped.measurements:
            if isinstance(m, ImuSample):
                turn, speed = turn + m.yaw_rate / 60, speed + m.acceleration[0] / 60

    assert turn == pytest.approx(info["true_pose"][2] - 0.5, abs=1e-6)
    assert speed == pytest.approx(0.2 * 29.4 * 0.045, rel=0.05)


def test_on_a_circle_the_accelerometer_feels_the_centre():
    imu, rate, speed, turn = Imu(ImuConfig(**QUIET)), 60.0, 0.4, 0.8
    imu.reset(np.random.default_rng(0), (0.0, 0.0, 0.0))
    radius = speed / turn
    for i in range(1, 30):
        a = turn * i / rate
        said = imu.measure(i / rate, (radius * math.sin(a), radius * (1 - math.cos(a)), a))

    assert said.acceleration == pytest.approx([0.0, speed * turn], abs=1e-3)
    assert said.yaw_rate == pytest.approx(turn, abs=1e-9)


def test_the_gyros_angle_walks_by_what_its_data_sheet_says():
    config = ImuConfig(**{**QUIET, "gyro_walk_deg": 0.3, "rate": 8.0})
    rates = np.array([samples(config, seconds=16.0, seed=s)[:, 0] for s in range(200)])
    angles = np.degrees(np.cumsum(rates, axis=1) / config.rate)

    assert angles[:, -1].std() == pytest.approx(0.3 * math.sqrt(16.0), rel=0.15)
    assert angles[:, 31].std() == pytest.approx(0.3 * math.sqrt(4.0), rel=0.15)


def test_bias_scale_and_range_are_what_is_configured():
    biased = samples(ImuConfig(**QUIET, gyro_bias_deg=0.5, accel_bias=(0.1, -0.2)), seconds=1.0)
    assert biased == pytest.approx(np.tile([math.radians(0.5), 0.1, -0.2], (60, 1)))
    assert samples(ImuConfig(**QUIET, gyro_scale=0.02), yaw_rate=1.0, seconds=1.0)[:, 0] == pytest.approx(
        1.02
    )
    clipped = samples(ImuConfig(**QUIET, gyro_range_deg=90.0), yaw_rate=3.0, seconds=1.0)
    assert clipped[:, 0] == pytest.approx(math.pi / 2)
    drawn = [samples(ImuConfig(**{**QUIET, "gyro_bias_sigma_deg": 0.5}), seconds=0.1, seed=s)[0, 0]
             for s in range(200)]  # fmt: skip
    assert math.degrees(np.std(drawn)) == pytest.approx(0.5, rel=0.15)
    walk = ImuConfig(**{**QUIET, "gyro_bias_walk_deg": 0.1})
    ends = [samples(walk, seconds=4.0, seed=s)[-1, 0] for s in range(150)]
    assert math.degrees(np.std(ends)) == pytest.approx(0.2, rel=0.2)


def test_the_lidar_measures_walls_and_obstacles_from_where_it_stands():
    config = load_config(
        {
            "room": {"obstacles": [{"shape": "cylinder", "position": (2.0, 2.0), "radius": 0.2, "height": 1.0}]},
            "onboard": {"lidar": {"enabled": True, "position": (0.05, 0.0), "beams": 4,
                                  "bearing_min_deg": 0.0, "bearing_increment_deg": 90.0}},
        }
    )  # fmt: skip
    ranging = MovingRanging(config)

    assert ranging.cast(0.0, 2.0, 0.0) == pytest.approx([1.75, 2.0, 4.05, 2.03])
    assert ranging.cast(0.0, 2.0, math.pi) == pytest.approx([3.95, 2.03, 1.85, 2.0])
    assert ranging.cast(1.0, 2.0, math.pi / 2) == pytest.approx(
        [1.95, 5.0, 2.08, 1 - math.sqrt(0.2**2 - 0.05**2)]
    )


def test_a_low_obstacle_is_below_the_lidar():
    box = {"shape": "box", "position": (2.0, 2.0), "size": (0.4, 0.4, 0.2)}
    config = load_config(
        {
            "room": {"obstacles": [box]},
            "onboard": {"lidar": {"enabled": True, "beams": 1, "bearing_min_deg": 0.0}},
        }
    )

    assert MovingRanging(config).cast(0.0, 2.0, 0.0) == pytest.approx([4.0])


def test_beside_its_own_target_the_lidar_is_blind_towards_it_and_above_it_nowhere():
    def blocked(**lidar):
        return MovingRanging(load_config({"onboard": {"lidar": {"enabled": True, "beams": 360,
                                                                "bearing_increment_deg": 1.0, **lidar}}}))  # fmt: skip

    assert not blocked().blocked.any()
    beside = blocked(position=(0.20, 0.0), height=0.15)
    half = math.degrees(math.asin(0.10 / 0.20))
    assert beside.blocked.sum() == pytest.approx(2 * half + 1, abs=1)
    assert beside.blocked[0]  # straight back
    assert np.isinf(beside.cast(0.0, 2.0, 0.7)[beside.blocked]).all()
    assert np.isfinite(beside.cast(0.0, 2.0, 0.7)[~beside.blocked]).all()


@pytest.mark.parametrize(
    ("config", "words"),
    [
        (
            {"lidar": {"enabled": True, "height": 0.5}},
            "onboard.lidar.height = 0.5: must be below room.wall_height",
        ),
        ({"lidar": {"enabled": True, "height": 0.2}}, "must be outside the target"),
        ({"lidar": {"enabled": True, "height": 0.05}}, "must be outside the robot's body"),
        ({"lidar": {"range_min": 13.0}}, "onboard.lidar.range_min = 13.0: must be below"),
        ({"lidar": {"enabled": True, "rate": 7.0}}, "onboard.lidar.rate = 7 Hz"),
        ({"imu": {"enabled": True, "rate": 100.0}}, "onboard.imu.rate = 100 Hz"),
        ({"imu": {"gyro_walk_deg": -1.0}}, "onboard.imu.gyro_walk_deg"),
        ({"lidar": {"beamz": 3}}, "onboard.lidar.beamz"),
    ],
)
def test_what_cannot_be_is_refused_with_its_key(config, words):
    with pytest.raises(ConfigError, match=words.replace("(", r"\(")):
        load_config({"onboard": config})


def test_what_the_robot_believes_of_itself_is_what_is_plus_its_errors():
    plain = robot_calibration(load_config().believed())
    assert (plain.wheel_radii, plain.track) == ((0.045, 0.045), 0.215)
    assert plain.slip_sigma == LEAST_SLIP
    wrong = load_config(
        {
            "robot": {"slip_sigma": 0.02, "slip": 0.01},
            "onboard": {
                "encoders": {"radius_error": (0.01, -0.02), "track_error": 0.03, "radius_sigma": 0.0}
            },
            "belief": {"onboard": {"lidar": {"yaw_deg": 2.0}}},
        }
    )
    believed = robot_calibration(wrong.believed())

    assert believed.wheel_radii == pytest.approx((0.045 * 1.01, 0.045 * 0.98))
    assert believed.track == pytest.approx(0.215 * 1.03)
    assert (believed.slip_sigma, believed.radius_sigma) == (0.02, 0.01)
    assert believed.lidar.mount.yaw == pytest.approx(math.radians(2.0))


@pytest.mark.parametrize("name", ["odometry", "gyro_odometry", "ekf", "mcl", "scan_matching"])
def test_every_localizer_finds_its_way_in_the_arena(make, drive, name):
    env = LocalizerWrapper(make({**ON, "lrf": {"enabled": True}}), "own", name)
    env.reset(seed=0, options={"pose": (-1.0, 1.5, 0.4)})
    for action in ((0.25, 0.3), (0.3, 0.2)):
        _, info = drive(env, 20, action)
    off = info["own"]["pose"] - info["true_pose"]

    assert math.hypot(off[0], off[1]) < (0.05 if "odometry" in name else 0.02)
    assert abs(Pose2(yaw=off[2]).yaw) < math.radians(1.5)
    assert info["own"]["stamp"] == pytest.approx(info["t"])
    assert info["own"]["valid"]
    assert not env.estimator.failures


def test_the_localizer_never_hears_the_station(make, drive):
    heard = []
    env = LocalizerWrapper(
        make(ON | {"lrf": {"enabled": True}}), "ear", lambda message: heard.append(message)
    )
    env.reset(seed=0)
    drive(env, 2)

    assert {type(m) for m in heard} == {WheelOdometry, ImuSample, LaserScan}
    assert all(m.source.startswith("robot/") for m in heard)
