"""Trainings that take a moment."""

from benchmarks.training.folder import Run
from benchmarks.training.settings import make_settings
from gt_env import load_config

CONFIG = load_config({"task": {"time_limit": 3.0}}, default="tasks")
TINY = {
    "ppo": {"algorithm": {"n_steps": 32, "batch_size": 32, "n_epochs": 1}, "normalize_reward": True,
            "environments": 2},
    "sac": {"algorithm": {"learning_starts": 20, "batch_size": 16, "buffer_size": 1000}},
}  # fmt: skip


def tiny(algo, steps, task="reach", **changes):
    values = {"steps": steps, "estimate": "lrf", "evaluate_every": 64, "evaluate_episodes": 1,
              "checkpoint_every": 64, "policy": {"net_arch": [8]}, **TINY[algo], **changes}  # fmt: skip
    settings = make_settings(values, "test")
    return Run(task=task, algo=algo, seed=0, settings=settings, config=CONFIG, setup={})


def weights(path, sb3):
    return {k: v.numpy().copy() for k, v in sb3.load(path).policy.state_dict().items()}
