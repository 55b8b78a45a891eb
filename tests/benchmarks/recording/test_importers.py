"""Text logs and folders: what they say is read, what is wrong with them is said."""

import cv2
import numpy as np
import pytest

from benchmarks.recording import ScanLaw, ScanLog, read_folder, read_scan_log
from estimators import ConfigError, ImageFrame, LaserScan, RecordingError

LAW = ScanLaw(bearing_min=0.1, bearing_increment=0.5, rate=10.0, range_max=6.0)


def log(tmp_path, content):
    path = tmp_path / "log.txt"
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return path


@pytest.mark.parametrize(
    "content",
    [
        "1; 2.5; 3\n4; 5; 6\n",
        "1;2.5;3;\r\n4;5;6;\r\n",
        " 1 ; 2.5 ; 3 ; \r\n4; 5; 6; ",
        "\ufeff1;2.5;3\n4;5;6",
    ],
)
def test_separators_and_line_ends(tmp_path, content):
    scans = read_scan_log(log(tmp_path, content), LAW)
    assert [s.ranges.tolist() for s in scans] == [[1.0, 2.5, 3.0], [4.0, 5.0, 6.0]]
    assert [s.stamp for s in scans] == [0.0, 0.1]
    assert np.allclose(scans[0].bearings, [0.1, 0.6, 1.1])
    assert scans[0].source == "station/lrf"


def test_ranges_beyond_the_largest_are_no_return(tmp_path):
    (scan,) = read_scan_log(log(tmp_path, "1;9\n"), LAW)
    assert scan.ranges.tolist() == [1.0, 6.0]


@pytest.mark.parametrize(
    ("content", "said"),
    [
        ("1;2\n1;x\n", "line 2: 'x' is not a range"),
        ("1;2\n1;;2\n", "line 2: '' is not a range"),
        ("1;2\n\n1;2\n", "line 2: '' is not a range"),
        ("1,5;2\n", "line 1: '1,5' is not a range"),
        ("1;2\n1;nan\n", "line 2: 'nan' is not a finite range"),
        ("1;2\n1;-3\n", "line 2: '-3' is not a finite range"),
        ("inf;2\n", "line 1: 'inf' is not a finite range"),
        ("1;2\n1;2\n1;2;3\n", "line 3: 3 ranges, line 1 has 2: '1;2;3'"),
        ("1;" + "y" * 400, "..."),
        ("", "is empty"),
        (b"\xff\xfe\x00", "not a text file"),
    ],
)
def test_malformed_log_names_file_line_and_text(tmp_path, content, said):
    with pytest.raises(RecordingError) as caught:
        read_scan_log(log(tmp_path, content), LAW)
    assert "log.txt" in str(caught.value)
    assert said in str(caught.value)
    assert len(str(caught.value)) < 300


def test_unreadable_log(tmp_path):
    with pytest.raises(RecordingError, match=r"none\.txt: cannot be read"):
        read_scan_log(tmp_path / "none.txt", LAW)


@pytest.mark.parametrize(
    "wrong",
    [
        {"bearing_increment": 0.0},
        {"bearing_increment": float("nan")},
        {"bearing_min": float("inf")},
        {"rate": 0.0},
        {"range_max": 0.0},
        {"range_min": -1.0},
    ],
)
def test_law_that_cannot_be(wrong):
    with pytest.raises(ConfigError, match=next(iter(wrong))):
        ScanLaw(**{"bearing_increment": 0.5, "range_max": 6.0} | wrong)


def test_scan_log_writes_what_is_read_back_bit_for_bit(tmp_path):
    rng = np.random.default_rng(0)
    scans = [
        LaserScan(
            stamp=i / 10,
            ranges=rng.uniform(0, 6, 360).astype(np.float32),
            bearing_min=0.1,
            bearing_increment=0.5,
            range_max=6.0,
        )
        for i in range(5)
    ]
    scan_log = ScanLog()
    scan_log.take(scans[0])
    scan_log.start()
    for scan in scans[1:4]:
        scan_log.take(scan)
    scan_log.stop()
    scan_log.take(scans[4])
    assert len(scan_log) == 3
    scan_log.save(tmp_path / "log.txt")
    back = read_scan_log(tmp_path / "log.txt", LAW)
    assert [s.ranges.tobytes() for s in back] == [s.ranges.tobytes() for s in scans[1:4]]
    assert [p.name for p in tmp_path.iterdir()] == ["log.txt"]


