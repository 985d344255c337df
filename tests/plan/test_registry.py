from __future__ import annotations

import importlib.metadata
from collections.abc import Iterator

import pytest

from chatrobot.core.errors import UsageError
from chatrobot.plan import primitive as registry
from chatrobot.plan.context import LoweringContext
from chatrobot.plan.json_form import plan_from_json, plan_schema
from chatrobot.plan.lowering import CoreWalk, PlannedMotion
from chatrobot.plan.steps import Plan
from chatrobot.plan.text import format_plan, parse_plan
from tests.plan.plans import plan_to_json
from tests.plan.robots import MECANUM
from tests.saved.packages.acme_robots.wiggle import PRIMITIVE, Wiggle, WigglePrimitive


class _EntryPoint:
    def load(self) -> WigglePrimitive:
        return PRIMITIVE


@pytest.fixture
def third_party(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    monkeypatch.setattr(
        importlib.metadata,
        "entry_points",
        lambda group: [_EntryPoint()] * (group == registry.ENTRY_POINT_GROUP),
    )
    registry.primitives()
    registry._loaded.discard(registry.ENTRY_POINT_GROUP)
    yield
    registry.unregister(PRIMITIVE)


@pytest.mark.usefixtures("third_party")
def test_a_third_partys_primitive_is_found_everywhere() -> None:
    plan = parse_plan("wiggle 3")
    assert plan == Plan((Wiggle(3),))
    assert format_plan(plan) == "wiggle 3"
    assert plan_from_json(plan_to_json(plan)) == plan
    assert "Wiggle" in plan_schema()["$defs"]
    items = list(CoreWalk(plan, LoweringContext(MECANUM)))
    assert len(items) == 6
    assert all(isinstance(item, PlannedMotion) for item in items)


def test_two_primitives_cannot_share_a_verb() -> None:
    class Impostor(WigglePrimitive):
        kind = "impostor"
        verb = "drive"

    registry.primitives()
    with pytest.raises(UsageError, match="drive"):
        registry.register(Impostor())


def test_a_step_nobody_registered_is_an_error() -> None:
    with pytest.raises(UsageError, match="Wiggle"):
        registry.for_step(Wiggle())


def test_the_built_ins_are_all_there() -> None:
    kinds = {primitive.kind for primitive in registry.primitives()}
    assert kinds >= {"drive", "turn", "arc", "twist", "go", "face", "wait", "say", "remember", "repeat"}
