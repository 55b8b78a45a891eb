"""Types of single values, and what makes a class a section."""

from __future__ import annotations

from typing import Annotated

from pydantic import ConfigDict, Field, Strict
from pydantic.dataclasses import dataclass

Real = Annotated[float, Field(strict=True, allow_inf_nan=False)]
Positive = Annotated[float, Field(strict=True, allow_inf_nan=False, gt=0)]
NotNegative = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=0)]
Fraction = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=0, le=1)]
Whole = Annotated[int, Field(strict=True, ge=1)]
Flag = Annotated[bool, Strict()]
Level = Annotated[int, Field(strict=True, ge=0, le=255)]
Color = tuple[Level, Level, Level]
"""Red, green, blue, 0-255."""
Point = tuple[Real, Real]

STRICT = ConfigDict(extra="forbid")
section = dataclass(frozen=True, kw_only=True, config=STRICT)
