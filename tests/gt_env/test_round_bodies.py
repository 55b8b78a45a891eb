"""The renderer that samples draws round bodies round: edges lie where the exact projection of a cylinder puts them."""

import math
from xml.etree import ElementTree as ET

import numpy as np
import pytest

from estimators.poses import Pose2
from gt_env.config import load_config
from gt_env.robot_model import FLAT_MESH, ROUND_MESH, built_in_robot
from gt_env.sensors.rendering import Instant, camera_view, target_middle

ROUND = 0.02
"""What flat sides may leave of an edge at the distances here [px]."""


def read(file):
    """Corners (n, 3), normals (m, 3), and for each triangle (k, 3, 2) which of both its corners have."""
    lines = [line.split() for line in file.read_text().splitlines()]
    corners, normals = (
        np.array([line[1:] for line in lines if line[0] == kind], float) for kind in ("v", "vn")
    )
    faces = [[part.split("//") for part in line[1:]] for line in lines if line[0] == "f"]
    return corners, normals, np.array(faces, int) - 1


def outline(corners):
    """How far a mesh reaches from its axis in all directions."""
    around = np.linspace(-math.pi, math.pi, 20_001)[:-1]
    return (corners[:, :1] * np.cos(around) + corners[:, 1:2] * np.sin(around)).max(axis=0)


def test_the_round_mesh_is_as_wide_as_a_cylinder_on_average_and_nowhere_far_from_it():
    corners, _, _ = read(ROUND_MESH)
    reach = outline(corners)
    assert reach.mean() == pytest.approx(1.0, abs=1e-7)
    assert np.abs(reach - 1).max() < 4e-4
    assert (corners[:, 2].min(), corners[:, 2].max()) == (-0.5, 0.5)


def test_the_flat_mesh_has_its_sixteen_edges_on_the_cylinder():
    corners, normals, _ = read(FLAT_MESH)
    reach = outline(corners)
    assert reach.max() == pytest.approx(1.0, abs=1e-7)
    assert reach.min() == pytest.approx(math.cos(math.pi / 16), abs=1e-6)
    assert len(normals) == 16 + 2
    assert (corners[:, 2].min(), corners[:, 2].max()) == (-0.5, 0.5)


@pytest.mark.parametrize(("sides", "mesh"), [(96, ROUND_MESH), (16, FLAT_MESH)])
def test_the_target_is_seen_with_the_sides_it_is_configured_with(sides, mesh):
    config = load_config({"target": {"sides": sides}})
    urdf = ET.fromstring(built_in_robot(config.robot, config.target).urdf)
    assert [seen.get("filename") for seen in urdf.find("link").iter("mesh")] == [str(mesh)]


@pytest.mark.parametrize(("file", "sides"), [(ROUND_MESH, 96), (FLAT_MESH, 16)])
def test_meshes_are_closed_and_their_faces_and_normals_point_outwards(file, sides):
    corners, normals, faces = read(file)
    a, b, c = corners[faces[:, :, 0]].transpose(1, 0, 2)
    flat = np.cross(b - a, c - a)
    along = np.einsum("kj,kij->ki", flat, normals[faces[:, :, 1]])
    assert (along > 0.98 * np.linalg.norm(flat, axis=1)[:, None]).all()
    assert flat.sum(axis=0) == pytest.approx([0, 0, 0], abs=1e-9)
    radius = np.hypot(*corners[0, :2])
    volume = 0.5 * sides * radius**2 * math.sin(2 * math.pi / sides)
    assert np.einsum("kj,kj->", a, flat) / 6 == pytest.approx(volume, rel=1e-6)


@pytest.fixture(scope="module")
def pictures():
    """Robots at random places, each with its distance, direction from the camera's axis, and yaw less its bearing."""
    pytest.importorskip("pybullet")
    from gt_env.world import World

    config = load_config({})
    world, rng = World(config), np.random.default_rng(3)
    found = []
    try:
        for _ in range(24):
            distance, bearing = rng.uniform(1.0, 3.4), rng.uniform(1.0, 2.1)
            x, y = distance * math.cos(bearing), 0.1 + distance * math.sin(bearing)
            pose = Pose2(x=x, y=y, yaw=float(rng.uniform(-math.pi, math.pi)))
            instant = Instant(x, y, pose.yaw, bearing + float(rng.uniform(-0.01, 0.01)))
            world.reset(pose, rng)
            picture = world.engine.picture(
                camera_view(config, instant.pan), config.light, target_middle(config, instant)
            )
            found.append((picture, distance, bearing - instant.pan, pose.yaw - bearing))
    finally:
        world.close()
    return config, found


def test_samples_pass_from_background_to_target_where_the_tangents_are(pictures):
    config, found = pictures
    f, radius = 120 / math.tan(math.radians(14.8)), config.target.radius
    for picture, distance, axis, _ in found:
        row = picture[119 - round(0.05 * f / distance)].astype(int)  # above the markers
        white = np.flatnonzero((np.ptp(row, axis=1) < 8) & (row[:, 0] > 100))
        half = math.asin(radius / distance)
        left, right = 160 - f * math.tan(axis + half), 160 - f * math.tan(axis - half)
        assert white[0] - 1 - ROUND < left < white[0] + ROUND
        assert white[-1] - ROUND < right < white[-1] + 1 + ROUND
        assert len(white) == white[-1] - white[0] + 1  # without a gap between two sides


def test_markers_stand_on_the_cylinder_without_a_gap(pictures):
    config, found = pictures
    f, target = 120 / math.tan(math.radians(14.8)), config.target
    feet = 0
    for picture, distance, axis, relative in found:
        row = picture[119].astype(int)
        for index, angle in enumerate(target.marker_angles_deg):
            color = np.array(target.marker_colors[index])
            lit, unlit = row[:, color > 0], row[:, color == 0]
            seen = np.flatnonzero(
                (unlit < 20).all(axis=1) & (lit > 60).all(axis=1) & (np.ptp(lit, axis=1) < 8)
            )
            around = math.pi + relative + math.radians(angle)
            if len(seen) == 0 or math.cos(around) < 0.5:
                continue
            assert len(seen) == seen[-1] - seen[0] + 1
            for side, before in ((-1, seen[0] - 1), (1, seen[-1])):
                columns = []
                half, face = 0.5 * target.marker_width, target.radius + target.marker_protrusion
                for out in (face, math.sqrt(target.radius**2 - half**2)):
                    aside = out * math.sin(around) + side * half * math.cos(around)
                    ahead = distance - out * math.cos(around) + side * half * math.sin(around)
                    columns.append(160 + f * math.tan(math.atan2(aside, ahead) - axis))
                edge = side * max(side * column for column in columns)
                feet += edge == columns[1]
                assert before - ROUND < edge < before + 1 + ROUND
    assert feet > 10
