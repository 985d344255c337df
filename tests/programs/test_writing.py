"""A plan becomes a program that a person would write, and that does what the plan would."""

from __future__ import annotations

import ast
import math
import re
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import chatrobot.robots
from chatrobot.core.geometry import ORIGIN, Pose, wrap_angle
from chatrobot.governor.kernel import make_kernel
from chatrobot.motion.programs.rehearsal import ProgramRehearsal, rehearse_program
from chatrobot.plan.context import Impossible
from chatrobot.plan.rehearsal import rehearse
from chatrobot.plan.route import GridRoutePlanner
from chatrobot.plan.steps import Drive, Go, Repeat, Step, Wait
from chatrobot.plan.text import parse_plan
from chatrobot.programs.check import check
from chatrobot.programs.writing.program import Wanted, class_name, folded, node_name, write_program
from chatrobot.robots.load import load_profile
from chatrobot.sandbox.warm_server import WarmServer
from chatrobot.sim.load import load_world
from chatrobot.sim.world import EMPTY_WORLD, World

PROFILE = load_profile("wheeltec_mini_mec")
PROFILES = sorted(path.stem for path in (Path(chatrobot.robots.__file__).parent / "profiles").glob("*.toml"))


def written(
    plan_text: str, profile_name: str = "wheeltec_mini_mec", world: World = EMPTY_WORLD, **wanted: object
) -> str:
    profile = load_profile(profile_name)
    routes = None if world.is_empty else GridRoutePlanner(world, profile)
    source = write_program(
        parse_plan(plan_text),
        profile,
        Wanted("test", routes=routes, **wanted),  # type: ignore[arg-type]
    )
    assert isinstance(source, str)
    return source


def driven(server: WarmServer, source: str, world: World = EMPTY_WORLD) -> ProgramRehearsal:
    return rehearse_program(server, source, PROFILE, world, horizon_s=120.0)


PLANS = {
    "straight on": "drive 1 m",
    "back, and to the left": "drive 50 cm back\ndrive 50 cm left",
    "for a time": "drive 2 s at 0.2 m/s",
    "any way": "drive 60 cm toward 30 deg",
    "turns": "turn left 90 deg\nturn right 2 s at 0.5 rad/s",
    "an arc": "arc left 180 deg radius 0.5 m",
    "an arc backwards": "arc back right 90 deg radius 0.4 m at 0.2 m/s",
    "raw velocities": "twist 0.2 0 0.5 for 3 s\ntwist 0 0 0 for 1 s\ntwist 0 0.1 0 for 2 s",
    "a square": "repeat 4\n  drive 40 cm\n  turn left 90 deg\nend",
    "blocks in blocks": "repeat 2\n  drive 20 cm\n  repeat 2\n    turn left 45 deg\n  end\nend",
    "to points": "go to 0.8 0.4\ngo to 0 0 facing 0 deg",
    "to points from the start": "drive 30 cm\ngo to 0 0.5 from start\nface 90 deg from start",
    "words and waiting": 'say "it\'s \\"me\\""\nwait 1 s\ndrive 20 cm\nremember "dock"',
}  # fmt: skip


@pytest.mark.parametrize("plan_text", PLANS.values(), ids=PLANS.keys())
def test_the_program_ends_where_the_plan_does(server: WarmServer, plan_text: str) -> None:
    planned = rehearse(parse_plan(plan_text), PROFILE, None, ORIGIN, make_kernel(PROFILE)).end_pose
    found = driven(server, written(plan_text))
    assert found.ok, found.traceback
    end = Pose(*(float(value) for value in found.path[-1, 1:]))
    assert end.distance_to(planned) < 0.05
    assert wrap_angle(end.yaw_rad - planned.yaw_rad) == pytest.approx(0.0, abs=0.06)
    assert found.stopped_at_end


def test_it_drives_on_until_something_is_near(server: WarmServer) -> None:
    world = load_world("home")
    found = driven(server, written("drive forward until obstacle within 0.6 m", world=world), world)
    assert found.ok, (found.traceback, found.findings)
    assert found.length_m > 0.2
    end = Pose(*(float(value) for value in found.path[-1, 1:]))
    front = end.compose(Pose(max(x for x, _ in PROFILE.footprint)))
    steps = [front.compose(Pose(0.01 * count)) for count in range(300)]
    clearances_m = world.clearance_m(np.array([(at.x_m, at.y_m) for at in steps]))
    ahead_m = 0.01 * int(np.argmax(clearances_m <= 0.01))
    assert ahead_m == pytest.approx(0.55, abs=0.12)