def test_scan_log_that_cannot_be_saved(tmp_path):
    scan_log = ScanLog()
    with pytest.raises(RecordingError, match="no scan"):
        scan_log.save(tmp_path / "log.txt")
    scan_log.start()
    scan_log.take(LaserScan(stamp=0.0, ranges=[1.0], bearing_min=0.0, bearing_increment=0.5, range_max=6.0))
    with pytest.raises(RecordingError, match="cannot be written"):
        scan_log.save(tmp_path / "none" / "log.txt")


@pytest.fixture
def folder(tmp_path):
    """Two scans, two frames, truth and a configuration."""
    folder = tmp_path / "data"
    (folder / "images").mkdir(parents=True)
    (folder / "scans.txt").write_text("1;2\n3;4\n")
    (folder / "scans.csv").write_text("stamp\n5.0\n5.1\n")
    bgr = np.zeros((8, 8, 3), np.uint8)
    bgr[..., 2] = 255
    cv2.imwrite(str(folder / "images" / "a.png"), bgr)
    cv2.imwrite(str(folder / "images" / "b.png"), 255 - bgr)
    (folder / "frames.csv").write_text(
        "pan, file, stamp, remark\n1.5,images/a.png,5.0,\n1.6,images/b.png,5.05,late\n"
    )
    (folder / "truth.csv").write_text("stamp,x,y,yaw\n5.0,0,2,0\n5.1,0,2,0.1\n")
    (folder / "config.toml").write_text("[target]\nradius = 0.07\n")
    return folder


def test_folder_is_a_recording(folder):
    recording = read_folder(folder, LAW)
    kinds = [(type(m), m.stamp) for m in recording.messages]
    assert kinds == [(LaserScan, 5.0), (ImageFrame, 5.0), (ImageFrame, 5.05), (LaserScan, 5.1)]
    assert recording.messages[1].rgb[0, 0].tolist() == [255, 0, 0]
    assert recording.messages[2].pan == 1.6
    assert recording.truth.tolist() == [[5.0, 0, 2, 0], [5.1, 0, 2, 0.1]]
    assert recording.config.target.radius == 0.07


def test_all_but_the_scans_is_optional(folder):
    for name in ("scans.csv", "frames.csv", "truth.csv", "config.toml"):
        (folder / name).unlink()
    recording = read_folder(folder, LAW)
    assert [m.stamp for m in recording.messages] == [0.0, 0.1]
    assert recording.config is None
    assert recording.truth.shape == (0, 4)


@pytest.mark.parametrize(
    ("name", "content", "said"),
    [
        ("scans.csv", "stamp\n5.0\n", "scans.txt: 2 scans, but 1 stamps"),
        ("scans.csv", "stamp\n5.0\n5.0\n", "scans.csv, line 3: stamp 5.0 does not increase"),
        ("scans.csv", "time\n5.0\n5.1\n", "scans.csv, line 1: lacks the column stamp: 'time'"),
        ("scans.csv", "stamp\n5.0\nnan\n", "scans.csv, line 3: stamp = 'nan'"),
        ("scans.csv", "stamp\n", "scans.csv: has a header, but no row"),
        ("scans.csv", "", "scans.csv: is empty"),
        ("frames.csv", "file,stamp,pan\nimages/a.png,5,x\n", "frames.csv, line 2: pan = 'x'"),
        ("frames.csv", "file,stamp,pan\nimages/a.png,5\n", "frames.csv, line 2: 2 values for 3 columns"),
        ("frames.csv", "file,stamp,pan\nimages/c.png,5,1\n", "c.png: cannot be read"),
        ("truth.csv", "stamp,x,y,yaw\n1,0,0,0\n0,0,0,0\n", "truth.csv, line 3: stamp 0 does not increase"),
    ],
)
def test_malformed_folder_names_file_and_line(folder, name, content, said):
    (folder / name).write_text(content)
    with pytest.raises(RecordingError) as caught:
        read_folder(folder, LAW)
    assert said in str(caught.value)


def test_frame_that_is_no_image_is_named(folder):
    (folder / "images" / "b.png").write_bytes(b"not a picture")
    with pytest.raises(RecordingError, match=r"b\.png: frame at 5\.05 s: not an image"):
        list(read_folder(folder, LAW).messages)


def test_empty_folder_and_stamps_without_scans(folder, tmp_path):
    with pytest.raises(RecordingError, match=r"holds neither scans\.txt nor frames\.csv"):
        read_folder(tmp_path, LAW)
    (folder / "scans.txt").unlink()
    with pytest.raises(RecordingError, match=r"there is no scans\.txt"):
        read_folder(folder, LAW)


def test_wrong_configuration_in_a_folder(folder):
    (folder / "config.toml").write_text("[target]\nradios = 1\n")
    with pytest.raises(ConfigError, match="radios"):
        read_folder(folder, LAW)
