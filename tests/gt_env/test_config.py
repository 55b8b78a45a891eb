"""Configurations: presets, files, mappings and overrides, and what they mean."""

import dataclasses
import json
import math

import numpy as np
import pytest

from estimators import ConfigError, Pose2
from gt_env import EnvConfig, load_config
from gt_env.config import parse_override, presets


@pytest.mark.parametrize("name", presets())
def test_every_preset_loads_and_survives_as_dict_and_json(name):
    config = load_config(name)

    assert load_config(config.as_dict()) == config
    assert load_config(json.loads(json.dumps(config.as_dict()))) == config
    assert load_config(config) is config


def test_the_presets_are_those_that_were_promised():
    assert {"thesis", "simtwo", "narrow", "wide", "sick_lms101", "hokuyo_utm30lx"} <= set(presets())
    assert load_config() == load_config("thesis") == EnvConfig()
    assert load_config("simtwo").lrf.bearing_increment_deg == pytest.approx(180 / 359)
    assert load_config("simtwo").believed().lrf.bearing_increment_deg == 0.5
    assert (load_config("wide").camera.fov_deg, load_config("narrow").camera.fov_deg) == (60, 22)
    sick, hokuyo = load_config("sick_lms101").lrf, load_config("hokuyo_utm30lx").lrf
    assert (sick.rate, sick.range_max, sick.beams) == (50, 20, 1081)  # 270 deg in steps of 0.25
    assert (hokuyo.rate, hokuyo.range_max, hokuyo.beams) == (40, 30, 1081)


def test_the_thesis_values_are_the_defaults():
    c = EnvConfig()

    assert c.room.vertices[2:] == ((4, 4), (-4, 4))
    assert (c.lrf.rate, c.lrf.beams, c.lrf.bearing_increment_deg, c.lrf.noise_sigma) == (10, 360, 0.5, 0.03)
    assert (c.camera.rate, c.camera.width, c.camera.height, c.camera.position[:2]) == (30, 320, 240, (0, 0.1))
    assert (c.pan.min_deg, c.pan.max_deg, c.pan.dead_zone_deg, c.pan.max_speed) == (0, 180, 1, 0.8)
    assert (c.robot.track, c.robot.max_wheel_speed, c.robot.stall_torque) == (0.215, 29.4, 1.08)
    assert tuple(c.start_pose) == (0, 2, 0)


def test_a_mapping_is_laid_over_its_preset():
    config = load_config(
        {"preset": "simtwo", "lrf": {"noise_sigma": 0.01}, "belief": {"lrf": {"rate": 20.0}}}
    )

    assert config.lrf.noise_sigma == 0.01
    assert config.lrf.bearing_increment_deg == pytest.approx(180 / 359)
    assert config.belief["lrf"] == {"bearing_increment_deg": 0.5, "rate": 20.0}
    assert load_config({"lrf": {"noise_sigma": 0.01}}).lrf.beams == 360


def test_a_list_of_presets_is_laid_one_over_the_other():
    config = load_config({"preset": ["narrow", "sick_lms101"]})

    assert (config.camera.fov_deg, config.lrf.rate) == (22, 50)
    assert load_config({"preset": ["wide", "narrow"]}).camera.fov_deg == 22
    assert load_config({"preset": ["narrow", "wide"]}).camera.fov_deg == 60


def test_a_toml_file_is_partial_too_and_named_in_its_errors(tmp_path):
    file = tmp_path / "mine.toml"
    file.write_text('preset = "wide"\n[lrf]\nrate = 20\n')
    for path in (file, str(file)):
        assert (load_config(path).lrf.rate, load_config(path).camera.fov_deg) == (20, 60)

    file.write_text("[lrf]\nrate = -1\n")
    with pytest.raises(ConfigError, match=r"mine\.toml.*lrf\.rate = -1"):
        load_config(file)
    file.write_text("[lrf\n")
    with pytest.raises(ConfigError, match=r"mine\.toml.*not a TOML file"):
        load_config(file)
    with pytest.raises(ConfigError, match=r"none\.toml"):
        load_config(tmp_path / "none.toml")


def test_overrides_come_last():
    config = load_config("simtwo", {"lrf.rate": 20.0, "belief.lrf.noise_sigma": 0.05})

    assert config.lrf.rate == 20
    assert config.believed().lrf.noise_sigma == 0.05
    assert config.believed().lrf.bearing_increment_deg == 0.5
    assert load_config(EnvConfig(), {"lrf.rate": 20.0}).lrf.rate == 20
    with pytest.raises(ConfigError, match=r"lrf\.rate = 'x'"):
        load_config(None, {"lrf.rate": "x"})


@pytest.mark.parametrize(
    ("text", "key", "value"),
    [
        ("lrf.rate=20", "lrf.rate", 20),
        ("room.station=[1.0, 2.0]", "room.station", [1.0, 2.0]),
        ("lrf.enabled = false", "lrf.enabled", False),
        ("camera.renderer=tiny", "camera.renderer", "tiny"),
    ],
)
def test_overrides_are_read_as_toml(text, key, value):
    assert parse_override(text) == (key, value)


@pytest.mark.parametrize("text", ["lrf.rate", "=5", ""])
def test_an_override_needs_key_and_value(text):
    with pytest.raises(ConfigError, match="KEY=VALUE"):
        parse_override(text)


def test_a_configuration_cannot_be_changed():
    config = EnvConfig()

    with pytest.raises(dataclasses.FrozenInstanceError):
        config.lrf = None
    with pytest.raises(dataclasses.FrozenInstanceError):
        config.lrf.rate = 5.0
    config.as_dict()["lrf"]["rate"] = 5.0
    assert config.lrf.rate == 10


def test_belief_is_what_differs_and_equal_by_default():
    assert EnvConfig().believed() == EnvConfig()
    config = load_config({"belief": {"target": {"radius": 0.12}, "pan": {"offset_deg": 2.0}}})

    assert (config.calibration().target.radius, config.believed().calibration().target.radius) == (0.10, 0.12)
    assert config.believed().calibration().camera.pan_offset == pytest.approx(math.radians(2))
    assert config.believed().lrf == config.lrf


def test_the_room_is_turned_and_moved_into_the_station_frame():
    config = load_config(
        {
            "room": {
                "vertices": [[0.0, 0.0], [8.0, 0.0], [8.0, 4.0], [0.0, 4.0]],
                "station": [7.9, 2.0],
                "station_yaw_deg": 90.0,
            }
        }
    )
    room = config.calibration().room

    # the station stands by the right wall and looks along -x of the room, which is its y
    assert room.cast((0, 0), np.radians([0, 90, 180, 270]))[0] == pytest.approx([2, 7.9, 2, 0.1])


def test_the_mount_moves_the_target_not_the_base():
    config = load_config({"target": {"mount": [0.3, 0.0], "mount_yaw_deg": 90.0}})

    assert config.calibration().target.mount == Pose2(x=0.3, y=0.0, yaw=math.pi / 2)
    with pytest.raises(ConfigError, match=r"robot\.start"):
        load_config({"target": {"mount": [0.3, 0.0]}, "robot": {"start": [3.65, 2.0]}})
