"""Localizers that fail in every way, and what `Guarded` and `LocalizerWrapper` make of it."""

import sys

import gymnasium as gym
import numpy as np
import pytest

from estimators import ConfigError, ImuSample, LocalizerWrapper, Pose2, PoseEstimate, WheelOdometry
from estimators.localizers import LOCALIZERS, Guarded, RobotCalibration, as_estimator, embedded_localizer


def estimate(stamp, x=0.0, covariance=1e-4, **flags):
    return PoseEstimate(stamp=stamp, pose=(x, 0.0, 0.0), covariance=np.diag([covariance] * 3), **flags)


class Scripted:
    """Answers each reading of the wheels as it is told to: a value, or a function of the stamp."""

    def __init__(self, *script):
        self.script = script
        self.heard = []
        self.reset()

    def reset(self):
        self.heard.clear()

    def update(self, message):
        answer = self.script[len(self.heard) % len(self.script)]
        self.heard.append(message)
        return answer(message.stamp) if callable(answer) else answer


def raises(stamp):
    raise RuntimeError("lost\nmy way")


def tick(i, source="robot/encoders"):
    return WheelOdometry(stamp=0.1 * i, source=source, speeds=[0.0, 0.0])


@pytest.mark.parametrize(
    ("bad", "reason", "words"),
    [
        (raises, "raised", "RuntimeError: lost my way"),
        (lambda t: sys.exit("enough"), "raised", "SystemExit: enough"),
        (lambda t: estimate(t, x=float("nan")), "not finite", "nan"),
        (lambda t: estimate(t, covariance=float("inf")), "not finite", "inf"),
        (lambda t: estimate(float("nan")), "not finite", "stamp"),
        (lambda t: (1.0, 2.0, 3.0), "malformed", "tuple"),
        (lambda t: estimate(t, covariance=-1e-4), "malformed", "negative"),
        (lambda t: estimate(t, x=1e200), "malformed", "a position of 1e+200"),
        (lambda t: estimate(t - 0.05), "backwards in time", "0.15 s after 0.2"),
        (lambda t: estimate(t + 1.0), "ahead of time", "1.2"),
    ],
)
def test_what_a_localizer_does_wrong_is_named_and_counted_and_the_run_goes_on(bad, reason, words):
    if reason == "backwards in time":
        script = [estimate, estimate, estimate, lambda t: estimate(0.15), estimate]
    else:
        script = [estimate, estimate, bad, bad, estimate]
    guarded = Guarded(Scripted(*script), "mine")
    valid = [guarded.update(tick(i)).valid for i in range(5)]

    assert valid[:2] == [True, True]
    assert valid[4]
    assert sum(guarded.failures.values()) == guarded.failures[reason] == valid.count(False)
    (line,) = guarded.problems
    assert line.startswith(f"mine: {reason}, ")
    assert words in line
    assert "\n" not in line


def test_while_it_fails_the_last_good_answer_is_kept_and_invalid():
    guarded = Guarded(Scripted(lambda t: estimate(t, x=5.0), raises))
    guarded.update(tick(0))
    said = guarded.update(tick(1))

    assert (said.pose.x, said.stamp, said.valid, said.yaw_valid) == (5.0, 0.0, False, False)
    assert guarded.estimate is said


def test_an_answer_that_is_late_is_counted_unless_it_calls_itself_invalid():
    late = Guarded(Scripted(lambda t: estimate(0.0)), latest=0.25)
    honest = Guarded(Scripted(lambda t: estimate(0.0, valid=False, yaw_valid=False)), latest=0.25)
    for i in range(6):
        late.update(tick(i)), honest.update(tick(i))

    assert late.failures == {"late": 3}  # at 0.3, 0.4 and 0.5 s
    assert not honest.failures


def test_a_reset_forgets_what_went_wrong_and_one_that_raises_is_counted():
    class Broken:
        def __init__(self, answer):
            self.update = answer

        def reset(self):
            raise ValueError("no")

    guarded = Guarded(Scripted(raises))
    guarded.update(tick(0))
    guarded.reset()
    assert not guarded.failures
    assert not guarded.estimate.valid

    broken = Guarded(Broken(estimate))
    broken.reset()
    assert broken.failures == {"raised": 1}
    assert "ValueError: no" in broken.problems[0]


def test_it_hears_the_robot_only_and_what_it_takes_is_measured():
    scripted = Scripted(None)
    guarded = Guarded(scripted)
    for source in ("station/lrf", "robot/encoders", "robot-2/encoders", "truth"):
        assert guarded.update(tick(0, source)) is None

    assert [m.source for m in scripted.heard] == ["robot/encoders"]
    assert guarded.updates == 1
    assert guarded.seconds > 0


