from __future__ import annotations

import json
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from chatrobot.core.errors import PlanTextError
from chatrobot.plan.json_form import VERSION, plan_from_json, plan_schema
from chatrobot.plan.primitive import primitives
from chatrobot.plan.steps import Drive, Plan
from tests.plan.plans import plan_to_json, plans


@given(plans)
def test_every_valid_plan_survives_its_json_exactly(plan: Plan) -> None:
    data = plan_to_json(plan)
    assert data["version"] == VERSION
    assert plan_from_json(json.dumps(data)) == plan
    assert plan_from_json(data) == plan


def test_what_is_default_is_left_out() -> None:
    assert plan_to_json(Plan((Drive(distance_m=1.5),)))["steps"] == [{"kind": "drive", "distance_m": 1.5}]


@pytest.mark.parametrize(
    ("steps", "where"),
    [
        ([{"kind": "drive", "distance_m": "1"}], "steps[0].distance_m"),
        ([{"kind": "drive", "distance_m": True}], "steps[0].distance_m"),
        ([{"kind": "drive", "distance_m": float("nan")}], "steps[0].distance_m"),
        ([{"kind": "drive", "distance_m": 10**400}], "steps[0].distance_m"),
        ([{"kind": "drive"}], "steps[0]: "),
        ([{"kind": "wait", "duration_s": 1}, {"kind": "turn", "angle_rad": 1, "left": 1}], "steps[1].left"),
        ([{"kind": "drive", "distance_m": 1, "colour": 2}], "steps[0].colour"),
        ([{"kind": "drive", "until": {"distance_m": -1}}], "steps[0].until"),
        ([{"kind": "hop"}], "steps[0].kind"),
        ([{"kind": ["drive"]}], "steps[0].kind"),
        ([3], "steps[0]"),
        ([], "steps: "),
        ({}, "steps: "),
        (None, "steps: "),
        ([{"kind": "repeat", "count": 2, "steps": [{"kind": "say", "text": ""}]}], "steps[0].steps[0]"),
        ([{"kind": "repeat", "count": 2.5, "steps": [{"kind": "say", "text": "a"}]}], "steps[0].count"),
        ([{"kind": "repeat", "count": 2}], "steps[0].steps"),
        ([{"kind": "wait", "duration_s": 1}] * 1001, "steps: "),
    ],
)
def test_a_mistake_names_its_field(steps: Any, where: str) -> None:
    with pytest.raises(PlanTextError) as caught:
        plan_from_json({"steps": steps})
    assert where in str(caught.value)


@pytest.mark.parametrize(
    "data",
    ["", "{", "[]", "3", "[" * 5000, '{"plan": []}', '{"version": "chatrobot-plan/2", "steps": []}', b"\xff"],
)
def test_what_is_no_plan_is_refused(data: str | bytes) -> None:
    with pytest.raises(PlanTextError):
        plan_from_json(data)


def test_blocks_nested_without_end_are_refused() -> None:
    data: dict[str, Any] = {"kind": "wait", "duration_s": 1}
    for _ in range(200):
        data = {"kind": "repeat", "count": 1, "steps": [data]}
    with pytest.raises(PlanTextError, match="nested"):
        plan_from_json({"steps": [data]})


json_values = st.recursive(
    st.none() | st.booleans() | st.floats() | st.integers() | st.text(max_size=5),
    lambda inner: (
        st.lists(inner, max_size=3) | st.dictionaries(st.sampled_from(["kind", "steps", "count"]), inner)
    ),
    max_leaves=8,
)


@given(
    st.dictionaries(st.sampled_from(["version", "steps"]), json_values), st.sampled_from(["drive", "repeat"])
)
def test_any_json_is_a_plan_or_a_plan_text_error(data: dict[str, Any], kind: str) -> None:
    for candidate in (data, {"steps": [{"kind": kind, **data}]}):
        try:
            plan_from_json(candidate)
        except PlanTextError:
            continue


def test_the_schema_knows_every_primitive_and_its_version() -> None:
    schema = plan_schema()
    assert schema["$id"] == VERSION
    assert schema["properties"]["version"] == {"const": VERSION}
    for primitive in primitives():
        assert schema["$defs"][primitive.step_type.__name__]["properties"]["kind"]["const"] == primitive.kind
    references = set(_references(schema))
    assert references <= {f"#/$defs/{name}" for name in schema["$defs"]}
    assert len(schema["$defs"]["Step"]["oneOf"]) == len(primitives())


def _references(node: Any) -> list[str]:
    if isinstance(node, dict):
        own = [node["$ref"]] if "$ref" in node else []
        return own + [ref for value in node.values() for ref in _references(value)]
    return [ref for item in node for ref in _references(item)] if isinstance(node, list) else []
