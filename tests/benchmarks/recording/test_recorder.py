"""What is recorded while driving, and what the robot's own sensors add to it."""

import json
import os

import numpy as np

from benchmarks.recording import (
    Recorder,
    RecordingWriter,
    read_recording,
)
from benchmarks.recording.encoding import encode
from estimators import (
    ImuSample,
    LaserScan,
    WheelOdometry,
)


def test_recorder_keeps_what_came_between_start_and_stop(tmp_path):
    recorder = Recorder(tmp_path / "runs")
    wheels = [WheelOdometry(stamp=float(t), speeds=[float(t)]) for t in range(6)]
    truth = np.arange(24.0).reshape(6, 4)
    assert recorder.save() is None
    recorder.take(wheels[:1], truth[:1])
    recorder.start()
    recorder.take(wheels[1:3], truth[1:3])
    recorder.stop()
    recorder.take(wheels[3:5], truth[3:5])
    recorder.start()
    recorder.take(wheels[5:], truth[5:])
    assert recorder.unsaved
    path = recorder.save()
    assert path.name == "recording-001.mcap"
    recording = read_recording(path)
    assert [m.stamp for m in recording.messages] == [1.0, 2.0, 5.0]
    assert recording.truth[:, 0].tolist() == [4.0, 8.0, 20.0]
    recorder.start()
    recorder.take(wheels[:1])  # a new file: time may start again
    assert recorder.save().name == "recording-002.mcap"
    recorder.start()
    recorder.discard()
    assert sorted(os.listdir(tmp_path / "runs")) == ["recording-001.mcap", "recording-002.mcap"]


def test_the_robots_own_sensors_come_back_bit_for_bit(tmp_path):
    scan = LaserScan(
        stamp=0.1,
        source="robot/lidar",
        ranges=np.linspace(0.3, 5, 72, dtype=np.float32),
        bearing_min=-np.pi,
        bearing_increment=np.pi / 36,
        range_min=0.1,
        range_max=12.0,
    )
    sample = ImuSample(stamp=0.1, yaw_rate=0.1 / 3, acceleration=[1 / 7, -1 / 9])
    with RecordingWriter(tmp_path / "r.mcap") as writer:
        writer.write(sample)
        writer.write(scan)
    imu, lidar = read_recording(tmp_path / "r.mcap").messages

    assert (imu.source, imu.stamp, imu.yaw_rate) == ("robot/imu", 0.1, 0.1 / 3)
    assert imu.acceleration.tolist() == [1 / 7, -1 / 9]
    assert lidar.source == "robot/lidar"
    assert np.array_equal(lidar.ranges, scan.ranges)
    assert (lidar.bearing_min, lidar.range_min, lidar.range_max) == (-np.pi, 0.1, 12.0)


def test_a_scan_of_the_robots_lidar_is_in_a_frame_of_its_own():
    of = {
        source: json.loads(
            encode(
                LaserScan(
                    stamp=0.0,
                    source=source,
                    ranges=[1.0],
                    bearing_min=0.0,
                    bearing_increment=0.1,
                    range_max=2.0,
                )
            )[1]
        )
        for source in ("station/lrf", "robot/lidar")
    }

    assert of["station/lrf"]["frame_id"] == "station"
    assert of["robot/lidar"]["frame_id"] == "robot/lidar"
