"""A fake arena to play in, and what the tests of playing do with a session."""

import gymnasium as gym
import numpy as np

from estimators import LaserScan, Pose2, WheelOdometry
from gt_env.config import load_config
from gt_env.config.sections import RobotConfig
from gt_env.render.window import Keys

ROBOT = RobotConfig()
STEP = 0.02


class FakeArena(gym.Env):
    """A robot that moves as its wheels say, seen by a station that is always right."""

    def __init__(self, valid=True):
        self.config = load_config(
            {
                "timing": {"step": STEP, "tick": STEP / 2},
                "lrf": {"rate": 50.0},
                "robot": {"encoder_rate": 50.0},
            }
            | {"camera": {"rate": 50.0}, "pan": {"control_rate": 50.0}}
        )
        self.valid = valid
        self.closed = False
        self.actions = []

    def reset(self, *, seed=None, options=None):
        self.t, self.pose = 0.0, self.config.start_pose
        self.measurements, self.truth = (), []
        return self._observation(np.zeros(2)), self._info()

    def step(self, action):
        speeds = action * ROBOT.max_wheel_speed
        self.actions.append(speeds)
        turn = (speeds[1] - speeds[0]) * ROBOT.wheel_radius / ROBOT.track * STEP
        self.pose = self.pose @ Pose2(x=speeds.mean() * ROBOT.wheel_radius * STEP, yaw=turn)
        self.t = len(self.actions) * STEP
        self.truth = [(self.t - STEP / 2, *self.pose), (self.t, *self.pose)]
        ranges = np.full(5, 2.0)
        self.measurements = (
            WheelOdometry(stamp=self.t, speeds=speeds),
            LaserScan(stamp=self.t, ranges=ranges, bearing_min=0, bearing_increment=0.5, range_max=6.4),
            LaserScan(
                stamp=self.t,
                ranges=ranges,
                bearing_min=0,
                bearing_increment=0.5,
                range_max=6.4,
                source="robot/lidar",
            ),
        )
        return self._observation(speeds), 0.0, False, False, self._info()

    def render(self):
        return np.zeros((72, 128, 3), np.uint8)

    def close(self):
        self.closed = True

    def _observation(self, speeds):
        return {"wheel_speeds": speeds.astype(np.float32), "camera_pan": np.array([1.5], np.float32)}

    def _info(self):
        gt = {"pose": self.pose.as_array(), "covariance": 1e-4 * np.eye(3), "stamp": self.t}
        gt |= {"valid": self.valid, "yaw_valid": self.valid}
        return {"true_pose": self.pose.as_array(), "t": self.t, "gt": gt}


def press(session, *keys, held=()):
    assert session.tick(Keys(frozenset(held), keys))


def files(session):
    folder = session._out
    return sorted(path.name for path in folder.iterdir()) if folder.exists() else []
