"""Where the target is, from the LRF alone: one probabilistic model for all beams of a scan."""

from estimators.scan_model.acquisition import Candidate
from estimators.scan_model.fix import PositionFix
from estimators.scan_model.model import ScanModel

__all__ = ["Candidate", "PositionFix", "ScanModel"]
