"""How much of the usual a validation simulates."""

from __future__ import annotations

from dataclasses import dataclass

from benchmarks.validation.published import SAMPLES


@dataclass(frozen=True, kw_only=True)
class Effort:
    """How much is simulated.

    Attributes:
        samples: Per test point.
        placements: How often the target is placed anew at each; the thesis did it once.
        single_scans: Per test point, each of a target placed anew.
        joint_scans: Groups of scans per test point.
        at_rest: Robots at random poses before a camera at rest.
        at_rest_dithered: Likewise before one that sweeps.
        driving: Robots that drive about at random.
        longest_drive: Time after which the drives are broken off [s]; None for never.
        stress: How often each of the harder drives is made.
    """

    samples: int
    placements: int
    single_scans: int
    joint_scans: int
    at_rest: int
    at_rest_dithered: int
    driving: int
    longest_drive: float | None
    stress: int


FULL = Effort(
    samples=SAMPLES,
    placements=10,
    single_scans=4000,
    joint_scans=30,
    at_rest=50,
    at_rest_dithered=25,
    driving=50,
    longest_drive=None,
    stress=4,
)
QUICK = Effort(
    samples=30,
    placements=2,
    single_scans=100,
    joint_scans=2,
    at_rest=1,
    at_rest_dithered=1,
    driving=2,
    longest_drive=4.0,
    stress=1,
)
