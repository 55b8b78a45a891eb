"""Solids that rays are followed to: functions of origins and directions (N, 3) that give distances and normals."""

import math

import numpy as np


def rotation(yaw: float) -> np.ndarray:
    c, s = math.cos(yaw), math.sin(yaw)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def box(*size):
    half = 0.5 * np.array(size)

    def hit(origin, direction):
        safe = np.where(np.abs(direction) < 1e-300, 1e-300, direction)
        one, two = (-half - origin) / safe, (half - origin) / safe
        enter, leave = np.minimum(one, two), np.maximum(one, two)
        axis = enter.argmax(axis=1)
        rows = np.arange(len(origin))
        first, last = enter[rows, axis], leave.min(axis=1)
        normal = np.zeros_like(origin)
        normal[rows, axis] = -np.sign(direction[rows, axis])
        return np.where((first <= last) & (first > 0), first, np.inf), normal

    return hit


def upright(radius, length):
    """A cylinder along z."""

    def hit(origin, direction):
        nearest = np.full(len(origin), np.inf)
        normal = np.zeros_like(origin)
        a = direction[:, 0] ** 2 + direction[:, 1] ** 2
        b = origin[:, 0] * direction[:, 0] + origin[:, 1] * direction[:, 1]
        rest = b * b - a * (origin[:, 0] ** 2 + origin[:, 1] ** 2 - radius**2)
        with np.errstate(all="ignore"):
            t = (-b - np.sqrt(rest)) / a
            z = origin[:, 2] + t * direction[:, 2]
            side = (rest > 0) & (t > 0) & (np.abs(z) <= 0.5 * length)
            for end in (0.5 * length, -0.5 * length):
                s = (end - origin[:, 2]) / direction[:, 2]
                p = origin[:, :2] + s[:, None] * direction[:, :2]
                cap = (s > 0) & ((p**2).sum(axis=1) < radius**2) & (s < nearest)
                nearest[cap] = s[cap]
                normal[cap] = [0, 0, np.sign(end)]
        side &= t < nearest
        nearest[side] = t[side]
        p = origin + np.where(side, t, 0.0)[:, None] * direction
        normal[side] = np.stack([p[:, 0], p[:, 1], np.zeros(len(p))], axis=1)[side] / radius
        return nearest, normal

    return hit


def ball(radius):
    def hit(origin, direction):
        a = (direction**2).sum(axis=1)
        b = (origin * direction).sum(axis=1)
        rest = b * b - a * ((origin**2).sum(axis=1) - radius**2)
        with np.errstate(all="ignore"):
            t = (-b - np.sqrt(rest)) / a
            t = np.where((rest > 0) & (t > 0), t, np.inf)
            normal = (origin + np.where(np.isfinite(t), t, 0.0)[:, None] * direction) / radius
        return t, normal

    return hit
