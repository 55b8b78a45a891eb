"""A score as `report.json`: millimetres, degrees and milliseconds."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from typing import Any

from benchmarks.report.scores import DEGREES, MM
from benchmarks.scoring.checks import Checked
from benchmarks.scoring.comparison import Comparison
from benchmarks.scoring.quantities import Corrected
from benchmarks.scoring.summary import Score, SubjectSummary
from benchmarks.scoring.verdicts import JUDGED, near, ratio_of_true_error, verdict
from benchmarks.trajectory.offsets import NAMES, Offsets

UNITS = {"position": "mm", "along": "mm", "cross": "mm", "yaw": "deg"}
KEYS = {"position": "ate"}
OF_JUDGED = {"position": ("mm", MM), "yaw": ("deg", DEGREES), "relative": ("mm", MM)}
OFFSET_UNITS = {"clock": ("ms", MM)} | {
    name: ("deg", DEGREES) if name.endswith("yaw") else ("mm", MM) for name in NAMES[1:]
}


def unit_of(quantity: str) -> tuple[str, float]:
    """Unit of a quantity's key, and the factor from metres or radians."""
    angle = quantity.endswith("yaw")
    return ("deg", DEGREES) if angle else ("mm", MM)


def key_of(quantity: str) -> str:
    """How a quantity is called in `report.json`, without its unit: `ate`, `yaw`, `rpe_1m` (also of the yaw)."""
    name = KEYS.get(quantity, quantity)
    return name.removesuffix("_yaw") if name.startswith("rpe_") else name


def report(
    summaries: Sequence[SubjectSummary],
    comparisons: Sequence[Comparison],
    ranks: Mapping[str, int],
    reference: str,
    setup: Mapping[str, Any],
    checks: Mapping[str, Checked],
) -> str:
    """The text of `report.json`; what is not known is null."""
    subjects = {
        s.name: _subject(s, s.by_reference[reference]) | {"rank": ranks.get(s.name)} for s in summaries
    }
    content = {
        "setup": setup,
        "subjects": subjects,
        "comparisons": [_comparison(c) for c in comparisons],
        "checks": {name: _check(of) for name, of in checks.items()},
    }
    return json.dumps(content, indent=2, allow_nan=False) + "\n"


def _subject(s: SubjectSummary, score: Score | None) -> dict[str, Any]:
    said = _score(score) if score is not None else _NOTHING
    return said | {
        "availability": s.availability,
        "latency_ms": None if s.latency is None else {"mean": MM * s.latency[0], "max": MM * s.latency[1]},
        "update_us": None if s.update_time is None else 1e6 * s.update_time,
        "problems": list(s.problems),
        "missing_runs": dict(s.why_not),
        "references": {r: None if of is None else _score(of) for r, of in s.by_reference.items()},
        "paths": {p: None if of is None else _score(of) for p, of in s.by_path.items()},
        "each_run": {run: _run(of) for run, of in s.by_run.items()},
    }


def _run(scores: Mapping[str, Corrected | None]) -> dict[str, Any]:
    """Position and yaw of one run."""
    against: dict[str, dict[str, float | None]] = {"estimate_vs_gt": {}, "estimate_vs_true": {}}
    for quantity, c in scores.items():
        unit, factor = unit_of(quantity)
        values = (None, None) if c is None else (c.value, c.true)
        for pair, value in zip(against, values, strict=True):
            against[pair][f"{key_of(quantity)}_{unit}"] = None if value is None else factor * value
    return against


_NOTHING: dict[str, Any] = {
    "gt_vs_true": None,
    "estimate_vs_gt": None,
    "estimate_vs_true": None,
    "ratios": None,
    "verdicts": None,
    "nees": None,
}


