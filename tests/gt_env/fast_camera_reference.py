"""A ray tracer of the scene by brute force, written from the URDF's and the scene's description alone."""

import importlib.util
import math

import numpy as np
import pytest
from ray_solids import ball, box, rotation, upright

from gt_env.config import EnvConfig
from gt_env.fast_camera.renderer import FastRenderer
from gt_env.sensors.rendering import Instant

NUMBA = importlib.util.find_spec("numba") is not None
needs_numba = pytest.mark.skipif(not NUMBA, reason="the exact kernel needs numba (extra fast)")
EYE = (0.0, 0.10)
CASTER_RADIUS, CASTER_GAP, MARKER_DEPTH = 0.012, 5e-5, 0.02


class Tracer:
    """Rays against every solid; a solid is (color, function of origin and direction -> distance, normal)."""

    def __init__(self, config: EnvConfig, x: float, y: float, yaw: float, pan: float) -> None:
        self.config, self.pan = config, pan
        self.solids = []
        self.blockers = []
        c = config
        turn, at = rotation(yaw), np.array([x, y, 0.0])
        t = c.target
        mount = np.array([*t.mount, 0.0])
        z = 0.5 * (t.z_min + t.z_max)
        target_at = at + turn @ (mount + np.array([0, 0, z]))
        self.target_at = target_at
        self.add(t.color, upright(t.radius, t.z_max - t.z_min), target_at, turn, 0.14, blocks=True)
        for degrees, color in zip(t.marker_angles_deg, t.marker_colors, strict=True):
            angle = math.radians(degrees + t.mount_yaw_deg)
            reach = t.radius + t.marker_protrusion - 0.5 * MARKER_DEPTH
            place = mount + np.array([reach * math.cos(angle), reach * math.sin(angle), z])
            shape = box(MARKER_DEPTH, t.marker_width, t.marker_height)
            self.add(color, shape, at + turn @ place, turn @ rotation(angle), 0.025)
        r = c.robot
        tall = t.z_min - r.ground_clearance
        body = box(r.length, r.track - r.wheel_width - 0.004, tall)
        self.add(
            r.color, body, at + np.array([0, 0, r.ground_clearance + 0.5 * tall]), turn, 0.15, blocks=True
        )
        along_y = np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]])
        for side in (1, -1):
            hub = at + turn @ [0, side * 0.5 * r.track, r.wheel_radius]
            self.add(r.wheel_color, upright(r.wheel_radius, r.wheel_width), hub, turn @ along_y, 0.05)
            caster = [side * (0.5 * r.length - 1.5 * CASTER_RADIUS), 0, CASTER_RADIUS + CASTER_GAP]
            self.add(r.wheel_color, ball(CASTER_RADIUS), at + turn @ caster, turn, 0.015)
        self._add_room()

    def _add_room(self) -> None:
        room = self.config.room
        corners = self.config.room.in_station_frame().vertices
        n = len(corners)
        directions = [(corners[(i + 1) % n] - corners[i]) for i in range(n)]
        directions = [d / np.linalg.norm(d) for d in directions]

        def longer(i, j):
            a, b = directions[i], directions[j]
            turn = math.atan2(a[0] * b[1] - a[1] * b[0], a @ b)
            if turn <= 0:
                return 0.0
            return room.wall_thickness * math.tan(0.5 * min(turn, 0.9 * math.pi)) + 0.001

        for i in range(n):
            d = directions[i]
            a = corners[i] - longer(i - 1, i) * d
            b = corners[(i + 1) % n] + longer(i, (i + 1) % n) * d
            middle = 0.5 * (a + b) + 0.5 * room.wall_thickness * np.array([d[1], -d[0]])
            shape = box(np.linalg.norm(b - a), room.wall_thickness, room.wall_height)
            place = np.array([*middle, 0.5 * room.wall_height])
            self.add(room.wall_color, shape, place, rotation(math.atan2(d[1], d[0])), 100.0)
        for o in room.obstacles:
            place = np.array([*o.position, 0.5 * o.height])
            if o.shape == "box":
                self.add(o.color, box(*o.size), place, rotation(math.radians(o.yaw_deg)), 100.0)
            else:
                self.add(o.color, upright(o.radius, o.height), place, np.eye(3), 100.0)
        low, high = corners.min(axis=0), corners.max(axis=0)
        size = high - low + 2.0
        place = np.array([*(0.5 * (low + high)), -0.01])
        self.add(room.floor_color, box(size[0], size[1], 0.02), place, np.eye(3), 100.0)

    def add(self, color, shape, at, turn, bound, blocks=False) -> None:
        at = np.asarray(at, float)

        def hit(origin, direction):
            distance, normal = shape((origin - at) @ turn, direction @ turn)
            return distance, normal @ turn.T

        self.solids.append((np.array(color, float), hit, at, bound))
        if blocks:
            self.blockers.append(hit)

    def colors(self, u, v) -> np.ndarray:
        """RGB (N, 3) at continuous image coordinates."""
        c = self.config.camera
        focal = 0.5 * c.height / math.tan(0.5 * math.radians(c.fov_deg))
        axis = np.array([math.cos(self.pan), math.sin(self.pan), 0.0])
        right = np.array([math.sin(self.pan), -math.cos(self.pan), 0.0])
        across, up = (u - 0.5 * c.width) / focal, (0.5 * c.height - v) / focal
        direction = axis + across[:, None] * right + up[:, None] * [0.0, 0.0, 1.0]
        origin = np.broadcast_to(np.array(c.position), direction.shape)
        nearest = np.full(len(u), np.inf)
        out = np.tile(np.array(self.config.light.backdrop_color, float), (len(u), 1))
        normals = np.zeros((len(u), 3))
        albedo = np.zeros((len(u), 3))
        for color, hit, at, bound in self.solids:
            # Only rays that pass through a square around the solid are followed.
            depth, beside = (at - c.position) @ axis, (at - c.position) @ right
            near = np.arange(len(u))
            if depth > 2 * bound:
                reach = 1.1 * focal * bound / (depth - bound)
                middle = focal * np.array([beside, c.position[2] - at[2]]) / depth
                inside = np.abs(u - 0.5 * c.width - middle[0]) < reach
                near = np.flatnonzero(inside & (np.abs(v - 0.5 * c.height - middle[1]) < reach))
            if len(near):
                distance, normal = hit(origin[near], direction[near])
                closer = distance < nearest[near]
                own = near[closer]
                nearest[own], normals[own], albedo[own] = distance[closer], normal[closer], color
        seen = np.isfinite(nearest)
        points = origin[seen] + nearest[seen][:, None] * direction[seen]
        out[seen] = self._shade(points, normals[seen], albedo[seen])
        return out

    def _shade(self, points, normals, albedo) -> np.ndarray:
        light = self.config.light
        share = np.full((len(points), 3), light.ambient)
        for lamp in light.lamps:
            to_lamp = np.subtract(lamp.position, self.target_at)
            to_lamp = to_lamp / np.linalg.norm(to_lamp)
            cosine = np.maximum(normals @ to_lamp, 0.0)
            if light.shadow:
                start = points + 1e-6 * normals
                for hit in self.blockers:
                    cosine[np.isfinite(hit(start, np.broadcast_to(to_lamp, start.shape))[0])] = 0.0
            share += lamp.intensity * cosine[:, None] * np.array(lamp.color) / 255
        return np.minimum(albedo * share, 255.0)

    def window(self, column, row, width, height, samples=64) -> np.ndarray:
        """Mean colours (height, width, 3) over samples x samples points in pixels that are not uniform."""
        picture = np.zeros((height, width, 3))
        coarse = 5
        fine = (np.arange(samples) + 0.5) / samples
        rough = np.linspace(1e-6, 1 - 1e-6, coarse)
        for i in range(height):
            pixels = np.arange(width)
            u = column + pixels[:, None, None] + rough[None, None, :] + np.zeros((1, coarse, 1))
            v = row + i + rough[None, :, None] + np.zeros((width, 1, coarse))
            colors = self.colors(u.ravel(), v.ravel()).reshape(width, coarse * coarse, 3)
            picture[i] = colors.mean(axis=1)
            mixed = np.flatnonzero(np.ptp(colors, axis=1).max(axis=1) > 1.0)
            if len(mixed):
                u = column + mixed[:, None, None] + fine[None, None, :] + np.zeros((1, samples, 1))
                v = row + i + fine[None, :, None] + np.zeros((len(mixed), 1, samples))
                colors = self.colors(u.ravel(), v.ravel()).reshape(len(mixed), samples * samples, 3)
                picture[i, mixed] = colors.mean(axis=1)
        return picture


