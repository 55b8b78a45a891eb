"""Replay gives known answers from made-up scans, whatever format they come in."""

import math

import numpy as np
import pytest
from replayed_drive import CALIBRATION, CONFIG, driving, frame_at, scan_at

from benchmarks.metrics import errors
from benchmarks.recording import MessageLog, Recording, RecordingWriter, TruePose, read_recording
from benchmarks.replay import answers, interpolated, replay, track
from estimators import Pose2, PoseEstimate, RecordingError, TargetSighting, ThesisEstimator, WheelOdometry
from estimators.thesis.sighting import sight_target


def run(messages, truth=None):
    extra = {} if truth is None else {"truth": truth}
    return replay(Recording(origin="made up", messages=MessageLog(messages), **extra), "thesis", CALIBRATION)


@pytest.mark.parametrize(("x", "y"), [(0.0, 2.0), (-2.0, 3.0), (1.5, 1.0)])
def test_known_position(x, y):
    result = run([scan_at(x, y, i / 10) for i in range(5)])
    assert len(result.estimates) == 5
    last = result.estimates[-1]
    assert last.valid
    assert not last.yaw_valid
    beam = math.radians(0.5) * math.hypot(x, y)  # across the line of sight the rule is good to a beam
    assert math.hypot(last.pose.x - x, last.pose.y - y) < 0.003 + 0.75 * beam
    assert np.isnan(result.errors).all()


def test_one_answer_for_each_stamp_the_last():
    result = run([scan_at(0.0, 2.0, 0.0), frame_at(0.0), scan_at(0.0, 2.0, 0.1)])
    assert [e.stamp for e in result.estimates] == [0.0, 0.1]
    assert result.estimates[0].yaw_valid


def test_the_robots_own_sensors_are_not_shown_to_the_station():
    seen = []

    class Spy(ThesisEstimator):
        def update(self, message):
            seen.append(message.source)
            return super().update(message)

    messages, truth = driving(5)
    recording = Recording(origin="x", messages=MessageLog(messages), truth=truth)
    passed = []

    def watch(station):
        for message in station:
            passed.append(message.source)
            yield message

    replay(recording, "thesis", CALIBRATION, watch)
    assert set(passed) == {"station/lrf", "station/camera"}
    assert len(answers(recording.messages, Spy(CALIBRATION))) == 5
    assert "robot/encoders" in seen  # a localizer under test may be given everything


def test_recorded_and_direct_messages_give_the_same(tmp_path):
    messages, truth = driving()
    with RecordingWriter(tmp_path / "run.mcap", CONFIG) as writer:
        for stamp, *pose in truth.tolist():
            writer.write(TruePose(stamp=stamp, pose=Pose2.of(pose)))
        for message in messages:
            writer.write(message)
    direct = run(messages, truth)
    recorded = replay(read_recording(tmp_path / "run.mcap"), "thesis", CALIBRATION)
    assert [(e.stamp, e.pose) for e in recorded.estimates] == [(e.stamp, e.pose) for e in direct.estimates]
    assert np.array_equal(recorded.errors, direct.errors)


def test_sightings_replay_as_their_frames_do(tmp_path):
    frames = [frame_at(i / 10, shift=3 * i - 9) for i in range(6)]
    scans = [scan_at(0.2, 2.0, i / 10) for i in range(6)]
    sightings = [sight_target(f, CALIBRATION.target) for f in frames]
    with RecordingWriter(tmp_path / "sightings.mcap", CONFIG) as writer:
        for scan, sighting in zip(scans, sightings, strict=True):
            writer.write(scan)
            writer.write(sighting)
    from_frames = run([m for pair in zip(scans, frames, strict=True) for m in pair])
    recording = read_recording(tmp_path / "sightings.mcap")
    assert len(recording.messages.of_type(TargetSighting)) == 6
    from_sightings = replay(recording, "thesis", CALIBRATION)
    assert [tuple(e.pose) for e in from_sightings.estimates] == [tuple(e.pose) for e in from_frames.estimates]
    assert len({e.pose.yaw for e in from_frames.estimates}) > 1
    assert all(e.yaw_valid for e in from_sightings.estimates)


def test_nothing_of_the_station_is_an_error():
    with pytest.raises(RecordingError, match="no message of the station"):
        run([WheelOdometry(stamp=0.0, speeds=[0.0])])


def test_truth_is_interpolated_across_the_turn_and_not_across_gaps():
    truth = np.array(
        [[0.0, 0.0, 1.0, 3.1], [0.1, 1.0, 1.0, -3.1], [5.0, 2.0, 1.0, 0.0], [5.1, 3.0, 1.0, 0.0]]
    )
    poses = interpolated(truth, np.array([-1.0, 0.0, 0.05, 0.1, 2.0, 5.05, 5.1, 6.0]))
    assert np.isnan(poses[[0, 4, 7]]).all()
    assert np.allclose(poses[[1, 2, 3, 5, 6], 0], [0.0, 0.5, 1.0, 2.5, 3.0])
    assert poses[2, 2] == pytest.approx(math.pi)
    assert np.isnan(interpolated(np.empty((0, 4)), np.array([1.0]))).all()
    assert interpolated(truth, np.empty(0)).shape == (0, 3)
    assert interpolated(truth[:1], np.array([0.0, 1.0]))[0].tolist() == [0.0, 1.0, 3.1]


def test_errors_wrap_and_leave_out_what_is_not_valid():
    class Script:
        def __init__(self, estimates):
            self.left = list(estimates)

        def reset(self):
            pass

        def update(self, message):
            return self.left.pop(0)

    flags = [{}, {"valid": False}, {"yaw_valid": False}]
    script = [
        PoseEstimate(stamp=0.1 * i, pose=Pose2(x=1.0, yaw=-3.1), covariance=np.eye(3), **f)
        for i, f in enumerate(flags)
    ]
    kept = answers([scan_at(0, 2, 0.1 * i) for i in range(3)], Script(script))
    truth = np.array([[0.1 * i, 0.5, 0.0, 3.1] for i in range(3)])
    found = errors(track(kept, truth, True))
    assert found[0].tolist() == pytest.approx([0.5, 0.0, 2 * math.pi - 6.2])
    assert np.isnan(found[1]).all()
    assert found[2, 0] == 0.5
    assert np.isnan(found[2, 2])


def test_looking_back_knows_more_than_the_same_method_online():
    messages, truth = driving()
    recording = Recording(origin="made up", messages=MessageLog(messages), truth=truth)
    online, back = (replay(recording, method, CALIBRATION) for method in ("lrf", "smooth-lrf"))

    assert np.isin([e.stamp for e in back.estimates], [e.stamp for e in online.estimates]).all()
    rms = [np.sqrt(np.nanmean(found.errors[:, :2] ** 2)) for found in (online, back)]
    assert rms[1] < rms[0]
