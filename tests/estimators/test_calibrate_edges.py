"""Beams that just meet the target or just miss it: what they say, and which of them are asked."""

import dataclasses

import numpy as np
import pytest
from scipy.stats import norm

from estimators import Pose2
from estimators.self_calibration.edges import Edges, edge_rows, find_edges
from estimators.self_calibration.places import Places, scans_of
from estimators.self_calibration.quantities import Q, values_of
from estimators.self_calibration.sightings import Sightings
from estimators.self_calibration.track import Knots

FUZZ = 4e-4


def way(times):
    return np.column_stack([-0.8 + 0.5 * times, 2.0 + 0.2 * np.sin(2 * times)])


def curve():
    knots = Knots.over(0.0, 3.0)
    return knots, way(knots.times())


def beams_near(values, rng):
    """Beams within 1 mm of the target's edges, met as chance has it."""
    knots, track = curve()
    stamps = np.sort(rng.uniform(0.0, 3.0, 60))
    pose = Pose2(x=values[Q.LRF_X], y=values[Q.LRF_Y], yaw=values[Q.LRF_YAW])
    local = pose.inverse().apply(knots.at(track, stamps))
    edge = values[Q.RADIUS] + rng.uniform(-1e-3, 1e-3, 60)
    side = rng.choice([-1.0, 1.0], 60)
    bearings = np.arctan2(local[:, 1], local[:, 0]) + side * np.arcsin(edge / np.hypot(*local.T))
    return Edges(stamps, bearings, rng.random(60) < 0.5, np.empty(0, bool))


def surprise(edges, values, knots, track):
    """Negative log-likelihood of a probit of how far inside the edge beams pass."""
    away = knots.at(track, edges.stamps) - values[[Q.LRF_X, Q.LRF_Y]]
    bearings = edges.bearings + values[Q.LRF_YAW]
    past = np.cos(bearings) * away[:, 1] - np.sin(bearings) * away[:, 0]
    inside = (values[Q.RADIUS] - np.abs(past)) / FUZZ
    return -norm.logcdf(np.where(edges.hit, inside, -inside)).sum()


def test_their_scores_are_the_gradient_of_the_likelihood(calibration):
    values = values_of(calibration)
    values[[Q.LRF_X, Q.LRF_Y, Q.LRF_YAW]] = 0.02, -0.01, 0.009
    knots, track = curve()
    edges = beams_near(values, np.random.default_rng(3))
    rows = edge_rows(edges, values, knots, track, FUZZ)
    gradient = rows.by_quantity.T @ rows.residual
    step = 1e-7
    for i in Q:
        up, down = values.copy(), values.copy()
        up[i] += step
        down[i] -= step
        slope = (surprise(edges, up, knots, track) - surprise(edges, down, knots, track)) / (2 * step)
        assert gradient[i] == pytest.approx(slope, rel=1e-4, abs=1e-2), i.name
    by_track = rows.by_track.T @ rows.residual
    for place in (20, 31):
        up, down = track.copy(), track.copy()
        up.flat[place] += step
        down.flat[place] -= step
        slope = (surprise(edges, values, knots, up) - surprise(edges, values, knots, down)) / (2 * step)
        assert by_track[place] == pytest.approx(slope, rel=1e-4, abs=1e-2)


def seen(calibration, ideal_scan, times):
    """Scans, places and frames of a target on its way, and its track."""
    knots, track = curve()
    points = knots.at(track, times)
    scans = [
        ideal_scan(calibration, tuple(p), stamp=t)
        for p, t in zip(points.tolist(), times.tolist(), strict=True)
    ]
    n = len(times)
    places = Places(
        times, points, np.tile(1e-6 * np.eye(2), (n, 1, 1)), np.ones(n), np.zeros(n), values_of(calibration)
    )
    frames = Sightings(times, np.zeros(n), np.zeros(n), np.ones(n), np.zeros(n))
    return scans, places, frames, knots, track


def test_beams_beside_the_edges_are_asked_and_told_apart(calibration, ideal_scan):
    scans, places, frames, knots, track = seen(calibration, ideal_scan, np.arange(1, 29) / 10)
    edges = find_edges(scans, calibration, places, frames, knots, track)
    away = knots.at(track, edges.stamps)
    past = np.cos(edges.bearings) * away[:, 1] - np.sin(edges.bearings) * away[:, 0]
    assert len(edges) > 28
    assert np.array_equal(edges.hit, np.abs(past) < calibration.target.radius)
    assert np.abs(np.abs(past) - calibration.target.radius).max() < 0.01
    assert edges.places.all()


def test_without_frames_or_while_it_rests_they_say_nothing_new(calibration, ideal_scan):
    scans, places, frames, knots, track = seen(calibration, ideal_scan, np.arange(1, 29) / 10)
    assert not len(find_edges(scans, calibration, places, Sightings.none(), knots, track))
    resting = np.tile(track[5], (len(track), 1))
    scans = [dataclasses.replace(scans[0], stamp=s.stamp) for s in scans]
    once = find_edges(scans, calibration, places, frames, knots, resting)
    assert len(np.unique(once.stamps)) <= 1


@pytest.mark.parametrize("into_the_sweep", [0.0, 0.03])
def test_a_place_is_of_the_scan_that_was_under_way(calibration, ideal_scan, into_the_sweep):
    times = np.arange(1, 9) / 10
    scans, places, *_ = seen(calibration, ideal_scan, times)
    some = [0, 3, 7]
    later = dataclasses.replace(
        places, stamps=places.stamps[some] + into_the_sweep, points=places.points[some]
    )
    assert scans_of(scans[::-1], later) == [scans[i] for i in some]
