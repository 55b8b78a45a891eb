"""Figures: functions of matplotlib's `Axes`, which draw and never show. Needs the extra `report`."""

from importlib.util import find_spec

from estimators.errors import MissingExtraError


def require_matplotlib() -> None:
    """Refuse work that ends in figures before it is begun.

    Raises:
        MissingExtraError: If matplotlib is not installed.
    """
    if find_spec("matplotlib") is None:
        raise MissingExtraError("figures", "matplotlib", "report")
