"""The measurements as JSON."""

from __future__ import annotations

import json
import math
from dataclasses import asdict

from studies.chart.contestant import Series
from studies.chart.findings import MESHES, agreement, backing, modes, on_the_front, ratios
from studies.chart.scale import TURN_LIMIT_DEG
from studies.chart.study import Study


def document(study: Study) -> str:
    """Everything measured; times in s, lengths in the pair's unit, angles in deg; what is no number is null."""
    front = {id(one) for one in on_the_front(study)}
    value = {
        "pair": study.pair.designation,
        "unit": study.pair.unit.value,
        "turn_limit_deg": TURN_LIMIT_DEG,
        "poses": [pose for pose, _ in study.truth[: study.scale.poses]],
        "contestants": [
            {
                "series": one.run.contestant.series.value,
                "label": one.run.contestant.label,
                "triangles": one.run.triangles,
                "setup_s": one.run.setup_s,
                "on_front": id(one) in front,
                **asdict(one.score),
                "failure_modes": {mode.name.lower(): count for mode, count in modes(one, study).items()},
                "seconds_by_pose": one.run.seconds,
            }
            for one in study.measured
        ],
        "ratios": {
            "meshes": [asdict(one) for one in ratios(study, MESHES)],
            "curves": [asdict(one) for one in ratios(study, (Series.CURVES,))],
        },
        "agreement": asdict(agreement(study)),
        "backing": asdict(backing(study)),
        "scenes": [asdict(cost) for cost in study.costs],
    }
    return json.dumps(_without_nan(value), indent=1, allow_nan=False) + "\n"


def _without_nan(value: object) -> object:
    if isinstance(value, dict):
        return {key: _without_nan(part) for key, part in value.items()}
    if isinstance(value, list | tuple):
        return [_without_nan(part) for part in value]
    return None if isinstance(value, float) and math.isnan(value) else value