def _score(score: Score) -> dict[str, Any]:
    known = score.true_ratios["position"] is not None
    return {
        "gt_vs_true": _against_truth(score, "gt_true") if known else None,
        "estimate_vs_gt": _against_gt(score),
        "estimate_vs_true": _against_truth(score, "true") | {"nees": score.nees_true} if known else None,
        "ratios": dict(score.ratios),
        "ratio_intervals": {judged: _ratio_interval(score.scores.get(q)) for judged, q in JUDGED.items()},
        "verdicts": score.verdicts,
        "verdicts_near": {judged: near(score.scores.get(q)) for judged, q in JUDGED.items()},
        "ratios_from_truth": dict(score.true_ratios) if known else None,
        "verdicts_from_truth": score.true_verdicts if known else None,
        "verdicts_of_true_error": {
            judged: verdict(ratio_of_true_error(score.scores.get(q))) for judged, q in JUDGED.items()
        }
        if known
        else None,
        "interval_holds": _held(score) if known else None,
        "nees": score.nees,
        "runs": score.runs,
        "offsets": None if score.offsets is None else _offsets(score.offsets),
    }


def _against_gt(score: Score) -> dict[str, Any]:
    found: dict[str, Any] = {}
    for quantity, c in score.scores.items():
        key = key_of(quantity)
        unit, factor = unit_of(quantity)
        found[f"{key}_{unit}"] = None if c is None else factor * c.value
        found[f"{key}_interval_{unit}"] = None if c is None else [factor * v for v in c.interval]
        found[f"{key}_uncorrected_{unit}"] = None if c is None else factor * c.raw
        found[f"{key}_station_{unit}"] = None if c is None else factor * c.stated
        expected = score.expected.get(quantity)
        found[f"{key}_expected_interval_{unit}"] = (
            None if expected is None else [factor * v for v in expected]
        )
    along, cross, yaw = score.offset
    return found | {
        "along_mean_mm": _finite(MM * along),
        "cross_mean_mm": _finite(MM * cross),
        "yaw_mean_deg": _finite(DEGREES * yaw),
        "end_drift_mm": MM * score.end_drift,
        "end_drift_percent": 100 * score.end_drift / score.way if score.way > 0 else None,
    }


def _against_truth(score: Score, which: str) -> dict[str, Any]:
    found = {}
    for quantity, c in score.scores.items():
        unit, factor = unit_of(quantity)
        value = None if c is None else getattr(c, which)
        found[f"{key_of(quantity)}_{unit}"] = None if value is None else factor * value
    return found


def _held(score: Score) -> dict[str, bool | None]:
    """Whether each interval holds what it was against the truth."""
    held: dict[str, bool | None] = {}
    for quantity, c in score.scores.items():
        unit, _ = unit_of(quantity)
        held[f"{key_of(quantity)}_{unit}"] = _covers(c)
    return held


def _ratio_interval(c: Corrected | None) -> list[float] | None:
    """Within which the ratio lies with 95 %, the stated uncertainty being right."""
    return None if c is None or c.stated <= 0 else [end / c.stated for end in c.interval]


def _covers(c: Corrected | None) -> bool | None:
    return None if c is None else c.covers


def _offsets(offsets: Offsets) -> dict[str, Any]:
    found: dict[str, Any] = {}
    for i, name in enumerate(NAMES):
        unit, factor = OFFSET_UNITS[name]
        seen = bool(offsets.observable[i])
        found[f"{name}_{unit}"] = factor * float(offsets.values[i]) if seen else None
        found[f"{name}_error_{unit}"] = factor * float(offsets.errors[i]) if seen else None
    return found | {"not_observable": list(offsets.unseen)}


def _check(of: Checked) -> dict[str, Any]:
    """How the station really erred, and how often a single run's intervals and verdicts were right."""
    position, yaw = of.station
    return {
        "runs": of.runs,
        "variance_over_stated": {"position": _finite(position.ratio), "yaw": _finite(yaw.ratio)},
        "lasts_s": {"position": _finite(position.lasts), "yaw": _finite(yaw.lasts)},
        "intervals_held": of.held,
        "all_intervals_held": of.all_held,
        "verdicts": None if of.agreement is None else asdict(of.agreement),
    }


def _comparison(c: Comparison) -> dict[str, Any]:
    unit, factor = OF_JUDGED[c.what]
    return {
        "first": c.first,
        "second": c.second,
        "what": c.what,
        f"difference_{unit}": factor * c.difference,
        f"interval_{unit}": [factor * v for v in c.interval],
        "of_other_runs": c.of_other_runs,
        "p": c.p,
        "significant": c.significant,
        f"resolvable_{unit}": factor * c.resolvable,
        f"resolvable_by_station_{unit}": factor * c.by_station,
    }


def _finite(value: float) -> float | None:
    return value if value == value else None
