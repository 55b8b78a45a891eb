"""What asks a process to stop: Ctrl-C, a kill, a terminal that is closed."""

import multiprocessing
import signal
import sys
import time

import pytest

from benchmarks.interrupts import interrupts_held, interrupts_raised

pytestmark = [
    pytest.mark.skipif(not hasattr(signal, "SIGHUP"), reason="needs the signals of POSIX"),
    pytest.mark.usefixtures("signals_of_a_terminal"),
]


@pytest.mark.parametrize("name", ["SIGTERM", "SIGHUP"])
def test_a_kill_and_a_closed_terminal_are_ctrl_c_to_the_work_inside_and_to_none_after_it(name):
    number = getattr(signal, name)
    before = signal.getsignal(number)

    with pytest.raises(KeyboardInterrupt), interrupts_raised():
        signal.raise_signal(number)

    assert signal.getsignal(number) is before


def test_what_a_process_was_started_to_ignore_it_ignores():
    signal.signal(signal.SIGHUP, signal.SIG_IGN)  # as `nohup` does
    went_on = False

    with interrupts_raised():
        signal.raise_signal(signal.SIGHUP)
        went_on = True

    assert went_on
    assert signal.getsignal(signal.SIGHUP) is signal.SIG_IGN


class Deaf:
    """Interrupted while it is thrown away, where Python cannot raise anything."""

    def __init__(self, error):
        self.error = error

    def __del__(self):
        raise self.error


def test_an_interrupt_that_could_not_be_raised_is_not_lost(capsys):
    things = [Deaf(KeyboardInterrupt)]

    def work():
        things.clear()
        time.sleep(60.0)

    with pytest.raises(KeyboardInterrupt), interrupts_raised():
        work()

    assert capsys.readouterr().err == ""


def test_other_errors_that_cannot_be_raised_are_said_as_ever(monkeypatch):
    said = []
    monkeypatch.setattr(sys, "unraisablehook", lambda unraisable: said.append(unraisable.exc_type))
    thing = Deaf(ValueError)

    with interrupts_raised():
        del thing

    assert said == [ValueError]


def test_a_forked_process_ends_as_it_would_have():
    with interrupts_raised():
        child = multiprocessing.get_context("fork").Process(target=time.sleep, args=(120.0,))
        child.start()
        time.sleep(0.2)
        child.terminate()
        child.join(60.0)

    assert child.exitcode == -signal.SIGTERM


def test_an_interrupt_that_waits_for_what_hangs_is_raised_after_all(monkeypatch):
    monkeypatch.setattr("benchmarks.interrupts.HELD", 0.2)
    start = time.monotonic()

    def hangs():
        signal.raise_signal(signal.SIGINT)
        time.sleep(60.0)

    with pytest.raises(KeyboardInterrupt), interrupts_raised(), interrupts_held():
        hangs()

    assert time.monotonic() - start < 30.0


def test_an_interrupt_that_was_held_is_raised_once():
    def twice():
        signal.raise_signal(signal.SIGINT)
        signal.raise_signal(signal.SIGINT)

    with interrupts_raised():
        with pytest.raises(KeyboardInterrupt), interrupts_held():
            twice()
        with interrupts_held():
            nothing_more = True

    assert nothing_more
