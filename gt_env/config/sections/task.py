"""What a robot is asked to do, and how episodes differ from each other."""

from __future__ import annotations

from dataclasses import field
from typing import Annotated

from pydantic import Field

from gt_env.config.sections.fields import Fraction, NotNegative, Point, Positive, section


@section
class RewardConfig:
    """Weights of the reward's terms; a term that a task does not have is not in its reward.

    Attributes:
        progress: Per metre nearer to the goal, or further along the path [1/m].
        time: Taken away per second [1/s].
        success: For a goal or a way-point that is reached, or a path driven to its end.
        failure: Taken away when the robot touches something, or loses the path.
        smoothness: Taken away per step and squared change of the action.
        cross_track: Taken away per second and metre beside the path [1/(m s)].
    """

    progress: NotNegative = 5.0
    time: NotNegative = 0.2
    success: NotNegative = 10.0
    failure: NotNegative = 10.0
    smoothness: NotNegative = 0.005
    cross_track: NotNegative = 30.0


@section
class RandomizationConfig:
    """What is drawn anew at every reset, all of it uniform; 0 leaves things as they are configured.

    The station is told the room and its obstacles, which can be surveyed; it is not told noise, light and
    friction.

    Attributes:
        room: Each wall's corner moves by at most this in x and in y [m].
        obstacles: How many more cylinders stand in the room, at random places.
        lrf_noise: `lrf.noise_sigma` changes by at most this fraction.
        camera_noise: `camera.noise_levels` changes by at most this fraction.
        light: `light.ambient` and the lamps' intensities change by at most this fraction.
        friction: `physics.friction` changes by at most this fraction.
    """

    room: NotNegative = 0.0
    obstacles: Annotated[int, Field(strict=True, ge=0, le=20)] = 0
    lrf_noise: Fraction = 0.0
    camera_noise: Fraction = 0.0
    light: Fraction = 0.0
    friction: Fraction = 0.0


@section
class TaskConfig:
    """The task of an environment that has one.

    Attributes:
        goal_radius: How near to a goal, way-point or path's end is near enough [m].
        margin: Of sampled starts, goals and paths to walls and obstacles [m].
        station_margin: Of the same to the station's LRF and camera [m]; None for as far as it takes the camera to see
            the whole target and the pan unit to follow the robot at full speed.
        min_distance: Between a sampled start and its goal, or two way-points [m].
        time_limit: After which an episode is cut off [s]; None for the task's own.
        linger: How long an episode goes on after a success that would end it [s]: an evaluation lets the station
            come to its own verdict.
        corridor: A path is lost at this distance beside it [m].
        path: Way-points of the path to follow [m], straight lines between them; none for sampled paths.
        waypoints: To patrol, in order, each more than twice `goal_radius` from the one before [m]; none for sampled.
        waypoint_count: How many are sampled.
        reward: Weights.
        randomize: What differs between episodes.
    """

    goal_radius: Positive = 0.10
    margin: Positive = 0.40
    station_margin: NotNegative | None = None
    min_distance: Positive = 0.50
    time_limit: Positive | None = None
    linger: NotNegative = 0.0
    corridor: Positive = 0.30
    path: tuple[Point, ...] = ()
    waypoints: tuple[Point, ...] = ()
    waypoint_count: Annotated[int, Field(strict=True, ge=2, le=20)] = 4
    reward: RewardConfig = field(default_factory=RewardConfig)
    randomize: RandomizationConfig = field(default_factory=RandomizationConfig)
