"""Numba where it is installed, plain Python where it is not."""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from typing import Any, TypeVar, cast

Function = TypeVar("Function", bound=Callable[..., Any])

try:
    _numba: Any = import_module("numba")
except ImportError:  # an optional extra
    _numba = None

COMPILED: bool = _numba is not None
"""Whether functions marked with `compiled` are machine code."""


def compiled(function: Function) -> Function:
    """Compile at the first call and keep the result on disk; without numba the function as it is.

    What is kept is renewed when the function's own file changes, not when one changes that it calls into:
    whoever edits this package empties its `__pycache__`.
    """
    if _numba is None:
        return function
    options = {"nogil": True, "error_model": "numpy"}
    try:
        return cast(Function, _numba.njit(function, cache=True, **options))
    except RuntimeError:  # nowhere to keep it
        return cast(Function, _numba.njit(function, **options))