def at(distance, bearing_deg, yaw, off=0.0):
    """The robot at a distance [m] and bearing [deg] from the camera, which looks past it by `off` [rad]."""
    bearing = math.radians(bearing_deg)
    return Instant(
        EYE[0] + distance * math.cos(bearing), EYE[1] + distance * math.sin(bearing), yaw, bearing + off
    )


def focal(config):
    return 0.5 * config.camera.height / math.tan(math.radians(0.5 * config.camera.fov_deg))


def errors(config, instant, samples=64):
    """Differences (rows, columns, 3) to the supersampled reference in a window around the robot."""
    picture = FastRenderer(config).picture([instant])
    height, width = picture.shape[:2]
    distance = math.hypot(instant.x - EYE[0], instant.y - EYE[1])
    scale = focal(config) / (distance - 0.15)
    bearing = math.atan2(instant.y - EYE[1], instant.x - EYE[0]) - instant.pan
    middle = 0.5 * width - focal(config) * math.tan(bearing)
    left, right = max(int(middle - 0.15 * scale) - 2, 0), min(int(middle + 0.15 * scale) + 3, width)
    top, low = max(int(0.5 * height - 0.1 * scale) - 2, 0), min(int(0.5 * height + 0.17 * scale) + 3, height)
    reference = Tracer(config, *instant).window(left, top, right - left, low - top, samples)
    return np.abs(picture[top:low, left:right] - reference)


def pixels(config, instant):
    """The picture and the colours in the middle of its pixels, both (rows, columns, 3)."""
    picture = FastRenderer(config).picture([instant]).astype(float)
    v, u = np.mgrid[0 : picture.shape[0], 0 : picture.shape[1]] + 0.5
    return picture, Tracer(config, *instant).colors(u.ravel(), v.ravel()).reshape(picture.shape)


def share_wrong(picture, reference):
    """Share of the pixels that differ by more than 4 grey levels, of those without a border in them."""
    flat = np.ones(picture.shape[:2], bool)  # pixels whose neighbours are alike
    for axis in (0, 1):
        for shift in (1, -1):
            flat &= np.abs(np.roll(reference, shift, axis) - reference).max(axis=2) < 4
    assert flat.mean() > 0.85
    return ((np.abs(picture - reference).max(axis=2) > 4) & flat).mean()
