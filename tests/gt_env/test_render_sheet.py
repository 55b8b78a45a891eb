"""The numbers beside the picture: small ones keep a digit that says something, and zero has no sign."""

import numpy as np

from estimators import Pose2, PoseEstimate
from gt_env.render.sheet import _estimate_cells


def test_a_deviation_below_one_has_one_digit_more():
    covariance = np.diag([0.04e-3, 2.5e-3, np.radians(0.0123)]) ** 2
    cells = _estimate_cells(
        PoseEstimate(stamp=1.0, pose=Pose2(x=-1e-9, y=2.0), covariance=covariance), (0.3e-3, -1e-9)
    )

    assert cells == ["0.000", "2.000", "0.00", "0.04", "2.5", "0.012", "0.30", "+0.000"]
