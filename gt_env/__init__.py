"""A room, a robot with a marked cylinder, and a station that watches it, as Gymnasium environments.

`gymnasium.make("gt_env:gt_env/Arena-v0", config="thesis")`. Importing this package registers the environments
and loads no physics engine.
"""

from gymnasium import register

from gt_env.config import EnvConfig, load_config

__version__ = "0.1.0"

register(id="gt_env/Arena-v0", entry_point="gt_env.env:ArenaEnv")
register(id="gt_env/Reach-v0", entry_point="gt_env.tasks.envs:ReachEnv")
register(id="gt_env/FollowPath-v0", entry_point="gt_env.tasks.envs:FollowPathEnv")
register(id="gt_env/Patrol-v0", entry_point="gt_env.tasks.envs:PatrolEnv")
register(id="gt_env/ReachScan-v0", entry_point="gt_env.tasks.envs:ReachScanEnv")

__all__ = ["EnvConfig", "__version__", "load_config"]
