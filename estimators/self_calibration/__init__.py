"""The station's own calibration, from the known walls and the moving target; `run` begins it."""
