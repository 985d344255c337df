"""Reading a program tells what will go wrong and what a person should look at, line by line."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from chatrobot.language.data_files import load_table
from chatrobot.programs import check as check_module
from chatrobot.programs.check import MAX_SOURCE_CHARS, check
from chatrobot.robots.load import load_profile
from tests.programs.replies import NODE

PROFILE = load_profile("wheeltec_mini_mec")


def codes(source: str) -> list[tuple[str, int]]:
    return [(mark.reason.code, mark.line) for mark in check(source, PROFILE).marks]


def test_a_plain_program_has_nothing_to_look_at() -> None:
    assert codes(NODE) == []


def test_a_syntax_error_refuses_it_with_its_line() -> None:
    found = check(NODE.replace("def go(self):", "def go(self)"), PROFILE).refusal
    assert found is not None
    assert (found.reason.code, found.line) == ("program_syntax", 11)


@pytest.mark.parametrize(
    "module", ["socket", "subprocess", "ctypes", "urllib.request", "cyclonedds", "requests"]
)
def test_what_reaches_out_of_a_program_refuses_it(module: str) -> None:
    found = check(f"import time\nimport {module}\n", PROFILE).refusal
    assert found is not None
    assert (found.reason.code, found.line) == ("import_forbidden", 2)


@pytest.mark.parametrize(
    "module", ["cv2", "tf2_ros", "nav2_simple_commander", "rclpy.magic", "geometry_msgs.srv", "geometry_msg"]
)
def test_what_is_not_there_refuses_it(module: str) -> None:
    found = check(f"import {module}\n", PROFILE).refusal
    assert found is not None
    assert found.reason.code == "import_unknown"


@pytest.mark.parametrize(
    ("line", "code"),
    [
        ("eval('1')", "runs_text"),
        ("__import__('x')", "runs_text"),
        ("os.system('ls')", "runs_commands"),
        ("os.execv('/bin/sh', [])", "runs_commands"),
        ("open('/etc/passwd')", "touches_files"),
        ("().__class__.__subclasses__()", "looks_inside"),
        ("os._exit(1)", "leaves_at_once"),
        ("twist.linear.x = 1", "float_field"),
        ("twist.angular.z = -0", "float_field"),
        ("twist.linear.x = 3.5", "beyond_limit"),
        ("twist.angular.z = -2.5", "beyond_limit"),
        ("pub = node.create_publisher(Twist, '/turtle1/cmd_vel', 10)", "other_topic"),
        ("pub = node.create_publisher(TwistStamped, 'cmd_vel', 10)", "other_type"),
    ],
)
def test_risky_lines_are_marked_with_their_numbers(line: str, code: str) -> None:
    assert (code, 3) in codes(f"import os\n\n{line}\n")


def test_another_robots_topic_is_noticed_and_the_remap_offered() -> None:
    checked = check(NODE.replace("'cmd_vel'", "'/turtle1/cmd_vel'"), PROFILE)
    assert checked.remap == (("/turtle1/cmd_vel", "cmd_vel"),)
    assert checked.refusal is None


def test_the_robots_own_topic_may_have_a_slash() -> None:
    assert check(NODE.replace("'cmd_vel'", "'/cmd_vel'"), PROFILE).remap == ()


def test_the_robots_topic_is_its_profiles() -> None:
    wiring = replace(PROFILE.wiring, cmd_vel_topic="turtle1/cmd_vel")
    profile = replace(PROFILE, wiring=wiring)
    assert check(NODE, profile).remap == (("cmd_vel", "turtle1/cmd_vel"),)


def test_a_forgotten_init_is_noticed() -> None:
    assert ("no_init", 0) in codes(NODE.replace("rclpy.init(args=args)", "pass"))


def test_an_endless_loop_is_noticed() -> None:
    assert ("endless_loop", 1) in codes("while True:\n    node.publisher.publish(t)\n")


def test_a_book_is_no_program() -> None:
    found = check("#" * (MAX_SOURCE_CHARS + 1), PROFILE).refusal
    assert found is not None
    assert found.reason.code == "program_too_long"


def test_nesting_beyond_reason_is_refused_and_harms_nobody() -> None:
    assert check("(" * 5000 + ")" * 5000, PROFILE).refusal is not None
    assert check("x = " + "-" * 5000 + "1", PROFILE) is not None


@given(st.text(max_size=200) | st.text("()[]{}:=.\n ifwhletrydfc\\'\"#1\0", max_size=200))
def test_any_text_at_all_can_be_checked(source: str) -> None:
    check(source, PROFILE)


@pytest.mark.parametrize("language", ["en", "zh"])
def test_every_mark_is_a_sentence(language: str) -> None:
    source = Path(check_module.__file__).read_text(encoding="utf-8")
    said = {*re.findall(r'Reason\("(\w+)"', source), *check_module._RISKY_CALLS.values()}
    assert said <= set(load_table(language, "outcomes"))
