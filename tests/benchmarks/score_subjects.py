"""Localizers that the tests of the score hand over as `module:Class` and `module:function`."""

from itertools import count

import numpy as np

from estimators.messages import PoseEstimate, WheelOdometry

NOISE = 0.020
"""Standard deviation per axis [m]."""


class Planted:
    """The truth and 20 mm of white noise per axis: what its score must come to is known."""

    wants_truth = True
    seeds = count(7)  # other noise in every run

    def reset(self):
        self.rng = np.random.default_rng(next(self.seeds))
        self.pose = None

    def observe_truth(self, stamp, pose):
        self.pose = pose

    def update(self, message):
        if not isinstance(message, WheelOdometry):
            return None
        pose = self.pose + np.append(self.rng.normal(0.0, NOISE, 2), 0.0)
        covariance = np.diag([NOISE**2, NOISE**2, 1e-6])
        return PoseEstimate(stamp=message.stamp, pose=pose, covariance=covariance)


class Elsewhere(Planted):
    """A clock that is 20 ms slow, and the pose of a point 50 mm ahead of the base, with 5 mm of noise per axis."""

    CLOCK, AHEAD, NOISE = 0.020, 0.050, 0.005

    def update(self, message):
        if not isinstance(message, WheelOdometry) or message.stamp < self.CLOCK:
            return None
        x, y, yaw = self.pose
        pose = np.array([x + self.AHEAD * np.cos(yaw), y + self.AHEAD * np.sin(yaw), yaw])
        pose += self.rng.normal(0.0, [self.NOISE, self.NOISE, 0.002])
        covariance = np.diag([self.NOISE**2, self.NOISE**2, 4e-6])
        return PoseEstimate(stamp=message.stamp - self.CLOCK, pose=pose, covariance=covariance)


class Worse(Planted):
    """Half as much noise again."""

    def update(self, message):
        estimate = super().update(message)
        if estimate is None:
            return None
        pose = estimate.pose.as_array() + np.append(self.rng.normal(0.0, 1.118 * NOISE, 2), 0.0)
        return PoseEstimate(stamp=estimate.stamp, pose=pose, covariance=estimate.covariance)


class Troubled(Planted):
    """Does by turns what it should not, in the first half of each second."""

    def update(self, message):
        answer = super().update(message)
        if answer is None:
            return None
        step = round(message.stamp * 20)
        second, turn = divmod(step, 20)
        if turn >= 10 or second == 0:
            return answer
        match second % 3:
            case 0:
                raise RuntimeError("no idea")
            case 1:
                return PoseEstimate(stamp=answer.stamp, pose=(np.nan, 0.0, 0.0), covariance=np.eye(3))
            case _:
                return PoseEstimate(stamp=answer.stamp - 0.9, pose=answer.pose, covariance=answer.covariance)


class Late(Planted):
    """Answers for a time that is long over."""

    def update(self, message):
        answer = super().update(message)
        if answer is None or answer.stamp < 0.9:
            return None
        return PoseEstimate(stamp=answer.stamp - 0.9, pose=answer.pose, covariance=answer.covariance)


def somewhere(message):
    """A function from message to pose, which does not move."""
    return (0.0, 2.0, 0.0) if isinstance(message, WheelOdometry) else None


def missing_answers(message):
    """Has nothing to say."""
