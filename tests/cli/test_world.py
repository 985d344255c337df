"""`chatrobot world`: a world is begun, looked at, checked and mended as a teacher does it."""

from __future__ import annotations

import json
import shlex
from pathlib import Path
from xml.etree import ElementTree

import pytest
from PIL import Image

from chatrobot.cli.entry import main
from chatrobot.sim.load import load_world, world_names

Output = pytest.CaptureFixture[str]


@pytest.fixture
def world(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A new world, as `world new` writes it."""
    monkeypatch.chdir(tmp_path)
    assert main(["world", "new", "room.yaml"]) == 0
    return tmp_path / "room.yaml"


def checked(capsys: Output, *more: str) -> tuple[int, str]:
    capsys.readouterr()
    code = main(["world", "check", "room.yaml", *more])
    return code, capsys.readouterr().out


@pytest.mark.usefixtures("world")
def test_a_new_world_is_fine_and_can_be_driven(capsys: Output) -> None:
    code, told = checked(capsys)
    assert code == 0
    assert "3 places, each reached from the start" in told
    assert main(["do", "go to the door", "--world", "room.yaml", "--fast"]) == 0


def test_the_commands_that_a_new_world_names_can_be_pasted(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Output
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["world", "new", "Bob's room: $1.yaml"]) == 0
    _, check, _ = (line for line in capsys.readouterr().out.splitlines() if line.startswith("  "))
    assert main(shlex.split(check)[1:]) == 0
    assert load_world("./Bob's room: $1.yaml").name == "Bob's room: $1"


def test_a_file_that_is_there_is_not_written_over(world: Path, capsys: Output) -> None:
    world.write_text("mine", encoding="utf-8")
    assert main(["world", "new", "room.yaml"]) == 2
    assert "is there already" in capsys.readouterr().err
    assert world.read_text(encoding="utf-8") == "mine"


MISTAKES = {
    "aliases: [桌子, 桌边]": ("alias: [桌子]", "line 27: places[0].alias: unknown field (did you mean aliases?"),
    "radius_m: 0.2": ("radius_m: small", "line 21: obstacles[5].circle.radius_m: 'small' is not a number"),
    "length_m: 1.2, ": ("", "line 20: obstacles[4].rectangle: length_m is missing"),
    "[4.2, 0.05]]": ("[4.2]]", "line 22: obstacles[6].polygon[2]: a point has two numbers, not 1 ([x, y])"),
    "radius_m: 0.2}": ("radius_m: 0,2}", "line 21: obstacles[5].circle.2: unknown field (a number has a decimal point"),
    "name: room": ("name: 'room", "line 5: is not YAML: found unexpected end of stream (each quotation mark closed)"),
    "name: corner": ("name: DOOR", "line 29: places[2].name: 'DOOR' names the place 'door' already (each name once"),
    "name: plant": ("name: '" + 81 * "x" + "'", "has 81 characters (80 at most)"),
    "start: {x_m: 1.0,": ("start：{x_m: 1.0,", "is not YAML"),
    "  - {name: plant": ("\t- {name: plant", "spaces to indent, no tabs"),
    "x_m: 3.2, y_m: 1.6": ("x_m: 3.4, y_m: 2.6", "line 27: the place 'table' lies in the table (0.22 m of room"),
    "x_m: 0.7, y_m: 2.0": ("x_m: 0.15, y_m: 2.0", "line 28: the place 'door' is 0.09 m from the west wall"),
    "x_m: 4.4, y_m: 3.5": ("x_m: 6.4, y_m: 3.5", "line 29: the place 'corner' lies outside allowed_area"),
    "x_m: 1.0, y_m: 1.0, yaw_deg: 0": ("x_m: 0.1, y_m: 1.0", "line 8: the start of the world 'room' lies in"),
    "{name: corner,": ("{name: '!?',", "line 29: “go to the !?” is not understood"),
    "radius_m: 0.2}}": (
        "radius_m: 0.2}}\n  - {name: fence, wall: {from: [4, 0], to: [4, 4], thickness_m: 0.05}}",
        "there is no way from the start to the place 'corner'",
    ),
}  # fmt: skip


@pytest.mark.parametrize("before", MISTAKES)
def test_a_mistake_is_told_by_its_line_with_what_is_allowed(world: Path, capsys: Output, before: str) -> None:
    after, said = MISTAKES[before]
    text = world.read_text(encoding="utf-8")
    assert before in text
    world.write_text(text.replace(before, after), encoding="utf-8")
    code, told = checked(capsys)
    assert code == 1
    assert said in told
    assert "room.yaml, line " in told


def test_problems_come_as_json_lines(world: Path, capsys: Output) -> None:
    code, told = checked(capsys, "--json")
    assert (code, json.loads(told)["places"]) == (0, ["table", "door", "corner"])
    world.write_text(
        world.read_text(encoding="utf-8").replace("x_m: 3.2, y_m: 1.6", "x_m: 3.4, y_m: 2.6"),
        encoding="utf-8",
    )
    code, told = checked(capsys, "--json")
    problem = json.loads(told)
    assert (code, problem["event"], problem["where"]) == (1, "problem", "room.yaml, line 27")
    assert problem["problem"] == "the place 'table' lies in the table"
    assert problem["allowed"].startswith("0.22 m of room")


@pytest.mark.usefixtures("world")
def test_a_robot_that_is_too_large_is_told_which_room_it_needs(capsys: Output) -> None:
    code, told = checked(capsys, "--robot", "turtlesim")
    assert code == 1
    assert "0.76 m of room to every side" in told


def test_a_world_is_drawn_as_svg_as_png_and_in_the_terminal(world: Path, capsys: Output) -> None:
    assert main(["world", "draw", "room.yaml", "room.svg"]) == 0
    drawn = ElementTree.parse(world.with_suffix(".svg")).iter()
    texts = {element.text for element in drawn if element.tag.endswith("text")}
    assert {"room", "table", "door", "ramp"} <= texts
    assert main(["world", "draw", "home", "home.png"]) == 0
    with Image.open(world.with_name("home.png")) as picture:
        assert len(picture.convert("RGB").getcolors(1 << 20) or ()) > 20
    capsys.readouterr()
    assert main(["world", "draw", "maze"]) == 0
    told = capsys.readouterr().out
    assert "treasure" in told
    assert "→" in told
    assert main(["world", "draw", "maze", "maze.jpg"]) == 2


def test_the_list_names_every_world_and_a_misspelt_one_gets_the_nearest(capsys: Output) -> None:
    assert main(["world", "list"]) == 0
    told = capsys.readouterr().out
    assert all(f"{name} " in told for name in world_names())
    for action in ("check", "draw"):
        assert main(["world", action, "clasroom"]) == 2
        told = capsys.readouterr()
        assert (told.out, told.err.startswith("chatrobot: there is no world named 'clasroom'")) == ("", True)
        assert "did you mean classroom?" in told.err
