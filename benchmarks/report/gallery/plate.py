"""One figure of a report."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:  # what a plate is must be known without the extra that draws it
    from matplotlib.figure import Figure


@dataclass(frozen=True, kw_only=True)
class Plate:
    """One figure of the report.

    Attributes:
        name: Of its file, without the ending.
        section: Of the page that it belongs to.
        repeats: Figure of the thesis that it repeats, or "" if there is none.
        caption: What is to be seen.
        draw: Makes it.
    """

    name: str
    section: str
    repeats: str
    caption: str
    draw: Callable[[], Figure]
