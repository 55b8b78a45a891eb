"""What is said of a recording that does not fit what is believed of its station."""

from types import SimpleNamespace

import pytest

from benchmarks.calibration.of_recording import CalibrationRun


@pytest.mark.parametrize(
    ("residuals", "frames", "sightings", "said"),
    [
        ({"walls": 1.0, "columns": 0.7, "corners": 1.0}, 30, 30, []),
        ({"walls": 1.0}, 0, 0, []),
        ({"walls": 2.5}, 0, 0, ["The walls fit 2.5 times worse"]),
        (
            {"walls": 1.0, "columns": 1.4, "widths": 1.8},
            30,
            9,
            ["The target and the corners in the image fit 1.8 times"],
        ),
        ({"walls": 1.0}, 30, 0, ["None of the 30 frames shows the target"]),
    ],
)
def test_what_does_not_fit_is_said(residuals, frames, sightings, said):
    found = SimpleNamespace(
        solution=SimpleNamespace(residuals=residuals), evidence=SimpleNamespace(sightings=range(sightings))
    )
    recording = SimpleNamespace(messages=SimpleNamespace(frame_count=frames))
    run = CalibrationRun(recording=recording, believed=None, found=found, true=None)

    assert len(run.misfits) == len(said)
    for whole, start in zip(run.misfits, said, strict=True):
        assert whole.startswith(start)
