"""Everything that touches stable-baselines3 and torch, and nothing else does."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from functools import partial
from importlib.util import find_spec
from pathlib import Path
from typing import Any, Final

import gymnasium as gym
import numpy as np
import torch
from numpy.typing import NDArray
from stable_baselines3 import A2C, DDPG, DQN, PPO, SAC, TD3
from stable_baselines3.common.base_class import BaseAlgorithm
from stable_baselines3.common.callbacks import BaseCallback, CallbackList, EvalCallback
from stable_baselines3.common.env_util import make_vec_env
from stable_baselines3.common.logger import Logger
from stable_baselines3.common.off_policy_algorithm import OffPolicyAlgorithm
from stable_baselines3.common.vec_env import DummyVecEnv, SubprocVecEnv, VecEnv, VecNormalize

from benchmarks.output import staged
from benchmarks.training.curves import last_is_best, past_evaluations
from benchmarks.training.exchanges import start_server, whole
from benchmarks.training.folder import BEST, BUFFER, NORMALIZER, POLICY, Run
from benchmarks.training.surroundings import training_env
from estimators.errors import ConfigError

ALGORITHMS: Final[dict[str, type[BaseAlgorithm]]] = {"ppo": PPO, "sac": SAC}
KNOWN: Final = (PPO, SAC, TD3, DDPG, A2C, DQN)
"""Algorithms whose files are read, in the order in which they are tried."""
EVALUATION_SEED: Final = 1_000_000
"""Added to a training's seed for the episodes of its evaluations: none is trained on."""
Progress = Callable[[int], None]

torch.set_num_threads(1)  # networks this small lose time by more


class _Watch(BaseCallback):
    """Reports progress, logs the reward's terms and saves checkpoints."""

    def __init__(self, folder: Path, every: int, progress: Progress) -> None:
        super().__init__()
        self._folder, self._every, self._progress = folder, every, progress
        self._saved = 0

    def _on_training_start(self) -> None:
        self._saved = self.num_timesteps

    def _on_step(self) -> bool:
        self._progress(self.num_timesteps)
        for info in self.locals["infos"]:
            for name, value in info["reward_terms"].items():
                self.logger.record_mean(f"reward/{name}", value)
        if self.num_timesteps - self._saved >= self._every:
            self._saved = self.num_timesteps
            save(self.model, self._folder)
        return True


class _Curve(EvalCallback):
    """Drives the same episodes now and then and keeps the best policy; a training that goes on continues the curve."""

    def __init__(self, env: VecEnv, folder: Path, run: Run, resume: bool) -> None:
        settings = run.settings
        every, episodes = settings.evaluate_every // settings.environments, settings.evaluate_episodes
        super().__init__(
            env, n_eval_episodes=episodes, eval_freq=max(1, every), log_path=str(folder), verbose=0
        )
        self._folder, self._seed = folder, run.seed + EVALUATION_SEED
        if not resume:  # a training that never got to a checkpoint may have left its own
            return
        past = past_evaluations(folder)
        self.evaluations_timesteps, self.evaluations_results = past["timesteps"], past["results"]
        self.evaluations_length, self.evaluations_successes = past["ep_lengths"], past["successes"]

    def _init_callback(self) -> None:
        with warnings.catch_warnings():
            # One environment is evaluated in this process, wherever many are trained in.
            warnings.filterwarnings("ignore", message="Training and eval env are not of the same type")
            super()._init_callback()

    def _on_training_start(self) -> None:
        # Calls count from the first step, also where a training goes on: it would be evaluated late or never else.
        self.n_calls = self.model.num_timesteps // self.training_env.num_envs

    def _on_step(self) -> bool:
        due = self.n_calls % self.eval_freq == 0
        if due:
            self.eval_env.seed(self._seed)  # ways drawn anew differ by more than policies do
        goes_on = super()._on_step()
        if due and last_is_best(self.evaluations_successes, self.evaluations_results):
            with staged(self._folder) as scratch:
                self.model.save(scratch / BEST)
        return goes_on


def train(run: Run, folder: Path, *, resume: bool, jobs: int, progress: Progress) -> int:
    """Train a policy, or go on training it, until the run's steps are done.

    Args:
        run: What to train.
        folder: Where checkpoints, evaluations and the policy go; what is there is gone on from with `resume`.
        resume: Whether to go on.
        jobs: 1 steps the environments in this process; with more each has one of its own.
        progress: Told of the steps that are done.

    Returns:
        Steps done. On Ctrl-C what was learnt is saved, then the interrupt goes on.

    Raises:
        ConfigError: If the algorithm does not know an argument.
        EnvironmentDiedError: If a process of the environments is gone.
    """
    settings = run.settings
    envs = _environments(run, settings.environments, run.seed, jobs)
    checks = _environments(run, 1, run.seed + EVALUATION_SEED, 1)
    if settings.normalize_reward:
        envs = _normalized(envs, folder, resume, settings.algorithm.get("gamma", 0.99))
        checks = VecNormalize(checks, training=False, norm_obs=False, norm_reward=False)
    try:
        model = _model(run, folder, envs, resume)
        if model.tensorboard_log is None:
            # Else it leaves a folder among the system's.
            model.set_logger(Logger(folder=None, output_formats=[]))
        callbacks = [_Curve(checks, folder, run, resume), _Watch(folder, settings.checkpoint_every, progress)]
        left = settings.steps - model.num_timesteps
        try:
            if left > 0:
                model.learn(left, callback=CallbackList(callbacks), reset_num_timesteps=not resume)
        finally:
            save(model, folder)
        return int(model.num_timesteps)
    finally:
        envs.close()
        checks.close()


