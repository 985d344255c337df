"""A program is rehearsed in lock step with a simulated robot, and its rehearsal says what it would do."""

from __future__ import annotations

import math
from textwrap import dedent

import pytest

from chatrobot.core.geometry import ORIGIN, Pose
from chatrobot.motion.programs.rehearsal import ProgramRehearsal, rehearse_program
from chatrobot.robots.load import load_profile
from chatrobot.sandbox.warm_server import WarmServer
from chatrobot.sim.load import load_world

MEC = load_profile("wheeltec_mini_mec")


def rehearse(
    server: WarmServer, body: str, world: str = "empty", robot: str = "", start: Pose = ORIGIN, **more: float
) -> ProgramRehearsal:
    """Of a script that has a node and a publisher `pub` already."""
    head = """
    import rclpy, time
    from geometry_msgs.msg import Twist
    rclpy.init()
    node = rclpy.create_node("test")
    pub = node.create_publisher(Twist, "cmd_vel", 10)
    def go(v, w=0.0):
        twist = Twist()
        twist.linear.x, twist.angular.z = float(v), float(w)
        pub.publish(twist)
    """
    profile = load_profile(robot) if robot else MEC
    return rehearse_program(server, dedent(head) + dedent(body), profile, load_world(world), start, **more)  # type: ignore[arg-type]


def codes(rehearsal: ProgramRehearsal) -> list[str]:
    return [finding.reason.code for finding in rehearsal.findings]


def test_path_duration_and_top_speeds_are_measured(server: WarmServer) -> None:
    rehearsal = rehearse(server, "go(0.2); time.sleep(5); go(0)")
    assert rehearsal.ok
    assert not rehearsal.findings
    assert rehearsal.duration_s == pytest.approx(5.0, abs=0.01)
    assert rehearsal.length_m == pytest.approx(1.0, abs=0.02)
    assert rehearsal.path[-1, 1] == pytest.approx(1.0, abs=0.02)
    assert rehearsal.top_speed_mps == pytest.approx(0.2, abs=0.01)
    assert rehearsal.stopped_at_end


def test_it_begins_where_the_robot_stands(server: WarmServer) -> None:
    rehearsal = rehearse(server, "go(0.2); time.sleep(5); go(0)", start=Pose(2.0, 1.0, math.pi / 2.0))
    assert rehearsal.path[0, 1:].tolist() == [2.0, 1.0, math.pi / 2.0]
    assert rehearsal.path[-1, 1:3].tolist() == pytest.approx([2.0, 2.0], abs=0.02)


def test_a_wall_in_the_way_refuses_it(server: WarmServer) -> None:
    rehearsal = rehearse(server, "go(0.5); time.sleep(20); go(0)", world="home")
    assert rehearsal.refusal is not None
    assert rehearsal.refusal.reason.code == "would_collide"
    assert rehearsal.refusal.reason.values["obstacle"]


def test_what_is_beyond_the_limits_is_limited_and_said(server: WarmServer) -> None:
    rehearsal = rehearse(server, "go(5.0); time.sleep(1); go(0)")
    assert rehearsal.ok
    assert codes(rehearsal) == ["limited"]
    assert rehearsal.top_speed_mps <= MEC.limits.max_speed_mps + 1e-6


def test_a_program_that_ends_in_motion_is_stopped_and_said(server: WarmServer) -> None:
    rehearsal = rehearse(server, "go(0.2); time.sleep(2)")
    assert not rehearsal.stopped_at_end
    assert codes(rehearsal) == ["program_never_stops"]
    assert rehearsal.path[-1, 1] == pytest.approx(0.4, abs=0.02)


def test_an_exception_has_its_line_and_its_traceback(server: WarmServer) -> None:
    rehearsal = rehearse(server, "go(0.2)\ntime.sleep(1)\nprint(1 / 0)")
    assert codes(rehearsal) == ["program_raised", "program_never_stops"]
    assert "ZeroDivisionError: division by zero" in rehearsal.problem
    assert "site-packages" not in rehearsal.problem
    assert rehearsal.line == 13
    assert not rehearsal.ok


