"""`estimators` on its own: no simulator, no benchmarks, and Gymnasium only for the wrappers."""

import json
import subprocess
import sys

BLOCKED = """
import sys

class Blocked:
    def find_spec(self, name, path=None, target=None):
        if name.split(".")[0] in {names}:
            raise ImportError(name + " is blocked")

sys.meta_path.insert(0, Blocked())
"""

REPLAY = """
import json
import math
import numpy as np
from estimators import Calibration, ImageFrame, LaserScan, Room, WheelOdometry, ground_truth_estimator

room = Room(vertices=[(-4, -0.03), (4, -0.03), (4, 4), (-4, 4)])
ranges = np.full(360, 5.9)
ranges[176:187] = 1.9
image = np.full((240, 320, 3), (0, 200, 140), np.uint8)
image[70:170, 110:211] = 255
image[110:130, 158:163] = (0, 0, 255)
estimator = ground_truth_estimator("thesis", Calibration(room=room))
for stamp in (0.0, 0.1, 0.2):
    estimator.update(LaserScan(stamp=stamp, ranges=ranges, bearing_min=0.0, bearing_increment=math.pi / 360,
                               range_max=6.4))
    estimator.update(WheelOdometry(stamp=stamp, speeds=[0.0, 0.0]))
    answer = estimator.update(ImageFrame(stamp=stamp, rgb=image, pan=1.57))
print(json.dumps([*answer.pose, answer.stamp, answer.yaw_valid]))
"""


def run(code, root):
    return subprocess.run([sys.executable, "-c", code], cwd=root, capture_output=True, text=True, timeout=60)


def test_the_thesis_method_runs_where_there_is_no_simulator(pytestconfig):
    blocked = BLOCKED.format(names=("pybullet", "pybullet_data", "gt_env", "benchmarks"))
    done = run(blocked + "from estimators import GroundTruthWrapper\n" + REPLAY, pytestconfig.rootpath)

    assert done.returncode == 0, done.stderr
    x, y, yaw, stamp, yaw_valid = json.loads(done.stdout)
    assert abs(x) < 0.02
    assert abs(y - 2.0) < 1e-3
    assert abs(yaw) < 0.03
    assert (stamp, yaw_valid) == (0.2, True)


def test_without_gymnasium_all_but_the_wrappers_works(pytestconfig):
    blocked = BLOCKED.format(names=("pybullet", "gt_env", "benchmarks", "gymnasium"))
    done = run(blocked + REPLAY, pytestconfig.rootpath)
    assert done.returncode == 0, done.stderr

    done = run(blocked + "from estimators import GroundTruthWrapper", pytestconfig.rootpath)
    assert "gymnasium is blocked" in done.stderr
