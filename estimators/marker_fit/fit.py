"""From a frame and a rough position to bearing and yaw."""

from __future__ import annotations

import math
from typing import Literal

import numpy as np

from estimators.calibration import Calibration
from estimators.errors import MeasurementError
from estimators.marker_fit.assembly import pose_problem
from estimators.marker_fit.association import Associator
from estimators.marker_fit.camera import CameraModel
from estimators.marker_fit.centroids import fit_centroids
from estimators.marker_fit.measurement import MarkerMeasurement
from estimators.marker_fit.outline import TargetOutline
from estimators.marker_fit.photometric import fit_photometric
from estimators.marker_fit.pixels import PixelKind
from estimators.marker_fit.problem import MODEL_ERROR, Problem, Solution, outline_at
from estimators.marker_fit.profile import ProfileReader
from estimators.marker_fit.runs import find_runs
from estimators.marker_fit.sampled import feasible_poses
from estimators.marker_fit.silhouette import find_silhouette
from estimators.messages import ImageFrame
from estimators.poses import Array, wrap_angle
from estimators.two_by_two import inverse

Method = Literal["photometric", "centroids"]
GOOD_RESIDUAL = 0.04
"""Residual of a fit that has found all edges, root mean square [px]."""
WORST_RESIDUAL = 0.3
"""Residual above which what was seen is not the target, root mean square [px]."""
WORST_SAMPLED_RESIDUAL = 1.0
"""The same with one sample a pixel [px]."""
LEAST_SCORE = -7.0
"""Log-likelihood of the markers' places and colours below which they are not those of the target."""
WIDTH_TOLERANCE = 0.06
"""How much the width may differ from the expected one, beyond pixels and the distance's deviation."""


