"""A folder of scans, frames and stamps from a real station, as a recording."""

from __future__ import annotations

import csv
import math
from collections.abc import Iterator
from pathlib import Path
from typing import Final

import numpy as np

from benchmarks.recording.frames import StoredFrame
from benchmarks.recording.recording import MessageLog, Recording
from benchmarks.recording.scan_log import ScanLaw, read_lines, read_scan_log
from estimators.errors import RecordingError
from estimators.messages import STATION_CAMERA, LaserScan, Message
from gt_env.config import EnvConfig, load_config

SCANS: Final = "scans.txt"
SCAN_STAMPS: Final = "scans.csv"
FRAMES: Final = "frames.csv"
TRUTH_FILE: Final = "truth.csv"
CONFIG: Final = "config.toml"


def read_folder(folder: Path | str, law: ScanLaw) -> Recording:
    """Read a folder of plain files.

    - `scans.txt`: a text log of scans.
    - `scans.csv`, column `stamp` [s]: one row a scan; without it the scans come at `law.rate` from 0.
    - `frames.csv`, columns `file`, `stamp` [s], `pan` [rad]: one row a frame, the file within the folder.
    - `truth.csv`, columns `stamp` [s], `x`, `y` [m], `yaw` [rad]: if something else measured it.
    - `config.toml`: a configuration, of which estimators believe what it says of room, sensors and target.

    All are optional, but there must be scans or frames. Stamps are of one clock and increase in each file.

    Args:
        folder: The folder.
        law: Bearings, rate and largest range of the scans.

    Raises:
        RecordingError: If something is missing, malformed or does not fit together; names file and line.
        ConfigError: If the configuration is not valid.
    """
    folder = Path(folder)
    scans = _scans(folder, law)
    frames = _frames(folder / FRAMES) if (folder / FRAMES).exists() else []
    if not scans and not frames:
        raise RecordingError(f"{folder}: holds neither {SCANS} nor {FRAMES}")
    # At equal stamps the scan comes first, as in the simulated station: the camera follows the LRF.
    both: list[Message | StoredFrame] = [*scans, *frames]
    messages = sorted(both, key=lambda m: (m.stamp, isinstance(m, StoredFrame)))
    return Recording(
        origin=str(folder),
        messages=MessageLog(messages),
        truth=_truth(folder / TRUTH_FILE),
        config=folder_config(folder),
        tool="imported by gt-env",
    )


def folder_config(folder: Path | str) -> EnvConfig | None:
    """The configuration in a folder, if it has one.

    Raises:
        ConfigError: If it is not valid.
    """
    path = Path(folder) / CONFIG
    return load_config(path) if path.exists() else None


def _scans(folder: Path, law: ScanLaw) -> tuple[LaserScan, ...]:
    if not (folder / SCANS).exists():
        if (folder / SCAN_STAMPS).exists():
            raise RecordingError(f"{folder / SCAN_STAMPS}: stamps of scans, but there is no {SCANS}")
        return ()
    stamps = None
    if (folder / SCAN_STAMPS).exists():
        stamps = [row[0] for _, _, row in _rows(folder / SCAN_STAMPS, ("stamp",))]
    return read_scan_log(folder / SCANS, law, stamps)


def _frames(path: Path) -> list[StoredFrame]:
    frames = []
    for place, (name,), (stamp, pan) in _rows(path, ("stamp", "pan"), texts=("file",)):
        image = path.parent / name
        try:
            png = image.read_bytes()
        except OSError as error:
            raise RecordingError(f"{place}: {image}: cannot be read: {error.strerror or error}") from None
        frames.append(StoredFrame(stamp=stamp, source=STATION_CAMERA, pan=pan, png=png, origin=str(image)))
    return frames


def _truth(path: Path) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    if not path.exists():
        return np.empty((0, 4))
    return np.array([row for _, _, row in _rows(path, ("stamp", "x", "y", "yaw"))])


def _rows(
    path: Path, numbers: tuple[str, ...], texts: tuple[str, ...] = ()
) -> Iterator[tuple[str, list[str], list[float]]]:
    """Rows of a CSV file: place for error messages, texts, numbers (`stamp` the first, increasing).

    Columns may stand in any order, and there may be others.
    """
    header, *lines = read_lines(path)
    columns = [name.strip() for name in next(csv.reader([header]))]
    missing = [name for name in (*texts, *numbers) if name not in columns]
    if missing:
        raise RecordingError(f"{path}, line 1: lacks the column {missing[0]}: {header!r}")
    if not lines:
        raise RecordingError(f"{path}: has a header, but no row")
    last = -math.inf
    for number, line in enumerate(lines, 2):
        place = f"{path}, line {number}"
        cells = next(csv.reader([line]), [])
        if len(cells) != len(columns):
            raise RecordingError(f"{place}: {len(cells)} values for {len(columns)} columns: {line!r}")
        row = dict(zip(columns, cells, strict=True))
        values = [_number(row[name], name, place) for name in numbers]
        if values[0] <= last:
            raise RecordingError(
                f"{place}: stamp {row['stamp'].strip()} does not increase, {last!r} came before"
            )
        last = values[0]
        yield place, [row[name].strip() for name in texts], values


def _number(text: str, name: str, place: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise RecordingError(f"{place}: {name} = {text.strip()!r}: must be a finite number")
    return value
