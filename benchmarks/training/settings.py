"""Hyper-parameters: a file per task and algorithm, or one of the user's own."""

from __future__ import annotations

import tomllib
from dataclasses import asdict, field
from importlib.resources import files
from pathlib import Path
from typing import Any, Final

from pydantic import ConfigDict, ValidationError
from pydantic.dataclasses import dataclass

from benchmarks.policies.surroundings import ESTIMATES, OBSERVES, check_task
from estimators.errors import ConfigError
from gt_env.config.sections.fields import Flag, NotNegative, Positive, Whole

ALGORITHMS: Final = ("ppo", "sac", "bc")
"""Reinforcement learning by PPO or SAC, or behaviour cloning of a scripted policy."""


@dataclass(frozen=True, kw_only=True, config=ConfigDict(extra="forbid"))
class TrainingSettings:
    """How to train.

    Attributes:
        steps: Of the environment, over all copies.
        environments: Copies that are stepped together.
        estimate: What the policy sees in training: a method, or the declared surrogate.
        observes: `pose`, `scan` (a history of scans, for the hard tier) or `raw`.
        camera_rate: Frames per second in training [Hz], where the estimate looks at them; None for the configuration's.
        evaluate_every: Steps between evaluations.
        evaluate_episodes: Of each evaluation.
        checkpoint_every: Steps between checkpoints.
        normalize_reward: Whether rewards are divided by a running standard deviation of the return.
        algorithm: Arguments of the algorithm as stable-baselines3 names them.
        policy: Arguments of its policy (`policy_kwargs`).
        expert: Which scripted policy is cloned; with `bc` only.
        rounds: Of collecting and fitting; with `bc` only.
        noise: Standard deviation of the noise on the expert's actions in the first round; with `bc` only.
    """

    steps: Whole
    environments: Whole = 1
    estimate: str = "surrogate"
    observes: str = "pose"
    camera_rate: Positive | None = None
    evaluate_every: Whole = 10_000
    evaluate_episodes: Whole = 20
    checkpoint_every: Whole = 5_000
    normalize_reward: Flag = False
    algorithm: dict[str, Any] = field(default_factory=dict)
    policy: dict[str, Any] = field(default_factory=dict)
    expert: str = "polar"
    rounds: Whole = 1
    noise: NotNegative = 0.0

    def as_dict(self) -> dict[str, Any]:
        """Plain values."""
        return asdict(self)


def shipped(task: str, algo: str) -> Path:
    """Where the tuned hyper-parameters of a task and algorithm lie.

    Raises:
        ConfigError: If task or algorithm are unknown, or there are none for both together.
    """
    check_task(task)
    if algo not in ALGORITHMS:
        raise ConfigError(f"--algo {algo}: must be one of {', '.join(ALGORITHMS)}")
    folder = Path(str(files("benchmarks") / "training"))
    path = folder / f"{task}_{algo}.toml"
    if not path.is_file():
        there = sorted(p.stem.removeprefix(f"{task}_") for p in folder.glob(f"{task}_*.toml"))
        there = [name for name in there if name in ALGORITHMS]
        raise ConfigError(
            f"--algo {algo}: no hyper-parameters for --task {task}; there are {', '.join(there)}"
        )
    return path


def load_settings(path: Path, overrides: dict[str, Any]) -> TrainingSettings:
    """Read a file of hyper-parameters; overrides that are None count as not given.

    Raises:
        ConfigError: If it is no such file, or a value is unknown or out of range.
    """
    try:
        values = tomllib.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise ConfigError(f"{path}: {error.strerror}") from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise ConfigError(f"{path}: not a TOML file: {error}") from None
    return make_settings(values | {k: v for k, v in overrides.items() if v is not None}, str(path))


def make_settings(values: dict[str, Any], origin: str) -> TrainingSettings:
    """Settings from plain values.

    Raises:
        ConfigError: If a value is unknown or out of range.
    """
    try:
        settings = TrainingSettings(**values)
    except ValidationError as error:
        first = error.errors()[0]
        key = ".".join(str(part) for part in first["loc"])
        allowed = ", ".join(TrainingSettings.__dataclass_fields__)
        unknown = f" (there are {allowed})" if first["type"] == "unexpected_keyword_argument" else ""
        raise ConfigError(f"{origin}: {key} = {first['input']!r}: {first['msg']}{unknown}") from None
    if settings.observes not in OBSERVES:
        raise ConfigError(f"{origin}: observes = {settings.observes!r}: must be one of {', '.join(OBSERVES)}")
    if settings.estimate not in ESTIMATES:
        raise ConfigError(
            f"{origin}: estimate = {settings.estimate!r}: must be one of {', '.join(ESTIMATES)}"
        )
    return settings
