"""Partial mappings laid over one another."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any


def merge(base: Mapping[str, Any], over: Mapping[str, Any]) -> dict[str, Any]:
    """A new mapping with the values of `over` in place of those of `base`, key by key in nested mappings."""
    merged = dict(base)
    for key, value in over.items():
        if isinstance(value, Mapping) and isinstance(merged.get(key), Mapping):
            merged[key] = merge(merged[key], value)
        else:
            merged[key] = value
    return merged


def nested(key: str, value: Any) -> dict[str, Any]:
    """`nested("lrf.rate", 10)` is `{"lrf": {"rate": 10}}`."""
    head, _, rest = key.partition(".")
    return {head: nested(rest, value) if rest else value}
