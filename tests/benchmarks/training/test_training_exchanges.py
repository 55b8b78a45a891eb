"""Ctrl-C while environments in other processes are asked something, and processes that die."""

import signal
from functools import partial
from types import SimpleNamespace

import gymnasium as gym
import numpy as np
import pytest
from mortal_env import Mortal

from benchmarks.interrupts import interrupts_raised
from benchmarks.training.exchanges import EXCHANGES, EnvironmentDiedError, whole

pytestmark = pytest.mark.usefixtures("signals_of_a_terminal")


class Asked:
    """Asks two processes in turn, as stable-baselines3 does; something happens before the second answer."""

    def __init__(self, happens=lambda: None):
        self.happens, self.open, self.processes = happens, [], [SimpleNamespace(terminate=self.ended)]
        self.terminated = False

    def step_wait(self):
        self.open = [0, 1]
        self.open.pop()
        self.happens()
        self.open.pop()

    def close(self):
        if self.open:
            raise EOFError

    def ended(self):
        self.terminated = True


for name in set(EXCHANGES) - {"__init__", "step_wait"}:
    setattr(Asked, name, lambda self: None)


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_an_interrupt_waits_until_every_answer_is_there(number):
    environments = whole(Asked)(partial(signal.raise_signal, number))

    with pytest.raises(KeyboardInterrupt), interrupts_raised():
        environments.step_wait()

    assert environments.open == []


def test_an_interrupt_counts_for_more_than_the_error_it_led_to():
    def both():
        signal.raise_signal(signal.SIGINT)
        raise BrokenPipeError

    with pytest.raises(KeyboardInterrupt), interrupts_raised():
        whole(Asked)(both).step_wait()


def test_a_process_that_dies_is_an_error_of_one_line_and_the_others_are_ended():
    def dies():
        raise ConnectionResetError

    environments = whole(Asked)(dies)
    with pytest.raises(EnvironmentDiedError, match="a process of the environments died"):
        environments.step_wait()
    environments.close()

    assert environments.terminated


def test_an_interrupt_between_two_questions_is_raised_at_once():
    did = []

    def ask_twice():
        environments = whole(Asked)(lambda: did.append("asked"))
        environments.step_wait()
        signal.raise_signal(signal.SIGINT)
        environments.step_wait()

    with pytest.raises(KeyboardInterrupt), interrupts_raised():
        ask_twice()

    assert did == ["asked"]


def test_real_processes_answer_and_end_after_an_interrupt_in_the_middle(sb3):
    environments = whole(sb3.SubprocVecEnv)([partial(gym.make, "CartPole-v1")] * 2, start_method="forkserver")
    first = environments.remotes[0]
    answer = first.recv

    def interrupted():
        signal.raise_signal(signal.SIGINT)
        return answer()

    environments.reset()
    first.recv = interrupted
    with pytest.raises(KeyboardInterrupt), interrupts_raised():
        environments.step(np.zeros(2, int))
    first.recv = answer
    assert not any(remote.poll(0.2) for remote in environments.remotes)  # no answer is left over
    observations, *_ = environments.step(np.ones(2, int))
    environments.close()

    assert observations.shape == (2, 4)
    assert [process.exitcode for process in environments.processes] == [0, 0]


@pytest.mark.parametrize("which", [0, 1])
def test_whichever_real_process_dies_the_others_end_at_once(sb3, which):
    makers = [partial(Mortal, i == which) for i in range(2)]
    environments = whole(sb3.SubprocVecEnv)(makers, start_method="forkserver")
    environments.reset()
    with pytest.raises(EnvironmentDiedError, match="a process of the environments died"):
        environments.step(np.zeros((2, 1)))
    environments.close()
    for process in environments.processes:
        process.join(timeout=60)

    assert not any(process.is_alive() for process in environments.processes)
