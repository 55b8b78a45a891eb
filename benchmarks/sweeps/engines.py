"""Where runs are carried out: on this machine's cores, or on an existing cluster."""

from __future__ import annotations

import importlib
import logging
import os
import secrets
import socket
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from importlib.util import find_spec
from typing import Any, Final

from joblib import parallel_config

from estimators.errors import ConfigError, GtEnvError, MissingExtraError

ENGINES: Final = {"loky": "", "ray": "ray", "dask": "distributed"}
"""Engines by name, and the package that each needs."""
PATIENCE: Final = 20.0
"""How long a cluster may take to answer [s]."""


class ClusterError(GtEnvError, ConnectionError):
    """A cluster that cannot be reached."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Engine:
    """Who carries out runs.

    Attributes:
        name: One of `ENGINES`; `loky` is this machine's cores.
        address: Of an existing cluster, as its own package writes it; None starts one on this machine.

    Raises:
        ConfigError: If there is no such engine, or `loky` is given an address.
        MissingExtraError: If its package is not installed.
    """

    name: str = "loky"
    address: str | None = None

    def __post_init__(self) -> None:
        if self.name not in ENGINES:
            raise ConfigError(f"--engine {self.name}: must be one of {', '.join(ENGINES)}")
        if self.name == "loky" and self.address is not None:
            raise ConfigError(
                f"--address {self.address}: only for --engine ray or dask, loky uses this machine"
            )
        package = ENGINES[self.name]
        if package and find_spec(package) is None:
            raise MissingExtraError(f"--engine {self.name}", package, "cluster")


@contextmanager
def running(engine: Engine, jobs: int) -> Iterator[None]:
    """Inside, tasks go to the engine, `jobs` at a time: joblib's, or those of dask's present client.

    Raises:
        ClusterError: If the cluster does not answer in time.
    """
    start = {"loky": _loky, "ray": _ray, "dask": _dask}[engine.name]
    # With one job joblib would not ask the cluster at all but run the task here.
    with start(engine.address, jobs if engine.name == "loky" else max(2, jobs)):
        yield


@contextmanager
def _loky(_address: str | None, jobs: int) -> Iterator[None]:
    with parallel_config(backend="loky", n_jobs=jobs):
        yield


@contextmanager
def _ray(address: str | None, jobs: int) -> Iterator[None]:
    if address is not None:
        _ask("ray", address)
    ray: Any = importlib.import_module("ray")
    importlib.import_module("ray.util.joblib").register_ray()
    mine = not ray.is_initialized()
    if mine:
        if address is None:
            # A cluster of ours reports to nobody, and leaves no token in the user's home.
            os.environ.setdefault("RAY_USAGE_STATS_ENABLED", "0")
            os.environ.setdefault("RAY_AUTH_TOKEN", secrets.token_hex(32))
        local = {"num_cpus": jobs, "include_dashboard": False}
        where = local if address is None else {"address": address}
        try:
            ray.init(**where, log_to_driver=False, logging_level="ERROR")
        except (ConnectionError, RuntimeError) as error:
            said = (str(error).strip().splitlines() or [type(error).__name__])[0]
            where_asked = "--engine ray" if address is None else f"--address {address}"
            raise ClusterError(f"{where_asked}: ray cannot connect: {said}") from None
    try:
        with parallel_config(backend="ray", n_jobs=jobs):
            yield
    finally:
        if mine:
            ray.shutdown()


@contextmanager
def _dask(address: str | None, jobs: int) -> Iterator[None]:
    distributed: Any = importlib.import_module("distributed")
    if address is None:
        client = distributed.Client(
            n_workers=jobs, threads_per_worker=1, dashboard_address=None, silence_logs=logging.CRITICAL
        )
    else:
        _ask("dask", address)
        client = distributed.Client(address, timeout=PATIENCE)
    with client:
        yield


CONNECT: Final = {
    "ray": "import sys, ray; ray.init(sys.argv[1], log_to_driver=False, logging_level='CRITICAL')",
    "dask": "import sys, distributed; distributed.Client(sys.argv[1]).close()",
}


def _ask(engine: str, address: str) -> None:
    """Let another process connect first: where nobody answers, both packages wait and cannot be stopped."""
    _knock(engine, address)
    connect = [sys.executable, "-c", CONNECT[engine], address]
    try:
        subprocess.run(connect, timeout=PATIENCE, check=True, capture_output=True)
    except subprocess.TimeoutExpired:
        raise _silent(engine, address) from None
    except subprocess.CalledProcessError as error:
        last = (error.stderr.decode(errors="replace").strip().splitlines() or ["no reason given"])[-1]
        raise ClusterError(f"--address {address}: {engine} cannot connect: {last}") from None


def _knock(engine: str, address: str) -> None:
    """Refuse at once what is no address, or nobody listens to."""
    host, _, port = address.split("://", 1)[-1].rpartition(":")
    if not host or not port.isdigit():
        raise ConfigError(f"--address {address}: must be HOST:PORT for --engine {engine}")
    try:
        socket.create_connection((host, int(port)), timeout=PATIENCE).close()
    except TimeoutError:
        raise _silent(engine, address) from None
    except OSError as error:
        raise ClusterError(
            f"--address {address}: no {engine} cluster there: {error.strerror or error}"
        ) from None


def _silent(engine: str, address: str) -> ClusterError:
    hint = "; one that asks for a token needs RAY_AUTH_MODE=token here" if engine == "ray" else ""
    return ClusterError(f"--address {address}: no {engine} cluster answered within {PATIENCE:g} s{hint}")