class Imitator:
    """A network of stable-baselines3's that is fitted to what an expert does, and saved like any other.

    Args:
        env: Whose spaces it has.
        run: Of which the hyper-parameters are read: `learning_rate`, `batch_size`, `n_epochs`, and the policy's.
    """

    def __init__(self, env: gym.Env[Any, Any], run: Run) -> None:
        arguments = dict(run.settings.algorithm)
        try:
            self._epochs = int(arguments.pop("n_epochs"))
            self._batch = int(arguments.pop("batch_size"))
            rate = float(arguments.pop("learning_rate"))
        except KeyError as error:
            raise ConfigError(f"[algorithm] of --algo bc: needs {error.args[0]}") from None
        if arguments:
            raise ConfigError(f"[algorithm] of --algo bc: {', '.join(arguments)}: unknown")
        keywords = dict(run.settings.policy) or None
        self._model = PPO("MlpPolicy", env, seed=run.seed, device="cpu", policy_kwargs=keywords)
        self.predict: Any = self._model.predict
        self._optimizer = torch.optim.Adam(self._model.policy.parameters(), lr=rate)
        self._rng = np.random.default_rng(run.seed)

    def fit(self, observations: NDArray[Any], actions: NDArray[Any]) -> float:
        """Pass over everything several times; returns the last mean squared error."""
        seen = torch.as_tensor(observations, dtype=torch.float32)
        done = torch.as_tensor(actions, dtype=torch.float32)
        loss = torch.zeros(())
        for _ in range(self._epochs):
            for part in np.array_split(self._rng.permutation(len(seen)), max(1, len(seen) // self._batch)):
                distribution: Any = self._model.policy.get_distribution(seen[part])
                loss = torch.mean((distribution.distribution.mean - done[part]) ** 2)
                self._optimizer.zero_grad()
                loss.backward()  # type: ignore[no-untyped-call]
                self._optimizer.step()
        return float(loss.detach())

    def save(self, folder: Path) -> None:
        """Save the network."""
        save(self._model, folder)


def save(model: BaseAlgorithm, folder: Path) -> None:
    """Save everything that training needs to go on; what was there stays until all of it is written."""
    with staged(folder) as scratch:
        model.save(scratch / POLICY)
        if isinstance(model, OffPolicyAlgorithm):
            model.save_replay_buffer(scratch / BUFFER)
        normalizer = model.get_vec_normalize_env()
        if normalizer is not None:
            normalizer.save(str(scratch / NORMALIZER))


def load(path: Path) -> Any:
    """A policy from a file of stable-baselines3, whichever of its algorithms wrote it.

    Raises:
        ConfigError: If it is no such file.
    """
    reason: Exception | None = None
    for algorithm in KNOWN:
        try:
            return algorithm.load(path, device="cpu")
        except Exception as error:
            # Which algorithm wrote a file is not in it; each fails in its own way on another's.
            reason = reason or error
    raise ConfigError(f"{path}: not a policy of stable-baselines3: {reason}") from None


def _environments(run: Run, count: int, seed: int, jobs: int) -> VecEnv:
    make: Callable[[], gym.Env[Any, Any]] = partial(training_env, run.task, run.config, run.settings)
    side_by_side = jobs > 1 and count > 1
    if side_by_side:
        start_server()
    return make_vec_env(
        make,
        n_envs=count,
        seed=seed,
        vec_env_cls=whole(SubprocVecEnv) if side_by_side else DummyVecEnv,
        vec_env_kwargs={"start_method": "forkserver"} if side_by_side else None,
        monitor_kwargs={"info_keywords": ("is_success",)},
    )


def _normalized(envs: VecEnv, folder: Path, resume: bool, gamma: float) -> VecNormalize:
    if resume and (folder / NORMALIZER).is_file():
        return VecNormalize.load(str(folder / NORMALIZER), envs)
    return VecNormalize(envs, norm_obs=False, norm_reward=True, gamma=gamma)


def _model(run: Run, folder: Path, envs: VecEnv, resume: bool) -> BaseAlgorithm:
    if resume:
        model = ALGORITHMS[run.algo].load(folder / POLICY, env=envs, device="cpu")
        if isinstance(model, OffPolicyAlgorithm):
            model.load_replay_buffer(folder / BUFFER)
        return model
    policy = "MultiInputPolicy" if isinstance(envs.observation_space, gym.spaces.Dict) else "MlpPolicy"
    arguments = dict(run.settings.algorithm)
    log = str(folder / "tensorboard") if find_spec("tensorboard") else None
    try:
        return ALGORITHMS[run.algo](
            policy,
            envs,
            seed=run.seed,
            device="cpu",
            tensorboard_log=log,
            policy_kwargs=dict(run.settings.policy) or None,
            **arguments,
        )
    except (TypeError, AssertionError, ValueError) as error:
        raise ConfigError(f"[algorithm] or [policy] of --algo {run.algo}: {error}") from None
