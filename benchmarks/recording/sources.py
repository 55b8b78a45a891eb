"""Whatever can be replayed, told apart: a recording, a folder, or a text log."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from benchmarks.recording.folder import folder_config, read_folder
from benchmarks.recording.reader import read_recording
from benchmarks.recording.recording import MessageLog, Recording
from benchmarks.recording.scan_log import ScanLaw, read_scan_log
from estimators.calibration import DEG
from estimators.errors import ConfigError, RecordingError
from gt_env.config import EnvConfig, load_config

MCAP_MAGIC: Final = b"\x89MCAP"


@dataclass(frozen=True, kw_only=True, slots=True)
class LawOptions:
    """What the user says of a text log's scans; None leaves it to the configuration.

    Attributes:
        bearing_min_deg: Bearing of the first range [deg].
        bearing_increment_deg: Angle from one range to the next [deg].
        rate: Scans per second [Hz].
    """

    bearing_min_deg: float | None = None
    bearing_increment_deg: float | None = None
    rate: float | None = None

    def over(self, believed: EnvConfig) -> ScanLaw:
        """The law of a log's scans: these options over what is believed of the LRF."""
        lrf = believed.lrf
        first = lrf.bearing_min_deg if self.bearing_min_deg is None else self.bearing_min_deg
        step = lrf.bearing_increment_deg if self.bearing_increment_deg is None else self.bearing_increment_deg
        return ScanLaw(
            bearing_min=first * DEG,
            bearing_increment=step * DEG,
            rate=lrf.rate if self.rate is None else self.rate,
            range_min=lrf.range_min,
            range_max=lrf.range_max,
        )


def open_source(
    path: Path,
    options: LawOptions,
    config: str | None = None,
    overrides: Mapping[str, Any] | None = None,
) -> tuple[Recording, EnvConfig]:
    """Read what `path` holds, and find out what an estimator is to believe of it.

    Args:
        path: A recording, a folder with `scans.txt` or `frames.csv`, or a text log of scans.
        options: Of the scans, where the source itself does not say.
        config: A preset's name or a TOML file. None takes the configuration that came with the data, and
            `thesis` if none did.
        overrides: Values over the configuration.

    Returns:
        The recording, and the configuration as it is believed.

    Raises:
        RecordingError: If the source cannot be read.
        ConfigError: If the configuration is not valid, or options are given that a recording answers itself.
    """
    chosen = load_config(config) if config is not None else None
    if not path.exists():
        raise RecordingError(f"{path}: there is no such file or folder")
    if path.is_dir():
        believed = _believed(chosen or folder_config(path), overrides)
        return read_folder(path, options.over(believed)), believed
    if path.suffix == ".mcap" or _starts_with(path, MCAP_MAGIC):
        if options != LawOptions():
            raise ConfigError(
                f"{path}: a recording knows bearings and stamps of its scans: give no option for them"
            )
        recording = read_recording(path)
        return recording, _believed(chosen or recording.config, overrides)
    believed = _believed(chosen, overrides)
    scans = read_scan_log(path, options.over(believed))
    return Recording(origin=str(path), messages=MessageLog(scans), tool="imported by gt-env"), believed


def _believed(config: EnvConfig | None, overrides: Mapping[str, Any] | None) -> EnvConfig:
    return load_config(config, overrides).believed()


def _starts_with(path: Path, magic: bytes) -> bool:
    try:
        with path.open("rb") as file:
            return file.read(len(magic)) == magic
    except OSError as error:
        raise RecordingError(f"{path}: cannot be read: {error.strerror or error}") from None
