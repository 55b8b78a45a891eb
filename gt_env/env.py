"""The arena: a robot with a marked cylinder in a room, watched by the station."""

from __future__ import annotations

from typing import Any

import gymnasium as gym
import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from estimators.calibration import Calibration
from estimators.errors import ConfigError, GtEnvError
from estimators.localizers.calibration import RobotCalibration
from estimators.messages import Message, PoseEstimate
from estimators.poses import Array, Pose2
from estimators.room import Room
from gt_env.config import ConfigLike, EnvConfig, load_config
from gt_env.config.onboard import robot_calibration
from gt_env.config.problems import pose_problem
from gt_env.render.overview import Overview
from gt_env.render.station_map import Goal
from gt_env.render.window import why_unavailable
from gt_env.world import World


class PickledError(GtEnvError, TypeError):
    """An environment that was to be pickled or copied."""


Observation = dict[str, NDArray[Any]]
Info = dict[str, Any]


class ArenaEnv(gym.Env[Observation, Array]):
    """Drive a robot in a room while a station of a laser rangefinder and a panning camera watches it.

    ## Description
    The world that the station is made for, without a task: the robot drives as it is told, the station measures. What
    the station makes of it is for `estimators.GroundTruthWrapper`, which adds `info["gt"]`; `gt_env/Reach-v0` and
    others add tasks.

    ## Action Space
    `Box(-1, 1, (n,), float32)`, held for one step (`timing.step`, 0.1 s). Speeds are over the robot's maximum
    (`robot.max_wheel_speed`, 29.4 rad/s by default). What lies beyond [-1, 1] is clipped to it, without a word; another
    shape, NaN and infinity are refused with a `ConfigError`.

    | `robot.model` | n | action | `wheel_speeds` |
    |---|---|---|---|
    | `differential` | 2 | speeds of the left and the right wheel | of both |
    | `skid_steer` | 2 | speeds of the left and the right wheels | mean of each side |
    | `ackermann` | 2 | mean speed of the rear wheels, steering angle | of the rear wheels, left and right |
    | `omni3` | 3 | speeds of the front left, rear and front right wheel | of all |

    A steering angle is over `robot.max_steering_deg`, positive to the left; three omnidirectional wheels with
    positive speeds turn the robot counter-clockwise.

    ## Observation Space
    A flat `Dict`. A sensor with nothing new repeats its last value with its old stamp; one that is switched
    off has no key.

    | key | shape | unit | what |
    |---|---|---|---|
    | `scan` | (beams,) float32 | m | the LRF's ranges; no return reads `lrf.range_max` |
    | `image` | (H, W, 3) uint8 | | the camera's frame, RGB; not with `camera.in_observation = false` |
    | `camera_pan` | (1,) float32 | rad | the pan unit's encoder when that frame was taken |
    | `wheel_speeds` | (n,) float32 | rad/s | from the robot's encoders |
    | `imu` | (3,) float32 | rad/s, m/s^2 | the robot's gyro, and its accelerometer along x and y |
    | `robot_scan` | (beams,) float32 | m | the robot's own lidar; no return reads `onboard.lidar.range_max` |
    | `stamps` | (k,) float64 | s | when each enabled sensor measured: LRF, camera, encoders, IMU, lidar |

    IMU and lidar of the robot are off by default (`onboard.imu.enabled`, `onboard.lidar.enabled`).

    ## Rewards
    Always 0.

    ## Information
    | key | shape | unit | what |
    |---|---|---|---|
    | `true_pose` | (3,) | m, m, rad | the simulator's pose of the robot's base |
    | `t` | | s | time since the start of the episode |

    `env.unwrapped.measurements` holds every message since the last step in the order of delivery, and
    `env.unwrapped.truth` the true pose at every physics tick since then, rows of t, x, y, yaw.

    ## Starting State
    At `robot.start`, or at `reset(options={"pose": (x, y, yaw)})`, at rest, pan unit settled on the first
    scan.

    ## Episode End
    Never: neither terminated nor truncated. `gymnasium.make(..., max_episode_steps=N)` truncates.

    ## Arguments
    `config`: an `EnvConfig`, a mapping, a preset's name or a TOML file's path. `render_mode`: None, `rgb_array`, or
    `human`: a window, in real time, which needs a display and pygame (extra `window`); `metadata` of an environment
    lists the modes that this machine has.

    ## Version History
    v0: first version.
    """

    metadata: dict[str, Any] = {  # noqa: RUF012 - Gymnasium's own declaration
        "render_modes": ["rgb_array", "human"],
        "render_fps": 10,
    }

    def __init__(self, config: ConfigLike = None, render_mode: str | None = None) -> None:
        modes = self.metadata["render_modes"]
        if render_mode is not None and render_mode not in modes:
            raise ConfigError(f"render_mode = {render_mode!r}: must be None or one of {', '.join(modes)}")
        missing = why_unavailable()
        if render_mode == "human" and missing:
            raise ConfigError(
                f"render_mode = 'human': {missing}; 'rgb_array' needs neither display nor pygame"
            )
        self.config = load_config(config)
        self.render_mode = render_mode
        # The class lists what can be asked for, so that Gymnasium asks it; an instance what its checkers can try here.
        self.metadata = {
            "render_modes": [mode for mode in modes if mode != "human" or not missing],
            "render_fps": max(1, round(1 / self.config.timing.step)),
        }
        self._ticks = self.config.ticks(self.config.timing.step)
        self._build(self.config)
        actions: Any = spaces.Box(-1.0, 1.0, (self._world.robot.actions,), np.float32)
        observations: Any = spaces.Dict(self._world.spaces())
        self.action_space = actions
        self.observation_space = observations
        self._estimates: dict[str, PoseEstimate] = {}
        self._overview: Overview | None = None

    def _build(self, config: EnvConfig) -> None:
        """Make the world, and what estimators are told of it."""
        believed = config.believed()
        self.believed_calibration: Calibration = believed.calibration()
        self.believed_robot: RobotCalibration = robot_calibration(believed)
        self.believed_map: Room = believed.room.in_station_frame(believed.onboard.lidar.height)
        self._room = config.room.in_station_frame()
        self._world = World(config)

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, Info]:
        """Start an episode.

        Args:
            seed: Of all randomness of this and the following episodes.
            options: `pose`: x, y [m], yaw [rad] to start at.

        Raises:
            ConfigError: If an option is unknown, or the robot cannot stand at the pose.
        """
        super().reset(seed=seed)
        pose = self._start_pose(options or {})
        self._world.reset(pose, self.np_random)
        self._estimates.clear()
        if self._overview is not None:
            self._overview.reset()
        self._show()
        return self._world.observe(), self._info()

    def step(self, action: Array) -> tuple[Observation, float, bool, bool, Info]:
        """Drive for one step.

        Raises:
            ConfigError: If the action is of the wrong shape or not finite.
        """
        self._world.robot.drive(self._checked(action))
        self._world.advance(self._ticks)
        self._show()
        return self._world.observe(), 0.0, False, False, self._info()

    def render(self) -> NDArray[np.uint8] | None:
        """One picture of scene, camera, map and numbers (`rgb_array`), or refresh the window (`human`)."""
        if self.render_mode is None:
            gym.logger.warn("render() needs a render_mode: gymnasium.make(..., render_mode='rgb_array')")
            return None
        return self._picture()

    def _picture(self, wait: bool = True) -> NDArray[np.uint8] | None:
        if self._overview is None:
            window = self.render_mode == "human"
            self._overview = Overview(self._world, self.believed_calibration, window)
        return self._overview.draw(self._estimates, wait, self._goal())

    def _goal(self) -> Goal | None:
        """What to mark on the map."""
        return None

    def close(self) -> None:
        """Disconnect from the engine and close the window."""
        self._world.close()
        if self._overview is not None:
            self._overview.close()

    @property
    def measurements(self) -> tuple[Message, ...]:
        """Every sensor's messages since the last step, in the order of delivery."""
        return tuple(self._world.delivered)

    @property
    def truth(self) -> list[tuple[float, float, float, float]]:
        """True t [s], x, y [m], yaw [rad] at every physics tick since the last step."""
        return self._world.truth

    def show_estimate(self, name: str, estimate: PoseEstimate) -> None:
        """Have an estimate drawn in the rendered pictures; wrappers call it after every step."""
        self._estimates[name] = estimate
        if self.render_mode == "human":
            self._picture(wait=False)

    def _show(self) -> None:
        if self.render_mode == "human":
            self.render()
        elif self._overview is not None:
            self._overview.record(self._estimates)

    def _info(self) -> Info:
        return {"true_pose": np.array(self._world.robot.pose()), "t": self._world.time}

    def _start_pose(self, options: dict[str, Any]) -> Pose2:
        for key in options:
            if key != "pose":
                raise ConfigError(f"options[{key!r}]: unknown, must be 'pose'")
        if options.get("pose") is None:
            return self.config.start_pose
        pose = Pose2.of(options["pose"])
        problem = pose_problem(self.config, self._room, pose)
        if problem:
            raise ConfigError(f"options['pose'] = {pose.as_array().tolist()}: {problem}")
        return pose

    def __getstate__(self) -> Any:
        """Refuse to be pickled or copied: the engine's world lives outside Python.

        Raises:
            PickledError: Always.
        """
        raise PickledError(
            "an environment cannot be pickled or copied, its world is the engine's: pickle env.spec, or "
            "env.unwrapped.config, and make another: gymnasium.make(spec)"
        )

    def _checked(self, action: Array) -> Array:
        values = np.asarray(action, dtype=float)
        shape = self.action_space.shape
        if values.shape != shape or not np.isfinite(values).all():
            raise ConfigError(f"action = {values.tolist()}: must be {shape} finite numbers in [-1, 1]")
        return values.clip(-1.0, 1.0)
