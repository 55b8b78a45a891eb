"""Pictures of a target for the tests: rays against cylinder and boxes, in nothing but numpy."""

from __future__ import annotations

import math

import numpy as np

from estimators.calibration import Calibration
from estimators.marker_fit import CameraModel
from estimators.messages import ImageFrame
from estimators.poses import Array
from estimators.room import Room

DEPTH = 0.02
WALL, FLOOR, SKY, BODY = (0, 170, 119), (96, 84, 72), (70, 100, 150), (255, 69, 0)


def room_calibration(**parts) -> Calibration:
    """The thesis's station in its room."""
    return Calibration(room=Room(vertices=np.array([[-4, -0.03], [4, -0.03], [4, 4.0], [-4, 4.0]])), **parts)


def picture(
    calibration: Calibration,
    pose: tuple[float, float, float],
    direction: float,
    *,
    samples: tuple[int, int] = (8, 3),
    noise: float = 0.0,
    seed: int = 0,
    colors=None,
    lamps=(((0.0, 0.1), (1.0, 1.0, 1.0), 0.35),),
    ambient: float = 0.6,
    target: bool = True,
    wall=WALL,
    extra=None,
) -> np.ndarray:
    """Frame (H, W, 3) of a target at a pose (x, y, yaw), seen in a direction [rad].

    `samples` per pixel, across and down; (1, 1) samples the middle of a pixel. `extra(a, b)` may paint over:
    it gets straight coordinates (N,) and returns a mask (N,) and a colour.
    """
    camera, t = calibration.camera, calibration.target
    model = CameraModel(camera)
    image = np.empty((camera.height, camera.width, 3))
    dx, dy = pose[0] - camera.position[0], pose[1] - camera.position[1]
    d = math.hypot(dx, dy)
    axis = math.remainder(math.atan2(dy, dx) - direction, 2 * math.pi)
    across, down = ((np.arange(n) + 0.5) / n - 0.5 for n in samples)

    def shade(a: Array, b: Array, with_target: bool) -> Array:
        height = -b / model.focal  # per metre ahead
        rgb = np.empty((*a.shape, 3))
        rgb[:] = wall
        ahead = 3.5
        rgb[height > (0.4 - camera.position[2]) / ahead] = SKY
        rgb[height < -camera.position[2] / ahead] = FLOOR
        if with_target:
            paint(rgb, a, b)
        if extra is not None:
            mask, color = extra(a, b)
            rgb[mask] = color
        return rgb

    def paint(rgb: Array, a: Array, b: Array) -> None:
        # In the target's plane: the camera at the origin looks along angle `direction`.
        heading = direction - np.arctan(a / model.focal)
        ray = np.stack([np.cos(heading), np.sin(heading)], axis=-1)
        stretch = np.cos(heading - direction)  # forward depth per metre of ray
        slope = -b / model.focal * stretch
        near = np.full(a.shape, np.inf)
        along = ray @ [dx, dy]
        disc = t.radius**2 - (d * d - along**2)
        hit = along - np.sqrt(np.where(disc > 0, disc, np.nan))
        with np.errstate(invalid="ignore"):
            z = camera.position[2] + slope * hit
            on = (disc > 0) & (z > t.z_min) & (z < t.z_max)
        point = ray[on] * hit[on][:, None] - (dx, dy)
        near[on] = hit[on]
        rgb[on] = 255 * light(point / t.radius)
        for k, angle in enumerate(t.marker_angles):
            color = (colors or t.marker_colors)[k]
            out = np.array([math.cos(pose[2] + angle), math.sin(pose[2] + angle)])
            side = np.array([-out[1], out[0]])
            face = t.radius + t.marker_protrusion
            low, high = (
                np.array([face - DEPTH, -0.5 * t.marker_width]),
                np.array([face, 0.5 * t.marker_width]),
            )
            origin = np.array([-(dx * out[0] + dy * out[1]), -(dx * side[0] + dy * side[1])])
            step = np.stack([ray @ out, ray @ side], axis=-1)
            with np.errstate(divide="ignore", invalid="ignore"):
                enter, leave = (low - origin) / step, (high - origin) / step
            enter, leave = np.minimum(enter, leave), np.maximum(enter, leave)
            which = enter.argmax(axis=-1)
            start = enter.max(axis=-1)
            z = camera.position[2] + slope * start
            on = (
                (start < leave.min(axis=-1))
                & (start < near)
                & (np.abs(z - t.marker_z) < 0.5 * t.marker_height)
            )
            normals = np.where(
                (which == 0)[:, None], -np.sign(step[:, :1]) * out, -np.sign(step[:, 1:]) * side
            )
            rgb[on] = np.array(color) * light(normals[on])
            near[on] = start[on]

    def light(normals: Array) -> Array:
        total = np.full((len(normals), 3), float(ambient))
        for position, color, strength in lamps:
            to = np.subtract(position, pose[:2])
            facing = np.clip(normals @ (to / np.linalg.norm(to)), 0, None)
            total += strength * facing[:, None] * np.array(color)
        return np.minimum(total, 1.0)

    u, v = np.meshgrid(np.arange(camera.width, dtype=float), np.arange(camera.height, dtype=float))
    a, b = model.straighten(u.ravel(), v.ravel())
    image[:] = shade(a, b, False).reshape(image.shape)
    half = math.asin(min(0.99, t.radius / d)) * 1.1 + 0.01
    if target and abs(axis) < 1.2:
        low, high = float(model.column(axis + half)), float(model.column(axis - half))
        tall = (0.5 * (t.z_max - t.z_min) + 0.005) * model.focal / (d * math.cos(axis) - t.radius)
        corners = model.distort(np.array([low, high] * 2), tall * np.array([-1.0, -1.0, 1.0, 1.0]))
        c0, r0 = (max(int(c.min()), 0) for c in corners)
        c1, r1 = (int(c.max()) + 2 for c in corners)
        part = image[r0:r1, c0:c1]
        fine_u = (np.arange(c0, c0 + part.shape[1])[:, None] + across).ravel()
        fine_v = (np.arange(r0, r0 + part.shape[0])[:, None] + down).ravel()
        u, v = np.meshgrid(fine_u, fine_v)
        a, b = model.straighten(u.ravel(), v.ravel())
        fine = shade(a, b, True).reshape(part.shape[0], samples[1], part.shape[1], samples[0], 3)
        part[:] = fine.mean(axis=(1, 3))
    rng = np.random.default_rng(seed)
    if noise:
        image = image + rng.normal(0, noise, image.shape)
    return np.clip(np.rint(image), 0, 255).astype(np.uint8)


def frame(calibration: Calibration, pose: tuple[float, float, float], off: float = 0.0, **how) -> ImageFrame:
    """A frame with the camera turned to the target but for `off` [rad]."""
    c = calibration.camera
    direction = math.atan2(pose[1] - c.position[1], pose[0] - c.position[0]) + off
    rgb = picture(calibration, pose, direction, **how)
    return ImageFrame(stamp=0.0, rgb=rgb, pan=direction - c.pan_offset)
