"""What a calibration found, as a file that estimators read.

It holds quantities with their standard errors, says for which station and target they hold, and is laid over what
is believed otherwise. `docs/calibration.md` describes the format.
"""

from __future__ import annotations

import math
import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import Annotated, Any, Final, Self

import numpy as np
import tomli_w
from numpy.typing import NDArray
from pydantic import ConfigDict, Field, ValidationError
from pydantic.dataclasses import dataclass as checked

from estimators.calibration import Calibration
from estimators.errors import ConfigError
from estimators.poses import Array
from estimators.self_calibration.quantities import NAMES, Q, with_values
from estimators.self_calibration.uncertainty import SEPARATOR, covariance_of, problems

FORMAT: Final = "gt-env calibration"
VERSION: Final = 1
TOLERANCE: Final = 1e-3
"""Corners, heights and angles of one and the same station differ by less [m, rad]."""
_STRICT: Final = ConfigDict(extra="forbid")
_Real = Annotated[float, Field(strict=True, allow_inf_nan=False)]
_Whole = Annotated[int, Field(strict=True, ge=1)]
_Text = Annotated[str, Field(strict=True)]


@checked(frozen=True, kw_only=True, config=_STRICT)
class Station:
    """For which station and target a calibration holds: what is known of them and was not estimated.

    Attributes:
        room: Corners of the walls [m].
        image: Width and height of a frame [px].
        target_height: Lower and upper end of the target [m].
        marker_angles: Of the target's markers [rad].
    """

    room: list[tuple[_Real, _Real]]
    image: tuple[_Whole, _Whole]
    target_height: tuple[_Real, _Real]
    marker_angles: list[_Real]

    @classmethod
    def of(cls, calibration: Calibration) -> Self:
        """The station and target of a calibration."""
        camera, target = calibration.camera, calibration.target
        return cls(
            room=[(x, y) for x, y in calibration.room.vertices.tolist()],
            image=(camera.width, camera.height),
            target_height=(target.z_min, target.z_max),
            marker_angles=list(target.marker_angles),
        )

    def differences(self, other: Station) -> Iterator[str]:
        """In words, what another station has that this one has not."""
        mine, theirs = asdict(self), asdict(other)
        for key, value in mine.items():
            here, there = np.array(value, float), np.array(theirs[key], float)
            if here.shape != there.shape or np.abs(here - there).max(initial=0.0) > TOLERANCE:
                yield f"station.{key} = {_short(value)} there, {_short(theirs[key])} here"


@checked(frozen=True, kw_only=True, config=_STRICT)
class _Content:
    """The file as it is written; `lrf`, `camera` and `target` hold quantities by key."""

    format: _Text
    version: _Whole
    recording: _Text = ""
    station: Station
    lrf: dict[str, _Real] = field(default_factory=dict)
    camera: dict[str, _Real] = field(default_factory=dict)
    target: dict[str, _Real] = field(default_factory=dict)
    standard_errors: dict[str, _Real] = field(default_factory=dict)
    correlations: dict[str, _Real] = field(default_factory=dict)
    not_observable: list[_Text] = field(default_factory=list)


@dataclass(frozen=True, kw_only=True, slots=True)
class CalibrationFile:
    """Quantities that were estimated.

    Attributes:
        values: By name, as in `NAMES`; those that the data said nothing of are missing.
        standard_errors: Of the same, in the same units.
        correlations: Of their errors, by pairs of names with a space between; what is missing is 0.
        not_observable: Names of the others.
        station: For which station and target.
        recording: What they were estimated from.
        origin: The file, for errors.
    """

    values: Mapping[str, float]
    standard_errors: Mapping[str, float]
    not_observable: tuple[str, ...]
    station: Station
    recording: str = ""
    origin: str = "the calibration"
    correlations: Mapping[str, float] = field(default_factory=dict)

    @classmethod
    def of(
        cls,
        believed: Calibration,
        values: Array,
        standard_errors: Array,
        observed: NDArray[np.bool_],
        recording: str,
        correlations: Mapping[str, float] | None = None,
    ) -> Self:
        """What an estimation found: values and errors (10,), and which of them (10,) the data say something of."""
        chosen = [i for i in range(len(Q)) if observed[i]]
        return cls(
            values={NAMES[i]: float(values[i]) for i in chosen},
            standard_errors={NAMES[i]: float(standard_errors[i]) for i in chosen},
            not_observable=tuple(NAMES[i] for i in range(len(Q)) if not observed[i]),
            station=Station.of(believed),
            recording=recording,
            correlations={
                pair: value
                for pair, value in (correlations or {}).items()
                if all(observed[NAMES.index(name)] for name in pair.split(SEPARATOR))
            },
        )

    def over(self, believed: Calibration) -> Calibration:
        """What is to be believed of a station: the quantities of this file, the rest as it was.

        Raises:
            ConfigError: If the file is of another station; says what differs.
        """
        for difference in self.station.differences(Station.of(believed)):
            raise ConfigError(f"{self.origin}: a calibration of another station: {difference}")
        uncertainty = covariance_of(self.standard_errors, self.correlations)
        return replace(with_values(believed, self.values), uncertainty=uncertainty)

    def write(self, path: Path | str) -> None:
        """Write the file (TOML)."""
        sections: dict[str, dict[str, float]] = {"lrf": {}, "camera": {}, "target": {}}
        for name, value in self.values.items():
            section, key = name.split(".")
            sections[section][key] = value
        content = {
            "format": FORMAT,
            "version": VERSION,
            "recording": self.recording,
            "not_observable": list(self.not_observable),
            **{name: keys for name, keys in sections.items() if keys},
            "standard_errors": dict(self.standard_errors),
            "correlations": dict(self.correlations),
            "station": asdict(self.station),
        }
        Path(path).write_text(tomli_w.dumps(content), encoding="utf-8")


