"""Plain text logs of ranges (thesis 4.1): one scan a line, `;` between ranges, metres."""

from __future__ import annotations

import math
import os
import secrets
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from estimators.errors import ConfigError, RecordingError
from estimators.messages import LaserScan


@dataclass(frozen=True, kw_only=True, slots=True)
class ScanLaw:
    """What a text log does not say of its scans.

    Attributes:
        bearing_min: Bearing of the first range [rad].
        bearing_increment: Angle from one range to the next [rad].
        rate: Scans per second [Hz], where no stamps are given.
        range_min: Smallest range that the sensor measures [m].
        range_max: Largest one [m]; what lies beyond is no return.

    Raises:
        ConfigError: If a value is out of range.
    """

    bearing_min: float = 0.0
    bearing_increment: float
    rate: float = 10.0
    range_min: float = 0.0
    range_max: float

    def __post_init__(self) -> None:
        if not math.isfinite(self.bearing_min):
            raise ConfigError(f"bearing_min = {self.bearing_min}: must be finite")
        if not (math.isfinite(self.bearing_increment) and self.bearing_increment):
            raise ConfigError(f"bearing_increment = {self.bearing_increment}: must be finite and not zero")
        if not (math.isfinite(self.rate) and self.rate > 0):
            raise ConfigError(f"rate = {self.rate}: must be above zero")
        if not 0 <= self.range_min < self.range_max < math.inf:
            raise ConfigError(
                f"range_min = {self.range_min}, range_max = {self.range_max}: must be finite, not "
                "negative, and range_min below range_max"
            )

    def scan(self, ranges: NDArray[np.float32], stamp: float) -> LaserScan:
        """Ranges (N,) [m] as a scan; those beyond `range_max` read `range_max`, which is no return."""
        return LaserScan(
            stamp=stamp,
            ranges=ranges.clip(max=np.float32(self.range_max)),
            bearing_min=self.bearing_min,
            bearing_increment=self.bearing_increment,
            range_min=self.range_min,
            range_max=self.range_max,
        )


def read_scan_log(
    path: Path | str, law: ScanLaw, stamps: Sequence[float] | None = None
) -> tuple[LaserScan, ...]:
    """Read a text log of scans.

    Args:
        path: One scan a line; `;` between ranges [m] and, if one likes, after the last.
        law: Bearings, rate and largest range.
        stamps: One for each line [s], increasing; None counts from 0 at `law.rate`.

    Raises:
        RecordingError: If the file cannot be read, is empty, a line is malformed (the message gives file,
            line and text), or there are not as many stamps as lines.
    """
    lines = read_lines(path)
    if stamps is not None and len(stamps) != len(lines):
        raise RecordingError(f"{path}: {len(lines)} scans, but {len(stamps)} stamps are given for them")
    scans: list[LaserScan] = []
    for number, line in enumerate(lines, 1):
        ranges = _ranges(line, f"{path}, line {number}")
        if scans and len(ranges) != len(scans[0].ranges):
            raise RecordingError(
                f"{path}, line {number}: {len(ranges)} ranges, line 1 has {len(scans[0].ranges)}: "
                f"{_shown(line)}"
            )
        scans.append(law.scan(ranges, (number - 1) / law.rate if stamps is None else stamps[number - 1]))
    return tuple(scans)


class ScanLog:
    """The raw scan log of thesis 4.1: start, stop, save. Writes what `read_scan_log` reads."""

    def __init__(self) -> None:
        self.logging = False
        self._lines: list[str] = []

    def __len__(self) -> int:
        return len(self._lines)

    def start(self) -> None:
        """Log from now on."""
        self.logging = True

    def stop(self) -> None:
        """Log nothing more until the next `start`."""
        self.logging = False

    def take(self, scan: LaserScan) -> None:
        """Add a scan, if switched on."""
        if self.logging:
            # The shortest decimal of a float32: 4.0001, as the thesis logs it, and yet every bit.
            self._lines.append("; ".join(np.format_float_positional(r, trim="-") for r in scan.ranges))

    def save(self, path: Path | str) -> None:
        """Write all scans so far; the file appears when it is complete.

        Raises:
            RecordingError: If there is none, or the file cannot be written.
        """
        if not self._lines:
            raise RecordingError(f"{path}: no scan was logged")
        path = Path(path)
        unfinished = path.with_name(f".unfinished-{secrets.token_hex(4)}-{path.name}")
        try:
            unfinished.write_text(
                "".join(f"{line}\n" for line in self._lines), encoding="ascii", newline="\n"
            )
            os.replace(unfinished, path)
        except OSError as error:
            raise RecordingError(f"{path}: cannot be written: {error.strerror or error}") from None
        finally:
            unfinished.unlink(missing_ok=True)


def read_lines(path: Path | str) -> list[str]:
    """Lines of a text file without their ends (LF or CRLF), the empty one after the last end left out.

    Raises:
        RecordingError: If the file cannot be read, is not text or is empty.
    """
    try:
        text = Path(path).read_bytes().decode()
    except OSError as error:
        raise RecordingError(f"{path}: cannot be read: {error.strerror or error}") from None
    except UnicodeDecodeError:
        raise RecordingError(f"{path}: not a text file") from None
    lines = [line.removesuffix("\r") for line in text.removeprefix("\ufeff").split("\n")]
    if not lines[-1]:
        lines.pop()
    if not lines:
        raise RecordingError(f"{path}: is empty")
    return lines


def _ranges(line: str, place: str) -> NDArray[np.float32]:
    texts = line.strip().removesuffix(";").split(";")
    try:
        ranges = np.array([float(text) for text in texts])
    except ValueError:
        wrong = next(text for text in texts if not _is_number(text))
        raise RecordingError(f"{place}: {_shown(wrong)} is not a range in metres") from None
    wrong_at = np.flatnonzero(~(np.isfinite(ranges) & (ranges >= 0)))
    if wrong_at.size:
        raise RecordingError(f"{place}: {_shown(texts[wrong_at[0]])} is not a finite range of at least 0 m")
    return ranges.astype(np.float32)


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


def _shown(text: str) -> str:
    """Text for an error message: quoted, not too long."""
    text = text.strip()
    return repr(text if len(text) <= 40 else f"{text[:37]}...")
