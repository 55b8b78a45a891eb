import io
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from rich.console import Console

from benchmarks.sweeps.parallel import StepCounter, SweepError, run_side_by_side

sys.path.insert(0, str(Path(__file__).parents[1]))  # joblib's processes get it from here
from sweep_tasks import draw, ignores_ctrl_c, misbehave


def sweep(function, tasks, jobs=2, **options):
    return run_side_by_side(
        function, tasks, [3] * len(tasks), jobs=jobs, label="", console=Console(file=io.StringIO()), **options
    )


def test_results_are_in_the_order_of_the_tasks_whatever_the_order_of_the_runs():
    done = run_side_by_side(draw, [4, 5, 6], [1, 9, 5], jobs=2, label="", console=Console(file=io.StringIO()))
    assert done == [draw(seed, lambda: None) for seed in (4, 5, 6)]


def test_results_do_not_depend_on_the_number_of_jobs():
    assert sweep(draw, range(6), jobs=1) == sweep(draw, range(6), jobs=3)


@pytest.mark.parametrize("jobs", [1, 2])
def test_a_task_that_raises_is_named_and_the_others_are_kept(jobs):
    with pytest.raises(SweepError, match="1 of 3 runs failed: point B: ValueError: no such pose") as raised:
        sweep(misbehave, ["a", "raise", "c"], jobs=jobs, names=["point A", "point B", "point C"])
    assert raised.value.results == ["a", None, "c"]
    assert [f.task for f in raised.value.failures] == ["point B"]


def test_a_task_whose_process_dies_is_named_and_the_others_are_kept():
    with pytest.raises(SweepError, match="2 of 7 runs failed: run 3: its process died") as raised:
        sweep(misbehave, ["a", "b", "die", "d", "e", "raise", "g"])
    assert raised.value.results == ["a", "b", None, "d", "e", None, "g"]


def test_what_failed_for_one_reason_is_named_once_and_a_long_list_is_cut():
    with pytest.raises(SweepError, match=r": run 1, run 2, run 3 and 6 more: ValueError: no such pose$"):
        sweep(misbehave, ["raise"] * 9, jobs=1)


def test_steps_are_counted_in_the_task_s_own_slot(tmp_path):
    path = tmp_path / "steps"
    np.zeros(3, np.int64).tofile(path)
    count = StepCounter(path, 1)
    count()
    count()
    assert np.fromfile(path, np.int64).tolist() == [0, 2, 0]


def test_where_the_counters_cannot_be_reached_steps_are_not_counted(tmp_path):
    StepCounter(tmp_path / "elsewhere", 0)()

    assert not (tmp_path / "elsewhere").exists()


def test_ctrl_c_is_answered_by_the_process_that_hands_out_the_work_and_by_no_other():
    before = signal.getsignal(signal.SIGINT)

    assert sweep(ignores_ctrl_c, range(4)) == [True] * 4
    assert signal.getsignal(signal.SIGINT) is before
    assert sweep(ignores_ctrl_c, range(2), jobs=1) == [before is signal.SIG_IGN] * 2


PATIENCE = 120.0
"""How long is waited for what must come [s]; a busy machine takes its time."""
SWEEP = """
import io
from rich.console import Console
from benchmarks.interrupts import interrupts_raised
from benchmarks.sweeps.parallel import run_side_by_side
from sweep_tasks import misbehave
console = Console(file=io.StringIO())
with interrupts_raised():
    run_side_by_side(misbehave, ["sleep"] * 4, [1] * 4, jobs=2, label="", console=console)
"""


@pytest.fixture
def sweeping(tmp_path, tmp_path_factory):
    """Another process in the middle of a sweep, the numbers of its workers, and where its scratch files are."""
    scratch = tmp_path_factory.mktemp("scratch")
    run = subprocess.Popen(
        [sys.executable, "-c", SWEEP], cwd=tmp_path, start_new_session=True, stderr=subprocess.PIPE, text=True,
        env={
            **os.environ,
            "PYTHONPATH": os.pathsep.join(map(str, sys.path)), "TELL": str(tmp_path), "TMPDIR": str(scratch),
        },
        preexec_fn=as_from_a_terminal,
    )  # fmt: skip
    with run:
        try:
            wait_until(lambda: len(list(tmp_path.iterdir())) == 2, PATIENCE)
            yield run, [int(path.name) for path in tmp_path.iterdir()], scratch
        finally:
            run.kill()


def as_from_a_terminal():
    """Signals as a terminal leaves them: what starts the tests may ignore some, and what is ignored is inherited."""
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, signal.SIG_DFL)


def wait_until(true, patience):
    end = time.monotonic() + patience
    while not true():
        assert time.monotonic() < end, "took too long"
        time.sleep(0.05)


def is_alive(process):
    """Whether it runs; one that has ended may wait for someone to ask for its exit status."""
    path = Path(f"/proc/{process}/stat")
    return path.exists() and path.read_text().rpartition(")")[2].split()[0] != "Z"


@pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="asks Linux for its processes")
@pytest.mark.parametrize("how", [signal.SIGINT, signal.SIGTERM, signal.SIGKILL])
def test_a_sweep_that_is_stopped_ends_with_all_its_processes(sweeping, how):
    run, workers, scratch = sweeping
    assert all(is_alive(worker) for worker in workers)

    os.kill(run.pid, how)
    _, said = run.communicate(timeout=PATIENCE)

    assert run.returncode != 0
    if how is not signal.SIGKILL:
        assert said.rstrip().endswith("KeyboardInterrupt")
        assert not list(scratch.iterdir())
    wait_until(lambda: not any(is_alive(worker) for worker in workers), PATIENCE)
