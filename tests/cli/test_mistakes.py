"""What people mistype, and what they are told; in this process, for nothing here begins to drive."""

from __future__ import annotations

import socket
from pathlib import Path

import pytest

from chatrobot.cli.arguments import COMMANDS, parse
from chatrobot.cli.entry import main
from chatrobot.core.errors import UsageError


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["do", "forward", "1", "m"], 'chatrobot do "forward 1 m"'),
        (["do", "go", "to", "the", "kitchen"], 'chatrobot do "go to the kitchen"'),
        (["do", ""], 'chatrobot do "forward 1 m"'),
        (["do", " \t\n\u200b"], 'chatrobot do "forward 1 m"'),
        (["do", "forward 1 m", "", "--fast"], 'chatrobot do "forward 1 m"'),
        (["plan", "　"], 'chatrobot plan "forward 1 m"'),
        (["do", "hi", "--budget-s", "abc"], "'abc' is not a number"),
        (["do", "hi", "--rounds", "1.5"], "'1.5' is not a whole number"),
        (["fake-model", "x.yaml", "--port", "99999"], "0 to 65535"),
        (["model", "key"], "no provider is named"),
        (["world"], "'chatrobot world' needs an action (list, draw, check, new)"),
        (
            ["world", "draw", "home", "--png", "x.png"],
            "does not take --png x.png (see chatrobot world draw --help)",
        ),
        (["do", "hi", "--record", "hi.txt"], "hi.txt: a recording's name ends in .mcap"),
        (["--web", "--class", "3"], "does not take --class 3 (an option of a command stands behind it"),
        (["program", "run", "no-such.py"], "no-such.py: cannot be read"),
        (["model", "list", "--json"], "model list prints no JSON"),
        (["replay", "/dev/null"], "/dev/null: this is not a file"),
    ],
)
def test_wrong_usage_is_told(
    arguments: list[str], said: str, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    assert main(["--config-dir", str(tmp_path), *arguments]) == 2
    assert said in capsys.readouterr().err


@pytest.mark.parametrize(
    "texts",
    [["forward", "again", "undo"], ["forward 1 m", "2", "m"], ["forward", "2"], ["前进", "1", "米"]],
)
def test_the_turns_of_a_dialogue_need_no_quotes(texts: list[str]) -> None:
    assert parse(["do", *texts]).texts == texts


def test_a_wrong_name_of_a_model_is_blamed_on_where_it_stands(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    monkeypatch.setenv("CHATROBOT_MODEL", "clippy:95")
    command = ["do", "hi", "--fast", "--config-dir", str(tmp_path)]
    assert main(command) == 2
    told = capsys.readouterr().err
    assert "CHATROBOT_MODEL: " in told
    assert "“clippy:95”" in told
    assert main([*command, "--model", "eliza"]) == 2
    told = capsys.readouterr().err
    assert "--model: " in told
    assert "“eliza”" in told


def test_where_no_robot_answers_that_is_said_at_once(capsys: pytest.CaptureFixture[str]) -> None:
    with socket.socket() as nobody:
        nobody.bind(("127.0.0.1", 0))
        port = nobody.getsockname()[1]
        assert main(["do", "forward", "--on", f"rosbridge:ws://127.0.0.1:{port}"]) == 1
    assert f"no rosbridge answers at ws://127.0.0.1:{port}" in capsys.readouterr().err


def help_of(capsys: pytest.CaptureFixture[str], *command: str) -> str:
    with pytest.raises(SystemExit):
        parse([*command, "--help"])
    return " ".join(capsys.readouterr().out.split())


def test_help_lists_what_a_command_takes(capsys: pytest.CaptureFixture[str]) -> None:
    assert "--robot" not in help_of(capsys, "stop")
    assert "--trace" not in help_of(capsys, "plan")
    assert "--json" in help_of(capsys, "usage")
    for command in ("", "do", "eval"):
        assert "--robot" in help_of(capsys, *filter(None, [command]))


@pytest.mark.parametrize("command", COMMANDS)
def test_every_option_may_stand_before_every_command(command: str) -> None:
    words = {
        "do": ["x"],
        "plan": ["x"],
        "eval": ["x"],
        "node": ["input"],
        "fake-model": ["x"],
        "report": ["x"],
        "replay": ["x"],
    }
    words["completion"] = ["bash"]
    after = ["list"] if command in ("program", "world") else words.get(command, [])
    assert parse(["--robot", "turtlesim", command, *after]).robot == "turtlesim"
    assert parse([command, *after, "--robot", "turtlesim"]).robot == "turtlesim"


def test_help_is_in_groups_and_the_common_options_come_first(capsys: pytest.CaptureFixture[str]) -> None:
    text = help_of(capsys, "do")
    marks = [
        "options:",
        "--on WHERE",
        "--yes",
        "simulation:",
        "--fast",
        "language model:",
        "--rounds",
        "limits of",
    ]
    assert sorted(marks, key=text.index) == marks
    assert text.startswith("usage: chatrobot do [options] [TEXT ...]")


@pytest.mark.parametrize(
    ("command", "strange"),
    [
        ("doctor", "--on"), ("node", "--fast"), ("eval", "--yes"), ("sim", "--model"), ("program", "--robot"),
        ("robots", "--world"), ("worlds", "--robot"), ("do", "(base)"), ("do", "text in, events out"),
    ],
)  # fmt: skip
def test_help_lists_nothing_that_does_not_apply(
    command: str, strange: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert strange not in help_of(capsys, command)


def test_the_version_has_a_short_option(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        parse(["-V"])
    assert capsys.readouterr().out.startswith("chatrobot 0.")


def test_an_unknown_program_action_is_wrong_usage() -> None:
    with pytest.raises(UsageError):
        parse(["program", "frob"])
