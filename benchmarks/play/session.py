"""A session of driving by hand: an environment, a recorder and a scan log, one step at a time."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import gymnasium as gym
import numpy as np

from benchmarks.output import missing, remove_empty
from benchmarks.play.drive import ArrowDrive
from benchmarks.recording.recorder import Recorder
from benchmarks.recording.scan_log import ScanLog
from estimators.errors import RecordingError
from estimators.messages import STATION_LRF, LaserScan
from estimators.poses import Array, Pose2
from gt_env.render.window import QUIT, Keys

RECORD: Final = "r"
SAVE: Final = "s"
LOG_SCANS: Final = "l"
KEY_HELP: Final = "arrows drive | space or p stop | r record | l scan log | s save | q quit"


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Status:
    """What a front end shows.

    Attributes:
        t: [s].
        true_pose: Where the robot is.
        gt_pose: Where the station says it is, or None without a fix.
        gt_sigma: (3,) standard deviations that the station states [m, m, rad].
        gt_yaw_valid: Whether its yaw may be used.
        wheel_speeds: (n,) by the encoders [rad/s].
        pan: By the encoder [rad], or None without a camera.
        recording: Whether the recording is on.
        recorded: Seconds recorded and not saved.
        logging: Whether the scan log is on.
        logged: Scans logged and not saved.
        message: What happened last.
    """

    t: float
    true_pose: Pose2
    gt_pose: Pose2 | None
    gt_sigma: Array
    gt_yaw_valid: bool
    wheel_speeds: Array
    pan: float | None
    recording: bool
    recorded: float
    logging: bool
    logged: int
    message: str


class PlaySession:
    """Steps an environment with what the keys ask for, and records it on demand.

    Args:
        env: An arena with a ground-truth wrapper named `gt`.
        out: Folder for recordings and scan logs.
    """

    def __init__(self, env: gym.Env[Any, Any], out: Path) -> None:
        base: Any = env.unwrapped
        self.env = env
        self.config = base.config
        self.step_time: float = base.config.timing.step
        self._base = base
        self._out, self._made = out, missing(out)
        self._drive = ArrowDrive(base.config.robot)
        self._recorder = Recorder(out, base.config)
        self._log = ScanLog()
        self._saved: list[Path] = []
        self._recorded = 0.0
        self._message = "ready"
        self._failure = ""
        self._observation: dict[str, Any] = {}
        self._info: dict[str, Any] = {}

    def start(self, seed: int) -> None:
        """Begin at the configuration's start pose."""
        self._observation, self._info = self.env.reset(seed=seed)

    def tick(self, keys: Keys) -> bool:
        """Obey the keys for one step of the environment; False if they ask to quit."""
        for key in keys.pressed:
            if key == QUIT:
                return False
            try:
                self._obey(key)
            except RecordingError as error:
                self._fail(error)
        held = keys.held.union(keys.pressed)  # a key tapped between two steps counts for one
        self._observation, _, _, _, self._info = self.env.step(self._drive.action(held))
        try:
            self._take()
        except RecordingError as error:
            self._recorder.discard()
            self._fail(error)
        return True

    @property
    def status(self) -> Status:
        """The state of things after the last step."""
        gt = self._info["gt"]
        pan = self._observation.get("camera_pan")
        return Status(
            t=float(self._info["t"]),
            true_pose=Pose2.of(self._info["true_pose"]),
            gt_pose=Pose2.of(gt["pose"]) if gt["valid"] else None,
            gt_sigma=np.sqrt(np.diag(gt["covariance"])),
            gt_yaw_valid=bool(gt["yaw_valid"]),
            wheel_speeds=np.asarray(self._observation["wheel_speeds"], float),
            pan=None if pan is None else float(pan[0]),
            recording=self._recorder.recording,
            recorded=self._recorded,
            logging=self._log.logging,
            logged=len(self._log),
            message=self._message,
        )

    def close(self) -> str:
        """Drop what was not saved, close the environment, and say what became of the recordings."""
        lost = []
        if self._recorder.unsaved:
            lost.append(f"{self._recorded:.1f} s of recording")
        if len(self._log):
            lost.append(f"{len(self._log)} scans of the scan log")
        try:
            self._recorder.discard()
        finally:
            remove_empty(self._made)
            self.env.close()
        parts = [self._failure] if self._failure else []
        parts += [f"saved {', '.join(str(path) for path in self._saved)}"] if self._saved else []
        parts += [f"not saved: {' and '.join(lost)}"] if lost else []
        return "; ".join(parts) or "nothing was recorded"

    def _obey(self, key: str) -> None:
        if key == RECORD:
            if self._recorder.recording:
                self._recorder.stop()
                self._message = "recording off; s saves it"
            else:
                self._recorder.start()
                self._message = "recording on"
        elif key == LOG_SCANS:
            if self._log.logging:
                self._log.stop()
                self._message = "scan log off; s saves it"
            else:
                self._log.start()
                self._message = "scan log on"
        elif key == SAVE:
            self._save()

    def _save(self) -> None:
        """Keep what there is; both are off afterwards."""
        saved: list[Path] = []
        self._recorded = 0.0
        path = self._recorder.save()
        if path is not None:
            saved.append(path)
            self._saved.append(path)
        if len(self._log):
            self._out.mkdir(parents=True, exist_ok=True)
            path = self._next_log()
            self._log.stop()
            self._log.save(path)
            self._log = ScanLog()
            saved.append(path)
            self._saved.append(path)
        self._message = f"saved {', '.join(str(p) for p in saved)}" if saved else "there is nothing to save"

    def _take(self) -> None:
        if self._recorder.recording:
            self._recorder.take(self._base.measurements, np.array(self._base.truth, float).reshape(-1, 4))
            self._recorded += self.step_time
        for message in self._base.measurements:
            if isinstance(message, LaserScan) and message.source == STATION_LRF:
                self._log.take(message)

    def _fail(self, error: RecordingError) -> None:
        self._recorded = 0.0
        self._message = self._failure = str(error)

    def _next_log(self) -> Path:
        number = 1
        while (path := self._out / f"scans-{number:03d}.txt").exists():
            number += 1
        return path
