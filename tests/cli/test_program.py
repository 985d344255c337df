"""`chatrobot program …` as other programs run it."""

from __future__ import annotations

from pathlib import Path

import pytest

from chatrobot.programs.library import AGENT, KeptProgram, Library, Provenance
from tests.cli.running import Command
from tests.programs.requests import ROTATION, SQUARE
from tests.programs.scripted_model import program

FAST = ("--fast", "--world", "empty")


@pytest.fixture
def library(tmp_path: Path) -> Library:
    """What the command keeps."""
    return Library(tmp_path / "config" / "chatrobot")


@pytest.mark.parametrize(
    ("request_text", "turned_rad", "seconds"),
    [(ROTATION, 3.0, 7.0), (SQUARE, 8.0, 21.0)],
    ids=["rotation", "square"],
)
def test_the_tutorials_requests_word_for_word(
    chatrobot: Command, library: Library, request_text: str, turned_rad: float, seconds: float
) -> None:
    done = chatrobot("program", "new", request_text, "--yes", "--json", "--trace", *FAST)
    assert done.code == 0, done.err
    names = [event["event"] for event in done.events if event["event"] not in ("pose", "progress")]
    assert names == ["interpreted", "program_written", "program_rehearsed", "rehearsed", "started", "result"]
    assert done.named("result")[0]["turned_rad"] == pytest.approx(turned_rad, abs=0.03)
    assert done.named("rehearsed")[0]["duration_s"] == pytest.approx(seconds, abs=0.1)
    assert done.named("pose")[-1]["wz_radps"] == 0.0
    assert len(library.names()) == 1


def test_what_rehearsal_finds_is_refused_where_nobody_can_be_asked(
    chatrobot: Command, tmp_path: Path
) -> None:
    file = tmp_path / "rude.py"
    file.write_text(program("self.drive(0.2, 0.0, 0.5)\nreturn"), encoding="utf-8")
    done = chatrobot("program", "run", str(file), *FAST)
    assert done.code == 4
    assert "--yes" in done.err
    assert chatrobot("program", "run", str(file), "--yes", *FAST).code == 0


def test_a_traceback_is_shown_with_the_line(chatrobot: Command, tmp_path: Path) -> None:
    file = tmp_path / "broken.py"
    file.write_text(program("self.drvie(0.2)"), encoding="utf-8")
    done = chatrobot("program", "run", str(file), *FAST)
    assert done.code == 4
    assert "drvie" in done.out
    assert "AttributeError" in done.out


def test_listed_shown_edited_renamed_exported_and_removed(
    chatrobot: Command, library: Library, tmp_path: Path
) -> None:
    library.keep(KeptProgram("square dance", program("self.drive(0.2, 0.0, 1.0)")))
    assert chatrobot("program", "list", "--json").named("program")[0]["name"] == "square dance"
    assert "self.drive(0.2, 0.0, 1.0)" in chatrobot("program", "show", "square dance").out
    new = tmp_path / "new.py"
    new.write_text(program("self.drive(0.1, 0.0, 1.0)"), encoding="utf-8")
    assert chatrobot("program", "edit", "square dance", "--file", str(new)).code == 0
    assert "self.drive(0.1" in Library(tmp_path / "config" / "chatrobot").get("square dance").source
    renamed = chatrobot("program", "rename", "Square dance", "../waltz")
    assert (renamed.code, renamed.out) == (0, "Renamed “square dance” to “waltz”.\n")
    folder = tmp_path / "ws"
    assert chatrobot("program", "export", "waltz", str(folder)).code == 0
    assert (folder / "src" / "waltz" / "package.xml").exists()
    assert chatrobot("program", "remove", "waltz").code == 0
    assert Library(tmp_path / "config" / "chatrobot").names() == ()


def test_a_program_of_an_agent_says_so_in_the_list_and_in_json(chatrobot: Command, library: Library) -> None:
    library.keep(KeptProgram("spin", program("return"), provenance=Provenance("", "model", AGENT)))
    assert chatrobot("program", "list").out.split() == ["spin", "agent"]
    (told,) = chatrobot("program", "list", "--json").named("program")
    assert (told["by"], told["model"]) == ("agent", "")
    library.edit("spin", program("pass"))
    assert chatrobot("program", "list").out.split() == ["spin", "person"]


def test_an_edit_that_is_no_python_leaves_the_kept_source_as_it_was(
    chatrobot: Command, library: Library, tmp_path: Path
) -> None:
    source = program("self.drive(0.2, 0.0, 1.0)")
    library.keep(KeptProgram("waltz", source))
    bad = tmp_path / "bad.py"
    bad.write_text("print(1)\nprint(2", encoding="utf-8")
    done = chatrobot("program", "edit", "waltz", "--file", str(bad))
    assert (done.code, done.out) == (2, "")
    assert f"{bad}: Line 2 is not valid Python: '(' was never closed" in done.err
    bad.write_text("# nothing is left\n", encoding="utf-8")
    assert "The program is empty" in chatrobot("program", "edit", "waltz", "--file", str(bad)).err
    assert Library(tmp_path / "config" / "chatrobot").get("waltz").source == source


def test_without_a_terminal_an_edit_asks_for_a_file_and_starts_no_editor(
    chatrobot: Command, library: Library
) -> None:
    library.keep(KeptProgram("waltz", program("self.drive(0.2, 0.0, 1.0)")))
    done = chatrobot("program", "edit", "waltz")
    assert (done.code, "needs a terminal (chatrobot program edit waltz --file FILE.py)" in done.err) == (
        2,
        True,
    )


