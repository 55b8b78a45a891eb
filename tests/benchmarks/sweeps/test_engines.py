import io
import json
import os
import secrets
import signal
import socket
import subprocess
import sys
import time
from contextlib import contextmanager
from importlib.util import find_spec
from pathlib import Path

import pytest
from rich.console import Console
from typer.testing import CliRunner

from benchmarks.cli import app
from benchmarks.sweeps import engines
from benchmarks.sweeps.engines import ClusterError, Engine
from benchmarks.sweeps.parallel import SweepError, run_side_by_side
from estimators.errors import ConfigError, MissingExtraError

sys.path.insert(0, str(Path(__file__).parents[1]))  # the cluster's processes get it from here
from sweep_tasks import draw, misbehave

TOKEN = secrets.token_hex(32)
"""Of the clusters that these tests start; one for all, since ray reads it once, when it is imported."""
pytestmark = pytest.mark.filterwarnings("ignore::ResourceWarning", "ignore::FutureWarning")


def sweep(function, tasks, engine):
    console = Console(file=io.StringIO())
    return run_side_by_side(
        function, tasks, [1] * len(tasks), jobs=2, label="", console=console, engine=engine
    )


@pytest.fixture
def installed(monkeypatch):
    """As if both clusters' packages were there."""
    monkeypatch.setattr(engines, "find_spec", lambda name: object())


@contextmanager
def listening():
    """The address of something that takes connections and says nothing."""
    with socket.socket() as server:
        server.bind(("127.0.0.1", 0))
        server.listen()
        yield f"127.0.0.1:{server.getsockname()[1]}"


def free_port():
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        return taken.getsockname()[1]


def test_an_unknown_engine_is_refused():
    with pytest.raises(ConfigError, match="--engine slurm: must be one of loky, ray, dask"):
        Engine(name="slurm")


def test_this_machine_has_no_address():
    with pytest.raises(ConfigError, match="--address here:1: only for --engine ray or dask"):
        Engine(address="here:1")


@pytest.mark.parametrize(("name", "package"), [("ray", "ray"), ("dask", "distributed")])
def test_a_missing_extra_is_named(monkeypatch, name, package):
    monkeypatch.setattr(engines, "find_spec", lambda name: None)
    with pytest.raises(MissingExtraError, match=rf"--engine {name} needs {package}.*gt-env\[cluster\]"):
        Engine(name=name)


@pytest.mark.parametrize("name", ["ray", "dask"])
@pytest.mark.parametrize("address", ["nonsense", "host:", ":1", "host:port"])
def test_what_is_no_address_is_refused(installed, name, address):
    with pytest.raises(ConfigError, match=f"--address {address}: must be HOST:PORT"):
        engines._ask(name, address)


@pytest.mark.parametrize("name", ["ray", "dask"])
def test_an_address_where_nobody_listens_is_said_at_once(installed, name):
    address = f"127.0.0.1:{free_port()}"
    with pytest.raises(ClusterError, match=f"--address {address}: no {name} cluster there"):
        engines._ask(name, address)


@pytest.mark.parametrize("name", ["ray", "dask"])
def test_a_cluster_that_does_not_answer_is_given_up(monkeypatch, installed, name):
    monkeypatch.setattr(engines, "PATIENCE", 1.0)
    monkeypatch.setitem(engines.CONNECT, name, "import time; time.sleep(60)")
    start = time.monotonic()
    with listening() as address, pytest.raises(ClusterError, match=f"no {name} cluster answered within 1 s"):
        engines._ask(name, address)
    assert time.monotonic() - start < 40  # not the 60 s that the other side sleeps


@pytest.mark.parametrize("name", ["ray", "dask"])
def test_a_cluster_that_refuses_is_quoted(monkeypatch, installed, name):
    monkeypatch.setitem(engines.CONNECT, name, "raise SystemExit('wrong version')")
    with listening() as address, pytest.raises(ClusterError, match=f"{name} cannot connect: wrong version"):
        engines._ask(name, address)


@pytest.fixture
def cluster(request, monkeypatch):
    """A cluster of its own for the test: its engine and address."""
    name, package = request.param
    if find_spec(package) is None:
        pytest.skip(f"--engine {name} needs {package}, of the extra `cluster`")
    monkeypatch.setenv("RAY_AUTH_MODE", "token")
    monkeypatch.setenv("RAY_AUTH_TOKEN", TOKEN)
    port = free_port()
    command = {
        "ray": [
            sys.executable, "-c", "from ray.scripts.scripts import main; main()", "start", "--head",
            "--block", f"--port={port}", "--num-cpus=2", "--include-dashboard=false", "--disable-usage-stats",
        ],
        "dask": [
            sys.executable, "-c",
            "import signal\nfrom distributed import LocalCluster\nif __name__ == '__main__':\n"
            f"  LocalCluster(n_workers=2, scheduler_port={port}, dashboard_address=None)\n  signal.pause()",
        ],
    }[name]  # fmt: skip
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(map(str, sys.path))}
    process = subprocess.Popen(
        command, env=environment, start_new_session=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    )
    address = f"127.0.0.1:{port}"
    try:
        _wait_for(port)
        yield Engine(name=name, address=address)
    finally:
        os.killpg(process.pid, signal.SIGTERM)
        try:
            process.wait(5)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()


def _wait_for(port):
    for _ in range(120):
        try:
            socket.create_connection(("127.0.0.1", port), timeout=1).close()
        except OSError:
            time.sleep(0.25)
        else:
            time.sleep(2)
            return
    pytest.fail("the cluster did not start")


on_every_cluster = pytest.mark.parametrize(
    "cluster", [("ray", "ray"), ("dask", "distributed")], indirect=True, ids=["ray", "dask"]
)


@pytest.mark.slow
@on_every_cluster
def test_a_cluster_gives_the_same_bytes_and_names_what_failed(cluster):
    assert sweep(draw, range(6), cluster) == sweep(draw, range(6), Engine())
    with pytest.raises(SweepError, match="run 2: ValueError: no such pose") as raised:
        sweep(misbehave, ["a", "raise", "c"], cluster)
    assert raised.value.results == ["a", None, "c"]
    with pytest.raises(SweepError, match="1 of 3 runs failed: run 2: its process died") as raised:
        sweep(misbehave, ["a", "die", "c"], cluster)
    assert raised.value.results == ["a", None, "c"]


@pytest.mark.slow
@pytest.mark.timeout(600)
@on_every_cluster
def test_a_validation_on_a_cluster_is_the_same_report_bit_for_bit(cluster, tmp_path):
    pytest.importorskip("pybullet")
    command = ["validate", "--quick", "--no-figures", "--seed", "3", "--jobs", "2"]
    command += ["--set", "camera.width=80", "--set", "camera.height=60"]
    reports = []
    for place in (["--engine", cluster.name, "--address", cluster.address], ["--engine", "loky"]):
        out = tmp_path / place[1]
        done = CliRunner().invoke(app, [*command, *place, "--out", str(out)])
        assert done.exit_code == 0, done.output
        reports.append({p.name: p.read_bytes() for p in out.iterdir()})
    assert json.loads(reports[0]["report.json"])["setup"]["seed"] == 3
    assert reports[0] == reports[1]
