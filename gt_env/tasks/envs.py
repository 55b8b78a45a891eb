"""The registered environments with a task. Each docstring is the environment's specification.

What all of them share stands here once; `specified` puts it where a docstring names it.
"""

from __future__ import annotations

import inspect
from typing import Final, TypeVar

from gt_env.tasks.env import TaskEnv
from gt_env.tasks.follow_path import FollowPath
from gt_env.tasks.patrol import Patrol
from gt_env.tasks.reach import Reach

SHARED: Final = {
    "ACTION": """As `gt_env/Arena-v0`: `Box(-1, 1, (n,), float32)`, wheel speeds over the robot's maximum, held for one
step of 0.1 s; clipped to [-1, 1] without a word, refused if of another shape or not finite.""",
    "OBSERVATION": "That of `gt_env/Arena-v0` (without `image` by default), and",
    "REWARD": 'The sum of `info["reward_terms"]`; the weights are `task.reward`.',
    "TIME_AND_SMOOTHNESS": """| `time` | minus the step's duration [s] | 0.2 |
| `smoothness` | minus the squared change of the action | 0.005 |""",
    "INFO": "That of `gt_env/Arena-v0`, and",
    "COLLISION_AND_TERMS": """| `collision` | whether the robot touches something |
| `reward_terms` | the terms above |""",
    "ARGUMENTS": "`config`: as `gt_env/Arena-v0`; the preset where none is named is `tasks`. `render_mode`: the same.",
    "VERSIONS": "v0: first version.",
}
"""Parts of the specifications, by the names that stand for them in braces."""

_Env = TypeVar("_Env", bound=type[TaskEnv])


def specified(env: _Env) -> _Env:
    """Put what is shared into an environment's docstring."""
    if env.__doc__:  # python -OO has none
        env.__doc__ = inspect.cleandoc(env.__doc__)
        for name, text in SHARED.items():
            env.__doc__ = env.__doc__.replace(f"{{{name}}}", text)
    return env


@specified
class ReachEnv(TaskEnv):
    """Drive to a goal in the room and touch nothing on the way.

    ## Action Space
    {ACTION}

    ## Observation Space
    {OBSERVATION}

    | key | shape | unit | what |
    |---|---|---|---|
    | `goal` | (2,) float32 | m | x, y of the goal in the station's frame |

    The observation holds no pose: `estimators.PoseObservation` puts in its place what the station measures.

    ## Rewards
    {REWARD}

    | term | value | default weight |
    |---|---|---|
    | `progress` | metres that the goal came nearer | 5 |
    {TIME_AND_SMOOTHNESS}
    | `success` | 1 in the step that reaches the goal | 10 |
    | `failure` | minus 1 in a step that touches a wall or an obstacle | 10 |

    ## Information
    {INFO}

    | key | what |
    |---|---|
    | `is_success` | whether the goal is reached |
    {COLLISION_AND_TERMS}
    | `task` | `distance`: of the robot's base to the goal [m] |

    ## Starting State
    Goal and start pose uniform over the room, `task.margin` (0.40 m) off walls and obstacles,
    `task.station_margin` off LRF and camera (0.75 m in the preset: nearer, the pan unit cannot follow the robot at full
    speed) and at least `task.min_distance` (0.50 m) apart; any yaw.
    `reset(options={"pose": (x, y, yaw), "goal": (x, y)})` sets them. With `task.randomize` the room, its
    obstacles, noise, light and friction are drawn before.

    ## Episode End
    Terminated when the true position of the base is within `task.goal_radius` (0.10 m) of the goal, and on
    contact. Truncated after `task.time_limit` (25 s).

    ## Arguments
    {ARGUMENTS}

    ## Version History
    {VERSIONS}
    """

    task_type = Reach


@specified
class FollowPathEnv(TaskEnv):
    """Drive along a path to its end, fast and not beside it.

    ## Action Space
    {ACTION}

    ## Observation Space
    {OBSERVATION}

    | key | shape | unit | what |
    |---|---|---|---|
    | `goal` | (200,) float32 | m | the path: 100 points x, y, equally far apart, from its start to its end |

    ## Rewards
    {REWARD}

    | term | value | default weight |
    |---|---|---|
    | `progress` | metres along the path, negative backwards | 5 |
    | `cross_track` | minus the distance beside the path [m] times the step's duration [s] | 30 |
    {TIME_AND_SMOOTHNESS}
    | `success` | 1 in the step that reaches the end | 10 |
    | `failure` | minus 1 in a step that leaves the corridor, or touches a wall or an obstacle | 10 |

    ## Information
    {INFO}

    | key | what |
    |---|---|
    | `is_success` | whether the end is reached |
    {COLLISION_AND_TERMS}
    | `task` | `cross_track` [m], positive to the left; `station`, the way along the path [m]; `progress`, 0 to 1 |

    ## Starting State
    A figure of eight, an ellipse or a wave of random size and place, with bends of at least 0.25 m,
    `task.margin` off walls and obstacles and `task.station_margin` off the station; or `task.path`. The robot
    starts at most 0.05 m beside the path's start, at most 20 deg turned away from it, or at
    `reset(options={"pose": (x, y, yaw)})`.

    ## Episode End
    Terminated at the end of the path (`task.goal_radius` along it, 0.10 m), on contact, and when the base is
    more than `task.corridor` (0.30 m) beside the path. Truncated after `task.time_limit` (60 s).

    ## Arguments
    {ARGUMENTS}

    ## Version History
    {VERSIONS}
    """

    task_type = FollowPath


@specified
class PatrolEnv(TaskEnv):
    """Visit way-points in order, again and again, and touch nothing.

    ## Action Space
    {ACTION}

    ## Observation Space
    {OBSERVATION}

    | key | shape | unit | what |
    |---|---|---|---|
    | `goal` | (4,) float32 | m | x, y of the present way-point and of the next |

    Which one is present is decided by the true position, as by a bell that rings at the way-point.

    ## Rewards
    {REWARD}

    | term | value | default weight |
    |---|---|---|
    | `progress` | metres that the present way-point came nearer | 5 |
    {TIME_AND_SMOOTHNESS}
    | `success` | 1 in a step that reaches a way-point | 10 |
    | `failure` | minus 1 in a step that touches a wall or an obstacle | 10 |

    ## Information
    {INFO}

    | key | what |
    |---|---|
    | `is_success` | whether at least one lap is complete, and nothing was touched |
    {COLLISION_AND_TERMS}
    | `task` | `distance` to the present way-point [m], `visited` way-points, `laps` |

    ## Starting State
    A start pose as in `gt_env/Reach-v0` and `task.waypoint_count` (4) way-points drawn like its goal, each at
    least `task.min_distance` from the one before; or `task.waypoints`.

    ## Episode End
    Endless: terminated on contact only, truncated after `task.time_limit` (60 s).

    ## Arguments
    {ARGUMENTS}

    ## Version History
    {VERSIONS}
    """

    task_type = Patrol


@specified
class ReachScanEnv(TaskEnv):
    """Reach, from nothing but the station's scans: the hard tier.

    The scan shows where the target is and not where it heads; that shows only in how it moves.

    ## Action Space
    {ACTION}

    ## Observation Space
    | key | shape | unit | what |
    |---|---|---|---|
    | `scan` | (beams,) float32 | m | the LRF's ranges; no return reads `lrf.range_max` |
    | `goal` | (2,) float32 | m | x, y of the goal in the station's frame |

    ## Rewards, Information, Starting State, Episode End, Arguments
    As `gt_env/Reach-v0`.

    ## Version History
    {VERSIONS}
    """

    task_type = Reach
    observed = ("scan",)