def test_it_goes_to_a_place_around_what_is_known(server: WarmServer) -> None:
    world = load_world("home")
    kitchen = world.places["kitchen"]
    source = written(f'go to {kitchen.x_m} {kitchen.y_m} named "kitchen"', world=world)
    assert source.count("self.go_to(") >= 2
    assert "# to kitchen" in source
    found = driven(server, source, world)
    assert found.ok, (found.traceback, found.findings)
    assert math.hypot(found.path[-1, 1] - kitchen.x_m, found.path[-1, 2] - kitchen.y_m) < 0.2


EVERYTHING = """\
drive 1 m at 0.1 m/s
turn left 90 deg
arc left 90 deg radius 0.8 m at 0.1 m/s
twist 0.1 0 0.1 for 1 s
wait 1 s
repeat 2
  drive 10 cm
end
say "x"
remember "y"
"""


@pytest.mark.parametrize("profile_name", PROFILES)
def test_for_every_robot_it_is_a_clean_program_or_a_reason(profile_name: str) -> None:
    profile = load_profile(profile_name)
    lines = [
        line
        for line in EVERYTHING.splitlines(keepends=True)
        if profile.can_turn_on_the_spot or "turn" not in line
    ]
    source = write_program(parse_plan("".join(lines)), profile, Wanted("test"))
    assert isinstance(source, str)
    checked = check(source, profile)
    assert [mark.reason.code for mark in checked.marks if mark.severity != "note"] == []
    assert checked.remap == ()
    assert profile.wiring.cmd_vel_topic in source


@pytest.mark.parametrize("plan_text", [*PLANS.values(), EVERYTHING])
def test_every_number_of_a_velocity_is_a_float(plan_text: str) -> None:
    tree = ast.parse(written(plan_text))
    calls = [node for node in ast.walk(tree) if isinstance(node, ast.Call)]
    values = [
        kw.value for call in calls for kw in call.keywords if kw.arg in ("linear_x", "linear_y", "angular_z")
    ]
    assert all(not (isinstance(v, ast.Constant) and isinstance(v.value, int)) for v in values)


def test_it_reads_as_a_person_writes_it() -> None:
    source = written("repeat 4\n  twist 0.2 0 0 for 3 s\n  twist 0 0 1 for 2 s\nend", topic="/cmd_vel")
    assert "for _ in range(4):\n            self.move(linear_x=0.2, seconds=3.0)" in source
    assert "self.create_publisher(Twist, '/cmd_vel', 10)" in source
    assert max(len(line) for line in source.splitlines()) <= 110
    assert "    finally:\n        node.stop()" in source


def test_what_is_said_several_times_becomes_a_loop() -> None:
    source = written("drive 1 m\n" + "drive 40 cm\nturn left 90 deg\n" * 4 + "go to 1 1\ngo to 1 1")
    assert source.count("for _ in range(4):") == 1
    assert source.count("0.4 / 0.3") == 1
    assert source.count("self.go_to(1.0, 1.0") == 2


@given(st.lists(st.sampled_from([Wait(1.0), Wait(2.0), Drive(1.0), Go(1.0, 0.0)]), min_size=1, max_size=12))
def test_folded_steps_are_the_same_steps(steps: list[Step]) -> None:
    unfolded: list[Step] = []
    for step in folded(steps):
        unfolded += list(step.steps) * step.count if isinstance(step, Repeat) else [step]
    assert unfolded == steps


def test_time_sleep_is_used_where_it_was_asked_for() -> None:
    source = written("go to 1 0", uses_sleep=True)
    assert "time.sleep(" in re.split(r"def pause", source)[1].split("def ")[0]


def test_what_this_robot_cannot_do_is_not_written() -> None:
    profile = load_profile("wheeltec_mini_akm")
    found = write_program(parse_plan("turn left 90 deg"), profile, Wanted("test"))
    assert isinstance(found, Impossible)
    assert found.reason.code == "cannot_turn_on_the_spot"


@pytest.mark.parametrize(
    "sentence", ['"""\nimport os\n"""', "\\", 'ends with a quote"', "'''", '\\"""', "é 方块", "x" * 5000]
)
def test_no_sentence_breaks_out_of_the_docstring(sentence: str) -> None:
    tree = ast.parse(written("drive 1 m", sentence=sentence))
    assert isinstance(tree.body[0], ast.Expr)
    assert "os" not in {
        alias.name for node in ast.walk(tree) if isinstance(node, ast.Import) for alias in node.names
    }


@pytest.mark.parametrize(
    ("name", "node", "cls"),
    [("square dance", "square_dance", "SquareDance"), ("方块舞", "program", "Program"),
     ("2 laps", "program_2_laps", "Program2Laps"), ("node", "node", "NodeNode"), ("class", "class_node", "ClassNode")],
)  # fmt: skip
def test_names_are_what_ros_and_python_take(name: str, node: str, cls: str) -> None:
    assert (node_name(name), class_name(name)) == (node, cls)
