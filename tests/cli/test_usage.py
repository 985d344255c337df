"""Wrong usage is told in a sentence, with what is allowed, and exits with 2."""

from __future__ import annotations

import pytest

from chatrobot.cli.arguments import COMMANDS, parse
from chatrobot.core.errors import UsageError
from chatrobot.options import DEFAULT_ROBOT
from chatrobot.robots.load import DEFAULT_PROFILE
from tests.cli.running import Command


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["do"], "TEXT"),
        (["do", "hi", "--nonsense"], "--nonsense"),
        (["forward 1 m"], 'chatrobot do "forward 1 m'),
        (["do", "hi", "--interpreter", "psychic"], "auto"),
        (["do", "hi", "--interpreter", "model"], "--model PROVIDER:NAME"),
        (["do", "hi", "--model", "clippy:95"], "openai"),
        (["do", "hi", "--rounds", "0"], "above zero"),
        (["do", "hi", "-p", "fast:=True"], "revChatGPT:=True"),
        (["do", "hi", "--on", "mars"], "sim"),
        (["do", "hi", "--fast", "--robot", "r2d2"], "wheeltec_mini_mec"),
        (["do", "hi", "--fast", "--world", "mars"], "home"),
        (["do", "hi", "--fast", "--sim", "slip=lots"], "share"),
        (["do", "hi", "--fast", "--sim", "colour=red"], "latency_s"),
        (["do", "hi", "--fast", "--robot", "no/such.toml"], "no/such.toml"),
        (["plan", "hi", "--png", "way.jpg"], ".png"),
        (["eval", "no-such-file.yaml"], "no-such-file.yaml"),
        (["eval"], "FILE"),
        (["sim", "--world", "mars"], "home"),
        (["Do", "hi"], "did you mean chatrobot do?"),
        (["completion"], "bash|zsh|fish"),
        (["do", "hi", "--yes", "--approve"], "--yes --approve: either of both"),
        (["do", "hi", "--record", "a.txt"], "a.txt: a recording's name ends in .mcap"),
        (["do", "--record", "a.txt", "hi"], "--record FILE.mcap"),
        (["do", "hi", "--fast", "there", "-q"], "-q"),
    ],
)
def test_wrong_usage_names_what_is_allowed(chatrobot: Command, arguments: list[str], said: str) -> None:
    done = chatrobot(*arguments)
    assert done.code == 2
    assert said in done.err
    assert done.out == ""


def test_help_lists_every_command(chatrobot: Command) -> None:
    done = chatrobot("--help")
    assert done.code == 0
    for name in COMMANDS:
        assert f"\n    {name} " in done.out


@pytest.mark.parametrize("name", list(COMMANDS))
def test_every_command_explains_itself(chatrobot: Command, name: str) -> None:
    done = chatrobot(name, "--help")
    assert done.code == 0
    assert f"chatrobot {name}" in done.out


def test_options_may_stand_before_or_after_the_command() -> None:
    before = parse(["--fast", "--world", "empty", "do", "forward 1 m"])
    after = parse(["do", "forward 1 m", "--fast", "--world", "empty"])
    assert before == after
    assert before.fast
    assert parse(["do", "stop"]).fast is False


def test_texts_may_stand_on_both_sides_of_an_option() -> None:
    parsed = parse(["do", "forward 1 m", "--fast", "turn left", "--world", "empty", "- back 1 m"])
    assert parsed.texts == ["forward 1 m", "turn left", "- back 1 m"]
    assert (parsed.fast, parsed.world) == (True, "empty")


def test_a_text_may_begin_with_a_dash() -> None:
    assert parse(["do", "--fast", "--", "-20 cm"]).texts == ["-20 cm"]
    assert parse(["do", "- forward"]).texts == ["- forward"]


def test_options_are_not_abbreviated() -> None:
    with pytest.raises(UsageError):
        parse(["do", "hi", "--fas"])


def test_the_default_robot_of_the_help_is_the_default_robot() -> None:
    assert DEFAULT_ROBOT == DEFAULT_PROFILE
