"""Recordings of a station: one file each, the same for simulated and real sensors; import and export.

`docs/recordings.md` describes the formats.
"""

from benchmarks.recording.encoding import SCHEMA_VERSION, TRUTH, TruePose
from benchmarks.recording.export import track_of, write_csv, write_tum
from benchmarks.recording.folder import read_folder
from benchmarks.recording.reader import read_recording
from benchmarks.recording.recorder import Recorder
from benchmarks.recording.recording import MessageLog, Recording
from benchmarks.recording.scan_log import ScanLaw, ScanLog, read_scan_log
from benchmarks.recording.writer import RecordingWriter, save_recording

__all__ = [
    "SCHEMA_VERSION",
    "TRUTH",
    "MessageLog",
    "Recorder",
    "Recording",
    "RecordingWriter",
    "ScanLaw",
    "ScanLog",
    "TruePose",
    "read_folder",
    "read_recording",
    "read_scan_log",
    "save_recording",
    "track_of",
    "write_csv",
    "write_tum",
]
