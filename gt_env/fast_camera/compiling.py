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
    """Compile at the first call and keep the result on disk; without numba the function as it is."""
    if _numba is None:
        return function
    return cast(Function, _numba.njit(function, cache=True, nogil=True, error_model="numpy"))
