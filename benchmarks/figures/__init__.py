"""Figures: functions of matplotlib's `Axes`, which draw and never show. Needs the extra `report`."""
