"""The spoilt station, and a recording of it that `gt-env calibrate` can read."""

import numpy as np
import pytest

from benchmarks.calibration.spoilt_station import PLANTED, THINNER, driven, planted, save
from benchmarks.recording import read_recording
from estimators.self_calibration.quantities import Q, values_of
from gt_env.config import load_config


@pytest.mark.parametrize("preset", ["thesis", "narrow", "sick_lms101"])
def test_the_station_is_spoilt_and_does_not_know_it(preset):
    config = load_config(preset)
    spoilt = planted(config)
    before = values_of(config.believed().calibration())
    assert values_of(spoilt.believed().calibration()) == pytest.approx(before)
    error = values_of(spoilt.calibration()) - before
    assert error[Q.RANGE_BIAS] == pytest.approx(PLANTED["lrf.range_bias"])
    assert error[Q.PAN_OFFSET] == pytest.approx(np.radians(PLANTED["pan.offset_deg"]))
    assert error[Q.RADIUS] == pytest.approx((THINNER - 1) * before[Q.RADIUS])


def test_a_recording_can_be_kept(tmp_path):
    config = load_config(planted(load_config("thesis")), {"camera.enabled": False})
    recording = driven(config, "wide-eight", 3.0, 1000)
    save(recording, tmp_path / "kept.mcap", config)
    kept = read_recording(tmp_path / "kept.mcap")
    assert len(kept.messages) == len(recording.messages)
    assert np.allclose(kept.truth, recording.truth, atol=1e-9)
    assert values_of(kept.config.calibration()) == pytest.approx(values_of(config.calibration()))
    # Two seeds start from two places, about where the path starts.
    other = driven(config, "wide-eight", 3.0, 1001)
    apart = np.abs(other.truth[0, 1:3] - recording.truth[0, 1:3]).max()
    assert 0 < apart < 0.2
