from __future__ import annotations

import importlib.metadata
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

import pytest

from chatrobot.core.errors import UsageError
from chatrobot.core.geometry import Twist
from chatrobot.plan import primitive as registry
from chatrobot.plan.base import Step
from chatrobot.plan.context import Lowered, LoweringContext
from chatrobot.plan.json_form import plan_from_json, plan_schema
from chatrobot.plan.lowering import CoreWalk, PlannedMotion
from chatrobot.plan.primitive import Primitive
from chatrobot.plan.reader import LineReader
from chatrobot.plan.steps import Plan
from chatrobot.plan.text import format_plan, parse_plan
from chatrobot.plan.trajectory import RampedTwist
from tests.plan.plans import plan_to_json
from tests.plan.robots import MECANUM


@dataclass(frozen=True)
class Wiggle(Step):
    """A third party's step."""

    times: int = 2
    kind: Literal["wiggle"] = "wiggle"


class WigglePrimitive(Primitive[Wiggle]):
    kind = verb = "wiggle"
    step_type = Wiggle
    usage = "wiggle COUNT"
    help = "Wag to both sides."
    examples = ("wiggle 3",)

    def parse(self, line: LineReader) -> Wiggle:
        return Wiggle(line.whole_number("a count"))

    def format(self, step: Wiggle) -> str:
        return f"wiggle {step.times}"

    def lower(self, step: Wiggle, context: LoweringContext) -> Lowered:
        sides = (Twist(0, 0, 0.5), Twist(0, 0, -0.5))
        return [RampedTwist.within(context.profile.limits, side, 0.4) for side in sides * step.times]


WIGGLE = WigglePrimitive()


class _EntryPoint:
    def load(self) -> WigglePrimitive:
        return WIGGLE


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
    registry.unregister(WIGGLE)


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
