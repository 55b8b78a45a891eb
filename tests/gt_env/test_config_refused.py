"""What is wrong with a configuration is said in one error, before anything is simulated."""

import math

import pytest

from estimators import ConfigError
from gt_env import load_config


def bad(values, *words):
    return pytest.param(values, words, id=str(values)[:60])


NAN, INF = math.nan, math.inf


@pytest.mark.parametrize(
    ("values", "words"),
    [
        # unknown keys
        bad({"lrg": {}}, "lrg", "lrf"),
        bad({"lrf": {"rte": 10.0}}, "lrf.rte", "10.0", "rate"),
        bad({"lrf.rate": 10.0}, "lrf.rate"),
        bad({"light": {"lamps": [{"colour": 1}]}}, "light.lamps.0.colour"),
        # wrong types
        bad({"lrf": {"rate": "fast"}}, "lrf.rate", "'fast'", "number"),
        bad({"lrf": {"rate": True}}, "lrf.rate", "True"),
        bad({"lrf": {"beams": 3.5}}, "lrf.beams", "3.5", "integer"),
        bad({"lrf": {"enabled": 1}}, "lrf.enabled", "1", "boolean"),
        bad({"lrf": 5}, "lrf", "5"),
        bad({"camera": {"renderer": "best"}}, "camera.renderer", "'best'", "'tiny'"),
        bad({"robot": {"start": [1.0]}}, "robot.start"),
        bad({"target": {"color": [256, 0, 0]}}, "target.color.0", "256", "255"),
        bad({"belief": 5}, "belief", "5"),
        # negative sizes, sigmas, rates; not finite
        bad({"lrf": {"noise_sigma": -0.01}}, "lrf.noise_sigma", "-0.01", "greater than or equal to 0"),
        bad({"lrf": {"noise_sigma": NAN}}, "lrf.noise_sigma", "nan", "finite"),
        bad({"lrf": {"range_bias": INF}}, "lrf.range_bias", "inf", "finite"),
        bad({"lrf": {"rate": 0.0}}, "lrf.rate", "0.0", "greater than 0"),
        bad({"lrf": {"rate": 1e-320}}, "lrf.rate"),
        bad({"lrf": {"beams": 0}}, "lrf.beams", "0"),
        bad({"camera": {"rate": -30.0}}, "camera.rate", "-30.0"),
        bad({"camera": {"width": -320}}, "camera.width", "-320"),
        bad({"camera": {"height": 0}}, "camera.height", "0"),
        bad({"camera": {"noise_levels": -2.0}}, "camera.noise_levels", "-2.0"),
        bad({"camera": {"fov_deg": 180.0}}, "camera.fov_deg", "180.0", "180"),
        bad({"camera": {"fov_deg": 0.0}}, "camera.fov_deg", "0.0"),
        bad({"camera": {"fov_deg": NAN}}, "camera.fov_deg", "nan"),
        bad({"target": {"radius": -0.1}}, "target.radius", "-0.1"),
        bad({"robot": {"track": 0.01}}, "robot.track", "0.01", "wheel_width"),
        bad({"robot": {"ground_clearance": 0.1}}, "ground_clearance", "0.1", "target.z_min"),
        bad({"room": {"wall_height": -1.0}}, "room.wall_height", "-1.0"),
        bad({"timing": {"tick": 0.0}}, "timing.tick", "0.0"),
        # what does not fit together
        bad({"camera": {"near": 5.0, "far": 1.0}}, "camera.near", "5.0", "camera.far = 1.0"),
        bad({"lrf": {"range_min": 7.0}}, "lrf.range_min", "7.0", "lrf.range_max = 6.4"),
        bad({"pan": {"min_deg": 200.0}}, "pan.min_deg", "200.0", "pan.max_deg"),
        bad({"target": {"z_min": 0.3}}, "target.z_min", "0.3", "target.z_max"),
        bad({"lrf": {"height": 0.3}}, "lrf.height", "0.3", "target.z_max"),
        bad({"target": {"marker_angles_deg": [0.0]}}, "target.marker_colors", "target.marker_angles_deg"),
        bad({"light": {"lamps": []}}, "light.lamps", "at least one"),
        # periods that are no multiple of the tick
        bad({"lrf": {"rate": 7.0}}, "lrf.rate", "7 Hz", "timing.tick"),
        bad({"camera": {"rate": 50.0}}, "camera.rate", "50 Hz", "timing.tick"),
        bad({"timing": {"step": 0.11}}, "timing.step", "0.11", "timing.tick"),
        bad({"timing": {"tick": 0.3}}, "timing.step", "0.1", "timing.tick"),
        bad({"pan": {"control_rate": 1000.0}}, "pan.control_rate", "1000", "timing.tick"),
        bad({"robot": {"encoder_rate": 23.0}}, "robot.encoder_rate", "23", "timing.tick"),
        # room
        bad({"room": {"station": [9.0, 9.0]}}, "room.station", "9.0", "inside"),
        bad({"lrf": {"position": [0.0, 100.0]}}, "lrf.position", "100.0", "inside"),
        bad({"camera": {"position": [9.0, 9.0, 0.2]}}, "camera.position", "9.0", "inside"),
        bad({"robot": {"start": [100.0, 1.0]}}, "robot.start", "100.0", "inside the room"),
        bad({"robot": {"start": [3.95, 1.0]}}, "robot.start", "3.95", "target.radius"),
        bad({"target": {"mount": [5.0, 0.0]}}, "target"),
        bad({"target": {"radius": 3.0}}, "target.radius", "3.0", "fit into the room"),
        bad({"room": {"vertices": [[-1.0, -1.0], [1.0, -1.0]]}}, "room.vertices", "three"),
        bad({"room": {"vertices": [[-4, -1], [4, 4], [4, -1], [-4, 4.5]]}}, "room.vertices", "cross"),
        # belief
        bad({"belief": {"physics": {}}}, "belief.physics", "lrf"),
        bad({"belief": {"lrf": {"noise_sigma": -1.0}}}, "belief", "lrf.noise_sigma", "-1.0"),
        bad({"belief": {"lrf": {"foo": 1}}}, "belief", "lrf.foo"),
        # presets
        bad({"preset": "thesys"}, "preset", "'thesys'", "simtwo"),
        bad({"preset": 5}, "preset", "5"),
        bad({"preset": ["thesis", 5]}, "preset", "5"),
    ],
)
def test_bad_input_is_one_error_naming_key_value_and_what_is_allowed(values, words):
    with pytest.raises(ConfigError) as caught:
        load_config(values)

    message = str(caught.value)
    assert "\n" not in message
    assert not [w for w in words if w not in message], message


@pytest.mark.parametrize("config", ["no such preset", "", 5, ["thesis"]])
def test_what_is_no_configuration_is_refused(config):
    with pytest.raises(ConfigError, match="config"):
        load_config(config)


def test_all_that_is_wrong_is_said_at_once():
    with pytest.raises(ConfigError) as caught:
        load_config({"lrf": {"rate": -1.0, "beams": 0}, "camera": {"width": 1}})

    assert all(key in str(caught.value) for key in ("lrf.rate", "lrf.beams", "camera.width"))
