"""What all messages share."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from estimators.errors import MeasurementError


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Message:
    """What all messages share: when it was measured [s] and by which sensor."""

    stamp: float
    source: str


def freeze(message: object, name: str, dtype: Any, ndim: int) -> None:
    """Store the field as a read-only array, copied unless it already is one, checking its dimensions.

    Args:
        message: Whose field it is; of a frozen dataclass.
        name: Of the field.
        dtype: The array's.
        ndim: How many dimensions it must have.

    Raises:
        MeasurementError: If it has others.
    """
    array = np.asarray(getattr(message, name), dtype)
    if array.ndim != ndim:
        kind = type(message).__name__
        raise MeasurementError(f"{kind}.{name} must have {ndim} dimension(s), got shape {array.shape}")
    if array.flags.writeable:
        array = array.copy()
        array.setflags(write=False)
    object.__setattr__(message, name, array)


def check_finite(message: object, *names: str) -> None:
    """Refuse fields that are infinite or not a number.

    Raises:
        MeasurementError: If one is; the message names it.
    """
    for name in names:
        value = getattr(message, name)
        if not math.isfinite(value):
            raise MeasurementError(f"{type(message).__name__}.{name} must be finite, got {value}")
