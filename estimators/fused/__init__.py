"""The best the station can do online: LRF and camera in one filter, with its own uncertainty."""

from estimators.fused.method import FusedEstimator

__all__ = ["FusedEstimator"]
