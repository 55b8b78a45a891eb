"""What is asked for on the command line, checked."""

from __future__ import annotations

import shlex
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import numpy as np

from benchmarks.report.setup import versions
from benchmarks.scoring.judge import Rules, called
from benchmarks.scoring.live import PATHS_SCORED, LiveRun, path_named
from benchmarks.scoring.subjects import Subject, all_subjects
from benchmarks.scoring.write import Result
from benchmarks.trajectory.alignment import ALIGNMENTS, TITLES
from estimators.errors import ConfigError
from estimators.room import Room
from gt_env.config import EnvConfig, load_config, parse_override

CONFIG: Final = "onboard"
LIVE_REFERENCES: Final = ("fused", "smooth")
SEEDS, QUICK_SEEDS = 3, 1
DURATION, QUICK_DURATION = 60.0, 20.0
"""Of a run [s]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Request:
    """A score that can be made.

    Attributes:
        subjects: Who.
        paths: What is driven, by name.
        recordings: What is replayed instead.
        gt: A file that is the reference instead.
        config: Of the simulation, or what replaces a recording's own; None leaves it that.
        overrides: Values over it.
        seeds: Runs of each path.
        duration: Of a run [s].
        seed: Of everything.
        reference: Which of the station's answers counts.
        rules: How runs are judged.
        record: Whether recordings of the runs are kept.
        words: The command's own, to repeat it.
    """

    subjects: tuple[Subject, ...]
    paths: tuple[str, ...]
    recordings: tuple[Path, ...]
    gt: Path | None
    config: str | None
    overrides: tuple[tuple[str, Any], ...]
    seeds: int
    duration: float
    seed: int
    reference: str
    rules: Rules
    record: bool
    words: tuple[str, ...]

    @classmethod
    def parsed(
        cls,
        *,
        subjects: tuple[str, ...] = (),
        trajectories: tuple[str, ...] = (),
        paths: tuple[str, ...] = (),
        recordings: tuple[Path, ...] = (),
        gt: Path | None = None,
        config: str | None = None,
        overrides: tuple[str, ...] = (),
        seeds: int | None = None,
        duration: float | None = None,
        quick: bool = False,
        seed: int = 0,
        reference: str = "fused",
        align: str = "none",
        max_gap: float = Rules().max_gap,
        calibration: tuple[float, float] = (0.0, 0.0),
        record: bool = False,
    ) -> Request:
        """Check what was asked for.

        Raises:
            ConfigError: If it does not make sense; the message names the option.
        """
        if reference not in LIVE_REFERENCES:
            raise ConfigError(f"--reference {reference}: must be one of {', '.join(LIVE_REFERENCES)}")
        if align not in ALIGNMENTS:
            raise ConfigError(f"--align {align}: must be one of {', '.join(ALIGNMENTS)}")
        found = all_subjects(subjects, trajectories, Path.cwd(), default=not trajectories and gt is None)
        files = [s for s in found if s.kind == "file"]
        if gt is not None and recordings:
            raise ConfigError("--gt and --recording: give one of them")
        if gt is not None and len(files) < len(found):
            other = next(s for s in found if s.kind != "file")
            raise ConfigError(f"SUBJECT {other.name}: beside --gt only trajectory files can be scored")
        if files and gt is None and not recordings:
            raise ConfigError(
                f"SUBJECT {files[0].name}={files[0].target}: a file needs --recording or --gt to be compared with"
            )
        if (recordings or gt) and paths:
            raise ConfigError(f"--path {paths[0]}: nothing is driven beside --recording or --gt")
        if (recordings or gt) and record:
            raise ConfigError("--record: there is nothing to record beside --recording or --gt")
        words = [*subjects, *(f"--trajectory={t}" for t in trajectories), *(f"--path={p}" for p in paths)]
        words += [f"--recording={r}" for r in recordings] + ([f"--gt={gt}"] if gt else [])
        words += [f"--config={config}"] if config else []
        words += [f"--set={o}" for o in overrides]
        words += [f"--seeds={seeds}"] if seeds else []
        words += [f"--duration={duration:g}"] if duration else []
        words += [f"--max-gap={max_gap:g}"] if max_gap != Rules().max_gap else []
        words += [f"--calibration-mm={calibration[0]:g}"] if calibration[0] else []
        words += [f"--calibration-deg={calibration[1]:g}"] if calibration[1] else []
        words += (
            ["--quick"] * quick
            + ["--record"] * record
            + [f"--seed={seed}", f"--reference={reference}", f"--align={align}"]
        )
        return cls(
            subjects=found,
            paths=tuple(dict.fromkeys(path_named(p) for p in paths)) or PATHS_SCORED,
            recordings=recordings,
            gt=gt,
            config=config,
            overrides=tuple(parse_override(text) for text in overrides),
            seeds=seeds or (QUICK_SEEDS if quick else SEEDS),
            duration=duration or (QUICK_DURATION if quick else DURATION),
            seed=seed,
            reference="file" if gt is not None else reference,
            rules=Rules(align=align, max_gap=max_gap, seed=seed, calibration=calibration),
            record=record,
            words=tuple(words),
        )

    @property
    def live(self) -> bool:
        """Whether runs are simulated."""
        return not self.recordings and self.gt is None

    def settings(self) -> EnvConfig:
        """The configuration of the simulation."""
        return load_config(self.config or CONFIG, dict(self.overrides))

    def room(self) -> Room:
        """What is drawn under the trajectories."""
        return self.believed(None).room.in_station_frame()

    def believed(self, recorded: EnvConfig | None) -> EnvConfig:
        """The configuration as station and robot believe it: what was asked for, else what was recorded."""
        if recorded is None and self.recordings and self.config is None:
            from benchmarks.recording import read_recording

            recorded = read_recording(self.recordings[0]).config
        chosen = load_config(self.config) if self.config else recorded or load_config(CONFIG)
        return load_config(chosen, dict(self.overrides)).believed()

    def live_runs(self, folder: Path) -> list[LiveRun]:
        """All runs, each with a seed of its own.

        Args:
            folder: Where recordings are kept, if they are.

        Raises:
            ConfigError: If a path does not fit into the room.
        """
        settings = self.settings()
        runs = []
        for number, (path, turn, seed) in enumerate(self._episodes()):
            place = str(folder / f"{called(path, turn)}.mcap") if self.record else ""
            runs.append(
                LiveRun(
                    config=settings,
                    subjects=self.subjects,
                    path=path,
                    turn=turn,
                    seed=seed,
                    number=number,
                    rules=self.rules,
                    duration=self.duration,
                    recording=place,
                    series=turn == 0,
                )
            )
        return runs

    def _episodes(self) -> list[tuple[str, int, int]]:
        """Path, number among its runs and seed of every live run."""
        kinds = [(path, turn) for path in self.paths for turn in range(self.seeds)] if self.live else []
        children = np.random.SeedSequence(self.seed).spawn(len(kinds))
        return [(*kind, int(child.generate_state(1)[0])) for kind, child in zip(kinds, children, strict=True)]

    def described(self, result: Result) -> dict[str, Any]:
        """What a report was made from, and how to make it again."""
        config = self.settings() if self.live else self.believed(None)
        return {
            "command": shlex.join(["gt-env", "score", *self.words]),
            "lead": _lead(result, self.live),
            "seed": self.seed,
            "runs": [run.called for run in result.runs],
            "episode_seeds": {called(path, turn): seed for path, turn, seed in self._episodes()},
            "reference": self.reference,
            "starts": {run.called: run.start for run in result.runs},
            "align": self.rules.align,
            "alignment": TITLES[self.rules.align],
            "duration": self.duration if self.live else None,
            "calibration_mm": self.rules.calibration[0],
            "calibration_deg": self.rules.calibration[1],
            "versions": versions(),
            "config": config.as_dict(),
        }


def _lead(result: Result, live: bool) -> str:
    runs = len(result.runs)
    kind = "simulated run" if live else "recorded run"
    return (
        f"{runs} {kind}{'s' if runs > 1 else ''}. The station, a laser rangefinder and a camera in the room, says "
        "where the robot was; each localizer says where it thought it was. The station errs too: every score is less "
        "the station's own share, and where that share is too large the verdict says so."
    )
