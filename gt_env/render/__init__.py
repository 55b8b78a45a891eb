"""The picture of `render()`: scene, camera image, map, chart and numbers in one frame, and a window for it.

Drawn with OpenCV from plain data, so that it needs neither a simulator nor a display.
"""

from gt_env.render.dashboard import Dashboard
from gt_env.render.map_view import MapView

__all__ = ["Dashboard", "MapView"]
