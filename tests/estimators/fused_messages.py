"""What a noisy station says of a robot, for the tests of the fused method."""

import math

import marker_picture as pictures

from estimators import ImageFrame, wrap_angle

CALIBRATION = pictures.room_calibration()


def frame(pose, stamp, calibration=CALIBRATION):
    picture = pictures.frame(calibration, pose, samples=(4, 1), seed=round(1000 * stamp))
    return ImageFrame(stamp=stamp, rgb=picture.rgb, pan=picture.pan)


def feed(estimator, messages):
    answers = [estimator.update(m) for m in messages]
    return [a for a in answers if a is not None]


def drive(scan, until=1.0, speed=0.4):
    """Poses by stamp, and messages in the order of their stamps, of a robot that drives straight on."""
    poses = {}
    messages = []
    for i in range(round(until * 20)):
        t = i / 20
        poses[t] = (-1.0 + speed * t * math.cos(0.3), 2.0 + speed * t * math.sin(0.3), 0.3)
        if i % 2 == 0:
            messages.append(scan(poses[t][:2], t))
        messages.append(frame(poses[t], t))
    return poses, messages


def off(estimate, pose):
    error = estimate.pose.as_array() - pose
    error[2] = wrap_angle(float(error[2]))
    return error
