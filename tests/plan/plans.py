"""Hypothesis strategies: every plan there can be, or only those that are pleasant to drive."""

from __future__ import annotations

import dataclasses
import math
from typing import Any

from hypothesis import strategies as st

from chatrobot.plan.json_form import VERSION
from chatrobot.plan.steps import (
    Arc,
    Drive,
    Face,
    Go,
    ObstacleWithin,
    Plan,
    RawTwist,
    Remember,
    Repeat,
    Say,
    Step,
    Turn,
    Wait,
)

finite = st.floats(allow_nan=False, allow_infinity=False)
positive = st.floats(min_value=0.0, exclude_min=True, allow_infinity=False)
round_degrees = st.integers(1, 720).map(math.radians)
angles = st.one_of(positive, round_degrees)
directions = st.one_of(finite, st.sampled_from([0.0, math.pi / 2, -math.pi / 2, math.pi, math.pi / 4]))
frames = st.sampled_from(["odom", "start"])
names = st.text(max_size=80).filter(str.isprintable)
untils = st.none() | st.builds(ObstacleWithin, positive)
some = st.none() | positive

drives = st.one_of(
    st.builds(Drive, positive, st.none(), directions, some, untils),
    st.builds(Drive, st.none(), positive, directions, some, untils),
    st.builds(Drive, st.none(), st.none(), directions, some, st.builds(ObstacleWithin, positive)),
)
turns = st.one_of(
    st.builds(Turn, angles, st.none(), st.booleans(), some),
    st.builds(Turn, st.none(), positive, st.booleans(), some),
)
leaves: st.SearchStrategy[Step] = st.one_of(
    drives,
    turns,
    st.builds(Arc, positive, angles, st.booleans(), st.booleans(), some),
    st.builds(RawTwist, finite, finite, finite, positive),
    st.builds(Go, finite, finite, st.none() | finite, frames, names, some),
    st.builds(Face, finite, frames, some),
    st.builds(Wait, st.floats(0.0, 3600.0, exclude_min=True)),
    st.builds(Say, st.text(min_size=1, max_size=150).filter(lambda t: t.isprintable() and bool(t.strip()))),
    st.builds(Remember, names.filter(lambda t: bool(t.strip()))),
)


def blocks(inner: st.SearchStrategy[Step]) -> st.SearchStrategy[Step]:
    return st.builds(Repeat, st.integers(1, 5), st.lists(inner, min_size=1, max_size=3).map(tuple))


steps = st.recursive(leaves, blocks, max_leaves=6)
plans = st.lists(steps, min_size=1, max_size=4).map(lambda found: Plan(tuple(found)))


def plan_to_json(plan: Plan) -> dict[str, Any]:
    """The JSON form, as a tool would write it."""
    return {"version": VERSION, "steps": [_to_json(step) for step in plan.steps]}


def _to_json(value: Any) -> Any:
    if isinstance(value, tuple):
        return [_to_json(item) for item in value]
    if not dataclasses.is_dataclass(value):
        return value
    fields = {f.name: getattr(value, f.name) for f in dataclasses.fields(value)}
    defaults = {f.name: f.default for f in dataclasses.fields(value)}
    left = {name: item for name, item in fields.items() if name != "kind" and item != defaults[name]}
    return {"kind": fields["kind"], **{name: _to_json(item) for name, item in left.items()}}
