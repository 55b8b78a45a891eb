"""What a training leaves behind, and how it is read again."""

from __future__ import annotations

import json
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from benchmarks.output import missing, remove_empty
from benchmarks.training.settings import TrainingSettings, make_settings
from estimators.errors import ConfigError
from gt_env.config import EnvConfig, load_config

RUN: Final = "run.json"
"""What was trained, how and with what; everything else is made from it."""
POLICY: Final = "policy.zip"
"""The policy as it was last saved, with the state of its optimiser: training goes on from here."""
BEST: Final = "best_model.zip"
"""The policy that was best in the evaluations."""
BUFFER: Final = "replay_buffer.pkl"
NORMALIZER: Final = "normalizer.pkl"
EVALUATIONS: Final = "evaluations.npz"


@dataclass(frozen=True, kw_only=True)
class Run:
    """One training.

    Attributes:
        task: Its task.
        algo: Its algorithm.
        seed: Of everything.
        settings: Hyper-parameters.
        config: Of the environment.
        setup: Command and versions.
    """

    task: str
    algo: str
    seed: int
    settings: TrainingSettings
    config: EnvConfig
    setup: dict[str, Any]

    def write(self, folder: Path) -> None:
        """Write `run.json`; the folder is made if need be."""
        folder.mkdir(parents=True, exist_ok=True)
        values = {
            "task": self.task,
            "algo": self.algo,
            "seed": self.seed,
            "settings": self.settings.as_dict(),
            "config": self.config.as_dict(),
            "setup": self.setup,
        }
        (folder / RUN).write_text(json.dumps(values, indent=1) + "\n", encoding="utf-8")


@contextmanager
def begun(run: Run, folder: Path) -> Iterator[None]:
    """A training's folder while it is at work: where that ends before there is a policy, it is as it was before."""
    made = missing(folder)
    try:
        run.write(folder)
        yield
    finally:
        if not _policies(folder):
            (folder / RUN).unlink(missing_ok=True)
            remove_empty(made)


def seed_folder(folder: Path, seed: int) -> Path:
    """Where the training of a seed lies among several that differ in nothing else."""
    return folder / f"seed-{seed}"


def seed_folders(folder: Path) -> list[Path]:
    """The trainings that lie so in a folder, in the order of their seeds."""
    found = [path for path in folder.glob("seed-*") if is_run(path) and path.name[5:].isdigit()]
    return sorted(found, key=lambda path: int(path.name[5:]))


def is_run(folder: Path) -> bool:
    """Whether a training left its files here."""
    return (folder / RUN).is_file()


def read_run(folder: Path) -> Run:
    """Read `run.json`.

    Raises:
        ConfigError: If it is not there or was not written by a training.
    """
    path = folder / RUN
    try:
        values = json.loads(path.read_text(encoding="utf-8"))
        return Run(
            task=values["task"],
            algo=values["algo"],
            seed=values["seed"],
            settings=make_settings(values["settings"], str(path)),
            config=load_config(_as_tuples(values["config"])),
            setup=values["setup"],
        )
    except OSError:
        raise ConfigError(f"{folder}: holds no training: there is no {RUN}") from None
    except (json.JSONDecodeError, KeyError, TypeError) as error:
        raise ConfigError(f"{path}: not written by gt-env train: {error!r}") from None


def best_policy(folder: Path) -> Path:
    """The file to use of a training.

    Raises:
        ConfigError: If it has saved none yet.
    """
    found = _policies(folder)
    if not found:
        raise ConfigError(f"{folder}: holds no policy yet: neither {BEST} nor {POLICY}")
    return found[0]


def _policies(folder: Path) -> list[Path]:
    return [folder / name for name in (BEST, POLICY) if (folder / name).is_file()]


def _as_tuples(values: Any) -> Any:
    """JSON knows lists only, the configuration's types are tuples."""
    if isinstance(values, dict):
        return {key: _as_tuples(value) for key, value in values.items()}
    return tuple(_as_tuples(v) for v in values) if isinstance(values, list) else values
