"""Driving by hand: keys to wheels, a session that records, and front ends for window and terminal."""

from benchmarks.play.drive import ArrowDrive, FadingKeys
from benchmarks.play.session import PlaySession, Status

__all__ = ["ArrowDrive", "FadingKeys", "PlaySession", "Status"]
