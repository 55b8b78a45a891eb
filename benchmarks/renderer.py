"""The renderer `fast`, made ready before a command uses it."""

from __future__ import annotations

from functools import cache
from importlib.util import find_spec
from typing import Final

from rich.console import Console

from benchmarks.progress import announced
from estimators.errors import MissingExtraError
from gt_env.config import EnvConfig

SLOW: Final = "without it frames take some thirty times as long, steps some ten times"
"""What plain numpy costs at 320x240."""


def prepare_renderer(config: EnvConfig) -> None:
    """Where the configuration draws with `fast`: say that numba is missing, or have it compiled.

    To be called by the process that starts others: they find on disk what was compiled here, and say nothing. Says and
    does nothing the second time.
    """
    if config.camera.enabled and config.camera.renderer == "fast":
        _prepare()


@cache
def _prepare() -> None:
    if find_spec("numba") is None:
        missing = MissingExtraError("the renderer 'fast'", "numba", "fast")
        line = f"gt-env: {missing}; {SLOW}"
        Console(stderr=True, emoji=False).print(line, soft_wrap=True, highlight=False, markup=False)
        return
    with announced("compiling the renderer 'fast', once per installation: about half a minute"):
        from gt_env.fast_camera.renderer import FastRenderer

        FastRenderer(EnvConfig()).picture([(0.0, 2.0, 0.0, 0.0)])