def test_everything_that_can_localize_is_taken():
    thing = Scripted(estimate)
    assert as_estimator(thing) is thing
    assert isinstance(as_estimator(lambda: Scripted(estimate)), Scripted)

    class Own:
        def reset(self): ...

        def update(self, message):
            return None

    assert isinstance(as_estimator(Own), Own)
    function = as_estimator(lambda message: (1.0, 2.0, 3.0))
    said = function.update(tick(3))
    assert (said.stamp, *said.pose) == pytest.approx((0.3, 1.0, 2.0, 3.0))
    assert said.covariance[0, 0] == 1e6  # it states none
    assert as_estimator(lambda message: None).update(tick(0)) is None


@pytest.mark.parametrize("thing", [42, "mcl", object(), lambda: 3, Scripted.update.__class__])
def test_what_cannot_localize_is_refused(thing):
    with pytest.raises(ConfigError, match="localizer"):
        as_estimator(thing)


@pytest.mark.parametrize("name", LOCALIZERS)
def test_every_localizer_has_a_name_and_needs_a_start_but_one(thesis_room, name):
    made = embedded_localizer(name, RobotCalibration(), thesis_room, Pose2(y=2.0))

    assert as_estimator(made) is made
    assert made.update(ImuSample(stamp=0.0, yaw_rate=0.0)) is None
    if name == "mcl":
        embedded_localizer(name, RobotCalibration(), thesis_room, None)
    else:
        with pytest.raises(ConfigError, match=f"'{name}' needs a start pose"):
            embedded_localizer(name, RobotCalibration(), thesis_room, None)


def test_a_name_that_no_localizer_has_is_refused(thesis_room):
    with pytest.raises(ConfigError, match=r"'amcl'.*odometry.*mcl"):
        embedded_localizer("amcl", RobotCalibration(), thesis_room, Pose2())


class Arena(gym.Env):
    """Steps of 0.1 s straight ahead at 0.45 m/s, no simulator."""

    observation_space = gym.spaces.Box(0, 1, (1,), np.float64)
    action_space = gym.spaces.Box(-1, 1, (2,), np.float64)

    def __init__(self, room):
        self.believed_robot, self.believed_map = RobotCalibration(), room
        self.shown = []

    def reset(self, *, seed=None, options=None):
        super().reset(seed=seed)
        self.n, self.x0 = 0, (options or {}).get("x", 0.0)
        return self._now()

    def step(self, action):
        self.n += 1
        obs, info = self._now()
        return obs, 0.0, False, False, info

    def _now(self):
        self.measurements = (
            tick(self.n, "station/lrf"),
            WheelOdometry(stamp=0.1 * self.n, speeds=[10.0, 10.0]),
        )
        return np.zeros(1), {"true_pose": np.array([self.x0 + 0.045 * self.n, 2.0, 0.0]), "t": 0.1 * self.n}

    def show_estimate(self, name, said):
        self.shown.append((name, said))


def test_the_wrapper_says_what_the_localizer_says_in_the_form_of_the_ground_truth(thesis_room):
    env = LocalizerWrapper(Arena(thesis_room), "wheels", "odometry")
    for x in (0.0, 1.5):  # told anew where it starts
        _, info = env.reset(options={"x": x})
        assert info["wheels"]["pose"] == pytest.approx([x, 2.0, 0.0])
        for _ in range(10):
            *_, info = env.step(np.zeros(2))
        assert info["wheels"]["pose"] == pytest.approx(info["true_pose"])
        assert info["wheels"]["stamp"] == pytest.approx(1.0)
        assert set(info["wheels"]) == {"pose", "covariance", "stamp", "valid", "yaw_valid"}
        assert info["wheels"]["covariance"].shape == (3, 3)
    assert env.unwrapped.shown[-1][0] == "wheels"


def test_the_wrapper_carries_on_whatever_happens_and_wrappers_stack(thesis_room):
    inner = LocalizerWrapper(Arena(thesis_room), "bad", Scripted(estimate, raises))
    env = LocalizerWrapper(inner, "good", lambda message: (0.0, 0.0, 0.0))
    env.reset()
    infos = [env.step(np.zeros(2))[-1] for _ in range(6)]

    assert [i["bad"]["valid"] for i in infos] == [False, True] * 3
    assert all(i["good"]["valid"] for i in infos)
    assert inner.estimator.failures == {"raised": 3}
    with pytest.raises(ConfigError, match="'bad'"):
        LocalizerWrapper(env, "bad", "odometry")
    with pytest.raises(ConfigError, match="localizer"):
        LocalizerWrapper(env, "other", 42)
