"""The promises of a robot profile and of a primitive, as tests: inherit the class and name yours."""

from __future__ import annotations

import math
import pickle
from dataclasses import fields
from typing import ClassVar

import pytest

from chatrobot.api import connect
from chatrobot.core.events import Event, Rehearsed
from chatrobot.plan.primitive import AnyPrimitive, for_verb
from chatrobot.plan.steps import Drive, Plan
from chatrobot.plan.text import format_plan, parse_plan
from chatrobot.robots.load import DEFAULT_PROFILE, load_profile
from chatrobot.robots.parse import OPTIONAL_LIMITS
from chatrobot.robots.profile import Limits, RobotProfile
from chatrobot.testing.rig import Rig


class ProfileContract:
    """Inherited by a test class that names its `robot`, or has a fixture `profile`."""

    robot: ClassVar[str] = DEFAULT_PROFILE
    """A profile's name, or its .toml file."""

    @pytest.fixture
    def profile(self) -> RobotProfile:
        """Load the profile under test."""
        return load_profile(self.robot)

    def test_every_limit_says_where_it_comes_from(self, profile: RobotProfile) -> None:
        assert {field.name for field in fields(Limits)} - OPTIONAL_LIMITS <= profile.sources.keys()
        assert all(len(source) > 5 for source in profile.sources.values())

    def test_what_is_meant_without_numbers_is_within_the_limits(self, profile: RobotProfile) -> None:
        assert 0 < profile.defaults.speed_mps <= profile.limits.max_speed_mps
        assert 0 < profile.defaults.rate_radps <= profile.limits.max_rate_radps
        assert profile.defaults.distance_m > 0
        assert 0 < profile.defaults.turn_rad <= 2 * math.pi

    def test_it_can_brake_from_its_default_speed_within_half_a_metre(self, profile: RobotProfile) -> None:
        v, limits = profile.defaults.speed_mps, profile.limits
        assert v * limits.latency_s + v * v / (2 * limits.deceleration_mps2) < 0.5

    def test_it_goes_only_where_its_wheels_can(self, profile: RobotProfile) -> None:
        assert profile.can_go_sideways == (profile.limits.max_sideways_mps > 0)
        assert profile.can_turn_on_the_spot == (profile.limits.min_turning_radius_m == 0)

    def test_its_footprint_holds_its_centre(self, profile: RobotProfile) -> None:
        for axis in range(2):
            assert min(p[axis] for p in profile.footprint) < 0 < max(p[axis] for p in profile.footprint)
        assert 0.05 < profile.footprint_radius_m < 5

    def test_a_scanner_comes_with_a_topic_and_the_other_way_round(self, profile: RobotProfile) -> None:
        assert (profile.lidar is None) == (profile.wiring.scan_topic is None)

    def test_a_person_approves_plans_unless_the_caller_decides_otherwise(self, profile: RobotProfile) -> None:
        assert profile.approval == "plan"

    def test_it_can_be_handed_to_another_process(self, profile: RobotProfile) -> None:
        assert pickle.loads(pickle.dumps(profile)) == profile

    def test_half_a_metre_is_half_a_metre(self, profile: RobotProfile) -> None:
        if not profile.has_odometry:
            pytest.skip("nobody measures how far it goes")
        rig = Rig(profile)
        assert rig.run(Plan((Drive(distance_m=0.5),))).outcome == "completed"
        assert abs(rig.robot.true_pose.x_m - 0.5) < 0.02


class PrimitiveContract:
    """Inherited by a test class that names its `primitive`; its `examples` are run on `robot` in the empty world."""

    primitive: AnyPrimitive
    robot: ClassVar[str] = DEFAULT_PROFILE

    def test_plan_text_finds_it_by_its_verb(self) -> None:
        assert for_verb(self.primitive.verb) is self.primitive, "it is not registered: name its entry point"

    def test_its_examples_are_read_and_written(self) -> None:
        for text in self.primitive.examples:
            plan = parse_plan(text)
            assert any(isinstance(step, self.primitive.step_type) for step in plan.steps)
            assert parse_plan(format_plan(plan)) == plan

    def test_an_example_ends_where_its_rehearsal_said(self) -> None:
        events: list[Event] = []
        for text in self.primitive.examples:
            with connect(fast=True, robot=self.robot, world="empty") as robot:
                robot.on_event(events.append)
                result = robot.run(text)
            assert result.outcome == "completed", result.reply
            ends = [event.end for event in events if isinstance(event, Rehearsed)]
            assert result.pose is not None
            assert result.pose.distance_to(ends[-1]) < 0.03
