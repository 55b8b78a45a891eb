"""What a report was made from, and how to make it again."""

from __future__ import annotations

import platform
import shlex
from collections.abc import Sequence
from dataclasses import asdict
from importlib.metadata import PackageNotFoundError, version
from typing import Any

from benchmarks.validation.plan import Plan

PACKAGES = ("gt-env", "numpy", "opencv-python-headless", "pybullet", "gymnasium", "numba")
"""What the numbers and their speed may depend on."""


def describe(plan: Plan, command: str) -> dict[str, Any]:
    """Command, seed, versions and the whole configuration; nothing that differs from run to run."""
    return {
        "command": command,
        "seed": plan.seed,
        "methods": list(plan.methods),
        "samples": plan.samples,
        "quick": plan.quick,
        "effort": asdict(plan.effort),
        "versions": versions(),
        "config": plan.config.as_dict(),
    }


def versions() -> dict[str, str]:
    """Of Python and of the packages that matter; one that is not installed as a package is left out."""
    found = {"python": platform.python_version()}
    for package in PACKAGES:
        try:
            found[package] = version(package)
        except PackageNotFoundError:
            continue
    return found


def validate_command(
    config: str,
    overrides: list[str],
    seed: int,
    methods: tuple[str, ...],
    *,
    quick: bool,
    only: bool = False,
    parts: Sequence[str] = (),
) -> str:
    """The command line that makes the same report again, `parts` being what is done beside or instead of the usual."""
    words = ["gt-env", "validate", "--config", config]
    for override in overrides:
        words += ["--set", override]
    words += ["--seed", str(seed)]
    for method in methods:
        words += ["--method", method]
    words += ["--quick"] * quick
    for part in parts:
        words += ["--only", part] if only else [f"--{part}"]
    return shlex.join(words)
