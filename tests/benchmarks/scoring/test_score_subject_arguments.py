"""What a localizer of somebody's own is given when it is made."""

import re

import numpy as np
import pytest

from benchmarks.scoring.request import Request
from benchmarks.scoring.subjects import make_localizer, parse_subject
from estimators.errors import ConfigError
from estimators.localizers import RobotCalibration
from estimators.poses import Pose2
from estimators.room import Room

START = Pose2(x=1.0, y=2.0, yaw=0.5)
SQUARE = Room(vertices=np.array([(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)]))
MODULE = """
class Nothing:
    given = None
    def reset(self): pass
    def update(self, message): return None

class Start(Nothing):
    def __init__(self, start): self.given = start

class All(Nothing):
    def __init__(self, *, seed, room, start, robot, gain=2.0): self.given = (start, robot, room, seed, gain)

class Other(Nothing):
    def __init__(self, start, gain): pass

class Broken(Nothing):
    def __init__(self, start): raise SystemExit("no licence")

def made(start): return Start(start)
def function(message): return None
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("own")
    (folder / "own_localizers.py").write_text(MODULE)
    return folder


def make(name, folder):
    subject = parse_subject(f"own_localizers:{name}", folder)
    return make_localizer(subject, RobotCalibration(), SQUARE, START, 7).localizer


@pytest.mark.parametrize(
    ("name", "given"),
    [
        ("Nothing", None),
        ("Start", START),
        ("made", START),
        ("All", (START, RobotCalibration(), SQUARE, 7, 2.0)),
    ],
)
def test_it_is_given_what_it_asks_for_by_name(name, given, folder):
    assert make(name, folder).given == given


def test_a_function_from_message_to_pose_is_not_taken_for_one_that_makes_a_localizer(folder):
    localizer = make("function", folder)
    assert localizer.update(None) is None
    assert not hasattr(localizer, "given")


def test_a_class_that_wants_something_else_is_refused_by_its_name_and_what_there_is(folder):
    with pytest.raises(ConfigError, match=re.escape("Other: wants gain")) as error:
        parse_subject("own_localizers:Other", folder)
    assert "start, robot, room, seed" in str(error.value)


def test_a_constructor_that_fails_is_named_and_ends_nothing_else(folder):
    with pytest.raises(ConfigError, match="own_localizers:Broken: cannot be made: SystemExit: no licence"):
        make("Broken", folder)


def test_nothing_can_be_recorded_that_is_not_driven(tmp_path):
    with pytest.raises(ConfigError, match="--record: there is nothing to record"):
        Request.parsed(subjects=("odometry",), recordings=(tmp_path / "a.mcap",), record=True)


def test_the_command_in_a_report_says_all_that_was_asked_for():
    asked = Request.parsed(
        subjects=("odometry",), paths=("eight",), seeds=2, duration=5.0, seed=3, reference="smooth", align="se2",
        max_gap=0.1, calibration=(2.0, 0.1), record=True, overrides=("robot.slip=0.1",), config="narrow",
    )  # fmt: skip
    assert set(asked.words) == {
        "odometry", "--path=eight", "--config=narrow", "--set=robot.slip=0.1", "--seeds=2", "--duration=5",
        "--max-gap=0.1", "--calibration-mm=2", "--calibration-deg=0.1", "--record", "--seed=3",
        "--reference=smooth", "--align=se2",
    }  # fmt: skip