def read_calibration(path: Path | str) -> CalibrationFile:
    """Read a calibration file.

    Raises:
        ConfigError: If it cannot be read, is of another version, or a key is unknown or its value of the wrong type
            or out of range; the message names file, key, value and what is allowed.
    """
    origin = str(path)
    try:
        content = tomllib.loads(Path(path).read_text(encoding="utf-8"))
    except OSError as error:
        raise ConfigError(f"{origin}: cannot be read: {error.strerror or error}") from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise ConfigError(f"{origin}: not a TOML file: {error}") from None
    if content.get("format") != FORMAT:
        raise ConfigError(f"{origin}: no calibration: format = {content.get('format')!r}: must be {FORMAT!r}")
    if content.get("version") != VERSION:
        raise ConfigError(
            f"{origin}: version = {content.get('version')!r}: this version of gt-env reads {VERSION}"
        )
    try:
        read = _Content(**content)
    except ValidationError as error:
        raise ConfigError(f"{origin}: {_explain(error)}") from None
    values = {
        f"{section}.{key}": value
        for section in ("lrf", "camera", "target")
        for key, value in getattr(read, section).items()
    }
    for problem in _problems(values, read):
        raise ConfigError(f"{origin}: {problem}")
    return CalibrationFile(
        values=values,
        standard_errors=read.standard_errors,
        not_observable=tuple(read.not_observable),
        station=read.station,
        recording=read.recording,
        origin=origin,
        correlations=read.correlations,
    )


def _explain(error: ValidationError) -> str:
    """The first error: key, value, what is allowed; a misspelt key goes before what is missing because of it."""
    items = error.errors(include_url=False)
    item = next((i for i in items if i["type"] == "unexpected_keyword_argument"), items[0])
    key = ".".join(str(part) for part in item["loc"])
    if item["type"] == "unexpected_keyword_argument":
        allowed = Station.__dataclass_fields__ if len(item["loc"]) > 1 else _Content.__dataclass_fields__
        return f"unknown key {key} = {_short(item['input'])}: must be one of {', '.join(allowed)}"
    if item["type"] in ("missing", "missing_argument"):
        return f"{key} is missing"
    return f"{key} = {_short(item['input'])}: {item['msg'][0].lower()}{item['msg'][1:]}"


def _problems(values: Mapping[str, float], read: _Content) -> Iterator[str]:
    """What the types do not rule out."""
    for name in (*values, *read.standard_errors, *read.not_observable):
        if name not in NAMES:
            yield f"unknown quantity {name}: must be one of {', '.join(NAMES)}"
    for name, value in values.items():
        if name not in read.standard_errors:
            yield f"standard_errors has no {name!r}"
        if name == "target.radius" and not value > 0:
            yield f"{name} = {value}: must be above 0"
        if name == "camera.fov" and not 0 < value < math.pi:
            yield f"{name} = {value}: must be above 0 and below pi"
        if name in read.not_observable:
            yield f"{name} has a value and is in not_observable as well"
    yield from problems(read.standard_errors, read.correlations)


def _short(value: Any) -> str:
    """A value as text, not longer than an error message wants."""
    text = repr(value)
    return text if len(text) <= 120 else f"{text[:117]}..."