@pytest.mark.parametrize("name", ["stop", "Emergency stop!", "halt an", "停", "pause"])
def test_no_program_is_named_by_a_stop(chatrobot: Command, library: Library, name: str) -> None:
    done = chatrobot("program", "new", "forward 1 m", "--name", name, *FAST)
    assert (done.code, "cannot be the name of a program" in done.out) == (4, True)
    library.keep(KeptProgram("waltz", program("self.drive(0.2, 0.0, 1.0)")))
    done = chatrobot("program", "rename", "waltz", name)
    assert (done.code, "cannot be the name of a program" in done.err) == (2, True)
    assert Library(chatrobot.folder / "config" / "chatrobot").names() == ("waltz",)


def test_a_name_that_is_taken_gets_a_number_and_that_is_said(chatrobot: Command, library: Library) -> None:
    library.keep(KeptProgram("far", program("self.drive(0.2, 0.0, 1.0)")))
    done = chatrobot("program", "new", "forward 10 cm", "--name", "far", "--yes", *FAST)
    assert "There is a program “far” already, so this one is kept as “far 2”." in done.out
    assert chatrobot("program", "rename", "far", "far").out == "“far” has that name already.\n"


@pytest.mark.parametrize(
    "arguments",
    [("program",), ("program", "rename", "x"), ("program", "run", "/no/such.py")],
)
def test_wrong_usage_is_one_sentence(chatrobot: Command, arguments: tuple[str, ...]) -> None:
    done = chatrobot(*arguments)
    assert done.code in (1, 2)
    assert done.err.count("\n") == 1


ARGUED = """
import sys, time
import rclpy
from geometry_msgs.msg import Twist

rclpy.init()
node = rclpy.create_node("driver")
speed = node.declare_parameter("speed", 0.2).value
publisher = node.create_publisher(Twist, "velocity", 10)
twist = Twist()
twist.linear.x = speed
publisher.publish(twist)
time.sleep(2.0)
publisher.publish(Twist())
node.get_logger().info(f"{node.get_name()} {sys.argv[1:2]}")
rclpy.shutdown()
"""
ROS_ARGS = ("--ros-args", "-p", "speed:=0.35", "-r", "velocity:=/cmd_vel", "-r", "__node:=x")


@pytest.mark.parametrize("is_kept", [True, False], ids=["kept", "file"])
def test_a_program_gets_arguments_as_of_ros2_run(
    chatrobot: Command, library: Library, tmp_path: Path, is_kept: bool
) -> None:
    library.keep(KeptProgram("dash", ARGUED))
    file = tmp_path / "dash.py"
    file.write_text(ARGUED, encoding="utf-8")
    name = "dash" if is_kept else str(file)
    done = chatrobot("program", "run", name, "--json", *FAST, "--", "first", *ROS_ARGS)
    assert done.code == 0, done.err
    assert done.named("result")[0]["path_m"] == pytest.approx(0.7, abs=0.02)
    assert "[x] x ['first']" in done.named("program_log")[0]["text"]
    assert not done.named("program_written")[0]["marks"]  # where it is led was said: nothing to agree to


def test_a_parameter_file_is_read_for_the_program(chatrobot: Command, tmp_path: Path) -> None:
    (tmp_path / "dash.py").write_text(ARGUED, encoding="utf-8")
    parameters = tmp_path / "parameters.yaml"
    parameters.write_text(
        "driver:\n  ros__parameters:\n    speed: 0.1\n    a: {b: [x, y]}\n", encoding="utf-8"
    )
    done = chatrobot(
        "program", "run", str(tmp_path / "dash.py"), "--json", *FAST,
        "--", "--ros-args", "--params-file", str(parameters), "-r", "velocity:=/cmd_vel",
    )  # fmt: skip
    assert done.named("result")[0]["path_m"] == pytest.approx(0.2, abs=0.02)


@pytest.mark.parametrize(
    "arguments",
    [
        ("run", "x.py", "--ros-args", "-p", "a:=1"),
        ("run", "x.py", "--", "--ros-args", "-p", "a"),
        ("run", "x.py", "--", "--ros-args", "--params-file", "/no/such.yaml"),
        ("list", "--", "a"),
    ],
)
def test_arguments_that_cannot_be_given_are_one_sentence(
    chatrobot: Command, arguments: tuple[str, ...]
) -> None:
    done = chatrobot("program", *arguments)
    assert done.code == 2
    assert done.err.count("\n") == 1


def test_plan_rehearses_a_kept_program_and_runs_nothing(chatrobot: Command, tmp_path: Path) -> None:
    folder = ("--config-dir", str(tmp_path))
    made = chatrobot("program", "new", "drive forward 0.6 m at 0.3 m/s", "--name", "dash", "--fast", *folder)
    assert made.code == 0
    planned = chatrobot("plan", "run dash", "--json", *folder)
    assert planned.code == 0
    rehearsed = next(event for event in planned.events if event["event"] == "rehearsed")
    assert rehearsed["length_m"] == pytest.approx(0.6, abs=0.01)
    assert planned.events[-1]["path_m"] == 0.0
    assert not any(event["event"] == "started" for event in planned.events)