class MarkerFit:
    """Measures bearing and yaw of the target in single frames of one camera.

    Only whether its pixels average over their area is told from all frames since the last reset.

    Args:
        calibration: What is believed of camera and target.
        method: `photometric` compares the whole profile, `centroids` only the middles of the markers.
        model_error: How far lens and target are from what is believed, standard deviation [px]; the fit's own
            misfit widens the covariance where this is too little.
    """

    def __init__(
        self, calibration: Calibration, method: Method = "photometric", model_error: float = MODEL_ERROR
    ) -> None:
        camera = calibration.camera
        self._calibration = camera
        self._target = calibration.target
        self._camera = CameraModel(camera)
        self._reader = ProfileReader(self._camera, camera, calibration.target)
        self._outline = TargetOutline(calibration.target, camera.focal)
        self._period = self._outline.period
        self._associator = Associator(calibration.target, self._outline)
        self._swallowed = 1 - np.asarray(calibration.target.marker_colors, float) / 255
        self._pixels = PixelKind()
        self._method: Method = method
        self._model_error = model_error

    def reset(self) -> None:
        """Forget what kind of pixels the camera has."""
        self._pixels.reset()

    def measure(
        self, frame: ImageFrame, position: tuple[float, float] | Array, covariance: Array
    ) -> MarkerMeasurement | None:
        """Measure the target in a frame.

        Args:
            frame: Of the calibrated camera.
            position: Rough x, y of the target's axis [m], from the LRF.
            covariance: (2, 2) of it [m^2].

        Returns:
            None if the target is not seen, partly hidden or outside the frame, or does not look as it should.

        Raises:
            MeasurementError: If the frame has another size than the calibrated one.
        """
        c = self._calibration
        if frame.rgb.shape[:2] != (c.height, c.width):
            height, width = frame.rgb.shape[:2]
            raise MeasurementError(
                f"the frame is {width} x {height} px, but the camera is calibrated for "
                f"{c.width} x {c.height} px"
            )
        dx, dy = float(position[0]) - c.position[0], float(position[1]) - c.position[1]
        distance = math.hypot(dx, dy)
        if not distance > 1.2 * self._target.radius:
            return None
        ray = np.array([dx, dy]) / distance
        along = math.sqrt(float(ray @ covariance @ ray))
        across = math.sqrt(max(float(covariance[0, 0] + covariance[1, 1]) - along**2, 0.0))
        direction = frame.pan + c.pan_offset
        axis = float(wrap_angle(math.atan2(dy, dx) - direction))
        aside = across / distance
        problem, start, false_colors = self._see(frame, axis, (distance, max(along, 1e-3)), aside)
        if problem is None:
            return None
        rough = self._solve(problem, start)
        if rough is None:
            return None
        solution, linear = rough, None
        if problem.quantised and self._method == "photometric":
            solution, linear = feasible_poses(problem, self._outline, rough), rough
        expected = axis, aside
        return self._measurement(frame.stamp, direction, problem, solution, linear, false_colors, expected)

    def _see(
        self, frame: ImageFrame, axis: float, distance: tuple[float, float], sigma: float
    ) -> tuple[Problem | None, Array, int]:
        """What there is to fit, where to start (3,), and how many colours are false."""
        nothing = (None, np.empty(0), 0)
        d, d_sigma = distance
        profile = self._reader.read(frame.rgb, axis, d, sigma * self._camera.focal / math.cos(axis) ** 2)
        if profile is None:
            return nothing
        silhouette = find_silhouette(profile, float(self._camera.column(axis)))
        if silhouette is None:
            return nothing
        left, right = (float(a) for a in self._camera.angle(np.array(silhouette.edges)))
        axis, half = 0.5 * (left + right), 0.5 * (left - right)
        expected = math.asin(self._target.radius / d)
        slack = 1.5 / self._camera.focal + expected * (WIDTH_TOLERANCE + 4 * d_sigma / d)
        if abs(half - expected) > slack:
            return nothing
        runs = find_runs(profile, silhouette)
        found = runs and self._associator.assign(runs, axis, d)
        if not runs or not found or found.score < LEAST_SCORE:
            return nothing
        sampled = self._pixels.is_sampled(silhouette, runs)
        focal, error = self._camera.focal, self._model_error
        problem = pose_problem(
            self._swallowed, silhouette, runs, found, distance, focal, profile, sampled, error
        )
        return problem, np.array([axis, axis + found.relative, d]), found.false_colors

    def _solve(self, problem: Problem, start: Array) -> Solution | None:
        solution = self._whole(problem, start) or fit_centroids(problem, self._outline, start)
        worst = WORST_SAMPLED_RESIDUAL if problem.quantised else WORST_RESIDUAL
        if not math.sqrt(solution.misfit) * problem.share_error < worst:
            return None
        return solution

    def _whole(self, problem: Problem, start: Array) -> Solution | None:
        """The fit of the whole profile, if that is to be had and finds the edges."""
        if self._method != "photometric" or problem.quantised:
            return None
        rough = fit_centroids(problem, self._outline, start, steps=1)
        widths = outline_at(self._outline, rough.pose).widths
        # Of markers narrower than a pixel the profile shows where they are not, and misleads.
        if widths[problem.markers].max() <= 1.0:
            return None
        whole = fit_photometric(problem, self._outline, rough.pose)
        per_radian = self._outline.focal * self._outline.radius / problem.distance
        moved = abs(whole.pose[1] - rough.pose[1]) * per_radian
        # Steps that lead away from the centroids, to no good fit, have lost the edges.
        good = math.sqrt(whole.misfit) * problem.share_error < GOOD_RESIDUAL
        return whole if moved < (1.0 if good else 0.3) else None

    def _measurement(
        self,
        stamp: float,
        direction: float,
        problem: Problem,
        solution: Solution,
        linear: Solution | None,
        false_colors: int,
        expected: tuple[float, float],
    ) -> MarkerMeasurement:
        """`expected` is the predicted direction of the axis in the camera's frame, and its deviation [rad]."""
        axis, yaw, distance = (float(v) for v in solution.pose)
        # For a given distance: the information's block of bearing and yaw, and how they lean on the distance.
        weighted, _ = inverse(solution.information[:2, :2])
        covariance, repeated = _errors(solution, weighted)
        sensitivity = -weighted @ solution.information[:2, 2]
        # Where samples are the same although the pan has moved, what is seen does not show that it did.
        doubt = expected[1] ** 2 / (expected[1] ** 2 + float(covariance[0, 0]))
        known = expected[0] + doubt * (axis - expected[0])
        pixels = self._camera.focal * np.array(
            [1 / math.cos(axis) ** 2, self._outline.radius / (distance - self._outline.radius)]
        )
        return MarkerMeasurement(
            stamp=stamp,
            bearing=float(wrap_angle(direction + axis)),
            yaw=float(wrap_angle(direction + yaw)),
            distance=distance,
            covariance=np.asarray(covariance, float),
            sensitivity=np.asarray(sensitivity, float),
            camera=self._calibration.position[:2],
            markers=len(problem.markers),
            false_colors=false_colors,
            misfit=solution.misfit,
            quantised=problem.quantised,
            systematic=(
                max(problem.systematic, 1 - 1 / max(1.0, solution.misfit))
                if repeated is None
                else float(repeated[0, 0] / covariance[0, 0])
            ),
            limb_error=problem.lasting_limb * math.cos(axis) ** 2 / self._camera.focal,
            shape_error=problem.middle_error,
            marker_error=problem.markers_aside / self._target.radius,
            lean=float(covariance[0, 1] / covariance[0, 0]),
            scale_error=problem.scale_error,
            view=np.array([float(self._camera.column(known)), (yaw - axis) * pixels[1]]),
            direction=float(direction),
            pixels=pixels,
            samples=problem.samples,
            period=self._period,
            linear=linear,
            repeated=repeated,
        )


def _errors(solution: Solution, weighted: Array) -> tuple[Array, Array | None]:
    """Covariances (2, 2) of bearing and yaw at a given distance: all, and what lasts, if that is no mere share.

    Args:
        solution: The fit.
        weighted: What they would be if errors were as the fit weighs them (2, 2).
    """
    # What the model does not explain is no pixel noise, and residuals show how large it is.
    unexplained = max(solution.misfit - 1.0, 0.0) * weighted
    if solution.errors is None:
        return weighted + unexplained, None
    return solution.errors.sum(axis=0) + unexplained, solution.errors[1] + unexplained
