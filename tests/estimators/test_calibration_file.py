"""Calibration files: what is written is read, and whatever is wrong is one clear error."""

from dataclasses import replace

import numpy as np
import pytest

from estimators import Calibration, ConfigError, Room
from estimators.calibration_file import CalibrationFile, read_calibration
from estimators.self_calibration.quantities import NAMES, Q, values_of, with_vector

FOUND = np.array([0.01, -0.02, 0.008, 0.03, 0.103, 0.035, 0.004, 0.11, 0.38, 0.015])
ERRORS = np.full(len(Q), 1e-3)


def file_of(calibration, observed=None):
    every = np.ones(len(Q), bool) if observed is None else observed
    return CalibrationFile.of(calibration, FOUND, ERRORS, every, "run.mcap")


@pytest.fixture
def path(calibration, tmp_path):
    file_of(calibration).write(tmp_path / "calibration.toml")
    return tmp_path / "calibration.toml"


def test_names_and_places_belong_together():
    assert [n.split(".")[1].replace("clock_offset", "clock") for n in NAMES] == [
        "x", "y", "yaw", "range_bias", "radius", "pan_offset", "x", "y", "fov", "clock",
    ]  # fmt: skip
    assert len(NAMES) == len(Q)


def test_values_go_into_a_calibration_and_come_back(calibration):
    assert np.allclose(values_of(with_vector(calibration, FOUND)), FOUND, atol=1e-15)


def test_what_is_written_is_read(calibration, path):
    read = read_calibration(path)
    assert dict(read.values) == dict(file_of(calibration).values)
    assert dict(read.standard_errors) == dict.fromkeys(NAMES, 1e-3)
    assert read.recording == "run.mcap"
    assert np.allclose(values_of(read.over(calibration)), FOUND, rtol=0, atol=1e-15)


def test_what_was_not_observable_stays_as_it_was_believed(calibration, tmp_path):
    observed = np.ones(len(Q), bool)
    observed[[Q.FOV, Q.CLOCK_OFFSET]] = False
    file_of(calibration, observed).write(tmp_path / "part.toml")
    read = read_calibration(tmp_path / "part.toml")
    assert read.not_observable == ("camera.fov", "camera.clock_offset")
    over = read.over(calibration)
    assert over.camera.fov == calibration.camera.fov
    assert over.camera.clock_offset == 0.0
    assert over.target.radius == 0.103


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("[lrf]\n", "[lrf]\nz = 0.1\n", "unknown quantity lrf.z: must be one of lrf.x"),
        ("version = 1", "version = 1\ncolour = 3", "unknown key colour = 3: must be one of format"),
        ("version = 1", "version = 2", "version = 2: this version of gt-env reads 1"),
        ("gt-env calibration", "something", "format = 'something': must be 'gt-env calibration'"),
        ("range_bias = 0.03", 'range_bias = "wide"', "lrf.range_bias = 'wide'"),
        ("range_bias = 0.03", "range_bias = nan", "lrf.range_bias = nan"),
        ("radius = 0.103", "radius = -0.103", "target.radius = -0.103: must be above 0"),
        ('"lrf.x" = 0.001', '"lrf.x" = 0.0', "standard_errors.lrf.x = 0.0: must be above 0"),
        ('"lrf.x" = 0.001\n', "", "standard_errors has no 'lrf.x'"),
        ("not_observable = []", 'not_observable = ["lrf.x"]', "lrf.x has a value and is in not_observable"),
        ("[station]\n", "[station]\nfloor = 2\n", "unknown key station.floor"),
        ("[correlations]\n", '[correlations]\n"lrf.x" = 0.5\n', "correlations.lrf.x: must be two quantities"),
        ("[lrf]", "[lrf", "not a TOML file"),
    ],
)
def test_whatever_is_wrong_is_named_with_its_file(path, old, new, said):
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new, 1))
    with pytest.raises(ConfigError) as error:
        read_calibration(path)
    assert said in str(error.value)
    assert str(error.value).startswith(str(path))
    assert "\n" not in str(error.value)


def test_a_file_that_is_not_there(tmp_path):
    with pytest.raises(ConfigError, match=r"nothing\.toml: cannot be read"):
        read_calibration(tmp_path / "nothing.toml")


@pytest.mark.parametrize("what", ["room", "image", "target_height", "marker_angles"])
def test_a_calibration_of_another_station_is_refused_and_says_what_differs(calibration, path, what):
    other = {
        "room": replace(calibration, room=Room(vertices=[(-3, -0.03), (3, -0.03), (3, 3), (-3, 3)])),
        "image": replace(calibration, camera=replace(calibration.camera, width=640, height=480)),
        "target_height": replace(calibration, target=replace(calibration.target, z_max=0.3)),
        "marker_angles": replace(calibration, target=replace(calibration.target, marker_angles=(0.0, 2.0))),
    }[what]
    with pytest.raises(ConfigError, match=f"a calibration of another station: station.{what} = ") as error:
        read_calibration(path).over(other)
    assert " there, " in str(error.value)


def test_the_same_room_with_rounded_corners_is_the_same_station(calibration, path):
    near = Calibration(room=Room(vertices=calibration.room.vertices + 1e-6))
    assert read_calibration(path).over(near).target.radius == 0.103