@pytest.mark.parametrize(
    "ending",
    [
        "rclpy.shutdown(); rclpy.shutdown()",
        "node.destroy_node(); pub.publish(Twist())",
        "1 / 0",
        "time.sleep(3); {}['x']",
    ],
)
def test_a_program_that_fails_after_its_last_zero_is_offered_with_that(
    server: WarmServer, ending: str
) -> None:
    rehearsal = rehearse(server, f"go(0.2)\ntime.sleep(1)\ngo(0)\n{ending}")
    assert rehearsal.ok
    assert codes(rehearsal) == ["program_raised_at_end"]
    assert rehearsal.findings[0].severity == "warn"
    assert rehearsal.findings[0].reason.values["line"] == 14


@pytest.mark.parametrize(
    "body",
    [
        "go(0)\n1 / 0",
        "1 / 0",
        "go(0.2)\ntime.sleep(1)\n1 / 0",
        "go(0.2)\ntime.sleep(1)\ngo(0)\ngo(0.1)\n1 / 0",
    ],
)
def test_a_program_that_fails_before_it_has_driven_and_stopped_is_refused(
    server: WarmServer, body: str
) -> None:
    rehearsal = rehearse(server, body)
    assert not rehearsal.ok
    assert "program_raised" in codes(rehearsal)


def test_an_endless_program_is_rehearsed_to_the_horizon(server: WarmServer) -> None:
    rehearsal = rehearse(server, "node.create_timer(0.1, lambda: go(0.1))\nrclpy.spin(node)", horizon_s=10.0)
    assert rehearsal.ok
    assert codes(rehearsal) == ["program_endless"]
    assert rehearsal.duration_s == pytest.approx(10.0)
    assert rehearsal.path[-1, 1] == pytest.approx(1.0, abs=0.05)


def test_a_rate_that_nobody_spins_for_waits_for_ever(server: WarmServer) -> None:
    rehearsal = rehearse(
        server, "rate = node.create_rate(10)\nwhile rclpy.ok():\n    go(0.1)\n    rate.sleep()"
    )
    assert "program_waits_for_ever" in codes(rehearsal)


def test_a_busy_loop_without_a_look_at_the_clock_is_ended(server: WarmServer) -> None:
    rehearsal = rehearse(server, "go(0.1)\nwhile True:\n    pass", wall_limit_s=0.5)
    assert codes(rehearsal)[0] == "program_too_busy"
    assert not rehearsal.ok


def test_the_last_velocity_is_held_as_long_as_the_robot_holds_it(server: WarmServer) -> None:
    body = "go(0.1); time.sleep(4); go(0)"
    assert rehearse(server, body).length_m == pytest.approx(0.4, abs=0.02)
    assert rehearse(server, body, robot="turtlebot4").length_m == pytest.approx(0.05, abs=0.02)


@pytest.mark.parametrize(
    ("body", "code"),
    [
        ("import requests", "program_import"),
        ("def f(:\n  pass", "program_syntax"),
        ("open('/etc/passwd').read()", "program_forbidden"),
        ("node.create_publisher(Twist, '/turtle1/cmd_vel', 10)\ngo(1); go(0)", "program_other_topic"),
        ("go(float('nan'))", "program_not_finite"),
        ("import sys; go(1); go(0); sys.exit(3)", "program_exit_code"),
        ("import os; os._exit(0)", "program_vanished"),
        ("t = Twist(); t.linear.z = 1.0; t.linear.x = 0.1; pub.publish(t); go(0)", "program_not_planar"),
    ],
)
def test_what_a_person_should_know_is_found(server: WarmServer, body: str, code: str) -> None:
    assert code in codes(rehearse(server, body))
