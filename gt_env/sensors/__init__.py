"""The station's and the robot's sensors: value, schedule and corruption. None sees the environment."""
