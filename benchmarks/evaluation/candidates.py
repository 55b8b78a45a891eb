"""Policies as the command line names them."""

from __future__ import annotations

import importlib
import sys
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import gymnasium as gym

from benchmarks.policies.named import SCRIPTED
from benchmarks.policies.surroundings import policy_env
from benchmarks.training.folder import Run, best_policy, is_run, read_run, seed_folders
from estimators.errors import ConfigError, MissingExtraError
from gt_env.config import EnvConfig


@dataclass(frozen=True, kw_only=True)
class Candidate:
    """A policy to be judged.

    Attributes:
        name: In tables.
        spec: As it was asked for.
        file: Of stable-baselines3, if it is one.
        run: The training that it comes from, if that is known.
    """

    name: str
    spec: str
    file: Path | None = None
    run: Run | None = None

    @property
    def kind(self) -> str:
        """Where it comes from."""
        if self.run is not None:
            return f"trained by {self.run.algo}, seed {self.run.seed}"
        if self.file is not None:
            return "file"
        return "scripted" if self.spec in SCRIPTED else "class"


def candidates(specs: list[str]) -> list[Candidate]:
    """What was asked for.

    Raises:
        ConfigError: If one is none of the kinds there are, or is named twice.
    """
    found = [c for spec in specs for c in _candidates(spec)]
    names = [c.name for c in found]
    repeated = {name for name in names if names.count(name) > 1}
    found = [
        Candidate(name=c.spec, spec=c.spec, file=c.file, run=c.run) if c.name in repeated else c
        for c in found
    ]
    if len({c.name for c in found}) < len(found):
        raise ConfigError(f"POLICY {', '.join(sorted(repeated))}: named twice")
    return found


def _candidates(spec: str) -> list[Candidate]:
    """One, or as many as there are trainings in a folder of several seeds."""
    path = Path(spec)
    if spec in SCRIPTED or not path.is_dir():
        return [_candidate(spec)]
    folders = [path] if is_run(path) else seed_folders(path)
    if not folders:
        raise ConfigError(f"POLICY {spec}: holds no training (gt-env train --out {spec} makes one)")
    _require_learning(spec)
    name = path.resolve().name
    return [
        Candidate(
            name=name if folder == path else f"{name} {folder.name}",
            spec=str(folder),
            file=best_policy(folder),
            run=read_run(folder),
        )
        for folder in folders
    ]


def _candidate(spec: str) -> Candidate:
    if spec in SCRIPTED:
        return Candidate(name=spec, spec=spec)
    path = Path(spec)
    if path.is_file():
        _require_learning(spec)
        return Candidate(name=path.stem, spec=spec, file=path)
    if ":" in spec:
        _class(spec)
        return Candidate(name=spec.rpartition(":")[2], spec=spec)
    raise ConfigError(
        f"POLICY {spec}: must be a folder of gt-env train, a file of stable-baselines3, module:Class or one of "
        f"{', '.join(SCRIPTED)}"
    )


def _require_learning(spec: str) -> None:
    for package in ("torch", "stable_baselines3"):
        if find_spec(package) is None:
            raise MissingExtraError(f"POLICY {spec}", package, "rl")


def _class(spec: str) -> Any:
    """What `module:Class` names; modules in the present folder are found too."""
    module, _, name = spec.rpartition(":")
    if "" not in sys.path:
        sys.path.insert(0, "")
    try:
        found = getattr(importlib.import_module(module), name)
    except (ImportError, AttributeError, ValueError) as error:
        raise ConfigError(f"POLICY {spec}: {error}") from None
    except Exception as error:  # whatever the module itself does when it is imported
        words = " ".join(f"{type(error).__name__}: {error}".split())
        raise ConfigError(f"POLICY {spec}: cannot be imported: {words}") from None
    if not callable(found):
        raise ConfigError(
            f"POLICY {spec}: must be a class, or make a policy when it is called with the environment"
        )
    return found


def meet(
    candidate: Candidate, task: str, config: EnvConfig, estimate: str, render_mode: str | None = None
) -> tuple[gym.Env[Any, Any], Any]:
    """A policy and an environment that it can see.

    Args:
        candidate: The policy.
        task: One of `TASKS`.
        config: Of the environment.
        estimate: What the policy sees: one of `ESTIMATES`.
        render_mode: Of the environment.

    Raises:
        ConfigError: If its spaces are not those of the environment.
    """

    def surroundings(observes: str) -> gym.Env[Any, Any]:
        return policy_env(task, config, estimate=estimate, observes=observes, render_mode=render_mode)

    if candidate.file is None:
        make = SCRIPTED.get(candidate.spec) or _class(candidate.spec)
        env = surroundings(getattr(make, "observes", "pose"))
        try:
            policy = make(env)
        except Exception as error:  # it is the user's own code
            env.close()
            raise ConfigError(
                f"POLICY {candidate.spec}: cannot be made for this environment: {type(error).__name__}: {error}"
            ) from error
        if not callable(getattr(policy, "predict", None)):
            raise ConfigError(f"POLICY {candidate.spec}: has no predict()")
        return env, policy
    from benchmarks.training import sb3

    policy = sb3.load(candidate.file)
    scans = ("scan",) if task in ("reach", "reach_scan") else ()
    tried = (candidate.run.settings.observes,) if candidate.run else ("pose", *scans, "raw")
    seen = []
    for observes in tried:
        env = surroundings(observes)
        if (policy.observation_space, policy.action_space) == (env.observation_space, env.action_space):
            return env, policy
        seen.append(f"{_words(env.observation_space)} to {_words(env.action_space)}")
        env.close()
    raise ConfigError(
        f"POLICY {candidate.spec}: was trained for {_words(policy.observation_space)} to "
        f"{_words(policy.action_space)}, the environment of {task} has {', or '.join(seen)}"
    )


def _words(space: gym.Space[Any]) -> str:
    """A space on one line, however many bounds it has."""
    if isinstance(space, gym.spaces.Dict):
        return "{" + ", ".join(f"{key}: {_words(part)}" for key, part in space.items()) + "}"
    if isinstance(space, gym.spaces.Box):
        return f"Box({space.low.min():.4g}, {space.high.max():.4g}, {space.shape}, {space.dtype})"
    return " ".join(str(space).split())
