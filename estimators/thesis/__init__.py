"""The thesis's method: chapter 4 rule by rule, each with its equation number."""

from estimators.thesis.method import ThesisEstimator
from estimators.thesis.tracking import ThesisTracker

__all__ = ["ThesisEstimator", "ThesisTracker"]
