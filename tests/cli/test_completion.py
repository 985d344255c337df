"""Tab in a shell: commands, options and what may stand behind them, in bash, zsh and fish as they are installed."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pexpect
import pytest

from chatrobot.cli.arguments import COMMANDS, SHELLS, parse
from chatrobot.cli.completion import FILES, FOLDERS, offers_for
from chatrobot.cli.entry import main
from chatrobot.options import OPTIONS
from chatrobot.robots.load import list_profiles

PATIENCE_S = 30.0
SCRIPTS = Path(sys.executable).parent


def words(*line: str) -> list[str]:
    return [offer.word for offer in offers_for(line)]


def test_every_command_is_offered_with_what_it_does() -> None:
    assert dict(offers_for([""])) == COMMANDS
    assert words("wo") == ["world", "worlds"]


def test_a_commands_own_options_are_offered_and_no_others() -> None:
    assert {"--keep-going", "--fast", "--help"} <= set(words("do", "--"))
    assert words("stop", "--") == ["--help"]
    assert "--fast" not in words("doctor", "-")
    assert "--name" in words("program", "new", "x", "--")


@pytest.mark.parametrize("before", [["do", "--robot"], ["--robot"], ["do", "x", "--robot", "="]])
def test_robots_are_offered_by_name(before: list[str]) -> None:
    assert words(*before, "")[1:] == [entry.name for entry in list_profiles()]
    assert words(*before, "turtles")[1:] == ["turtlesim"]


def test_an_option_and_its_value_may_be_one_word() -> None:
    assert words("do", "--world=h")[1:] == ["--world=home"]
    assert words("do", "--interpreter=o") == ["--interpreter=offline"]


def test_robots_and_programs_of_the_persons_own_are_offered(tmp_path: Path) -> None:
    (tmp_path / "robots").mkdir()
    built_in = next(entry.file for entry in list_profiles() if entry.name == "turtlesim")
    shutil.copy(built_in, tmp_path / "robots" / "mine.toml")
    assert "mine" in words("--config-dir", str(tmp_path), "plan", "--robot", "m")


@pytest.mark.parametrize(
    ("line", "offered"),
    [
        (["eval", ""], [(":files", ".yaml .yml")]),
        (["eval", "a.yaml", ""], [(":files", ".yaml .yml")]),
        (["plan", "x", "--png", ""], [(":files", ".png")]),
        (["replay", ""], [(":files", ".mcap")]),
        (["do", "--plan", ""], [FILES]),
        (["--config-dir", ""], [FOLDERS]),
        (["program", "run", "square", "--", ""], [FILES]),
        (["do", ""], []),
        (["do", "--max-time", ""], [("none", "")]),
        (["completion", ""], [(shell, "") for shell in SHELLS]),
        (["no-such", ""], []),
    ],
)
def test_what_stands_behind_a_command_is_offered(line: list[str], offered: list[tuple[str, str]]) -> None:
    assert offers_for(line) == offered


def test_what_is_wrong_before_the_cursor_breaks_nothing(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "file"
    file.touch()
    assert main(["completion", "words", "--", "--config-dir", str(file), "program", "run", ""]) == 0
    assert capsys.readouterr().err == ""


def test_every_option_is_declared_once_and_has_a_default() -> None:
    assert len({option.flag for option in OPTIONS}) == len(OPTIONS)
    parsed = parse([])
    assert all(getattr(parsed, option.name) == option.default for option in OPTIONS)


# --- in the shells themselves ---


def shell_environment(home: Path) -> dict[str, str]:
    return {
        **os.environ, "PATH": f"{SCRIPTS}:{os.environ['PATH']}", "HOME": str(home), "TERM": "dumb",
        "LC_ALL": "C.UTF-8", "XDG_CONFIG_HOME": str(home / ".config"),
    }  # fmt: skip


_PREPARED = {
    "bash": (["--norc", "--noprofile"], 'bind "set enable-bracketed-paste off"'),
    "zsh": (["-f"], "unsetopt zle_bracketed_paste; autoload -U compinit; compinit -u -D"),
}
_TYPED = [
    ("chatrobot doc\t--json", "chatrobot doctor --json"),
    ("chatrobot do --robot turtles\tx", "chatrobot do --robot turtlesim x"),
    ("chatrobot do --robot=turtles\tx", "chatrobot do --robot=turtlesim x"),
    ("chatrobot plan x --png my\t", "chatrobot plan x --png my\\ way.png"),
    ("chatrobot replay d\t\t", "chatrobot replay drives/one.mcap"),
    ("chatrobot replay drives/\t", "chatrobot replay drives/one.mcap"),
    ("chatrobot eval c\t", "chatrobot eval corpus.yml"),
    ("chatrobot do --plan notes\t", "chatrobot do --plan notes.txt"),
    ("chatrobot model use ope\t\x7f\x7f\x7f\x7fgoo\tgemini", "chatrobot model use google:gemini"),
]


@pytest.mark.slow
@pytest.mark.parametrize("shell", list(_PREPARED))
def test_tab_completes_in_a_real_shell(shell: str, tmp_path: Path) -> None:
    """What Enter would run, as `echo` in front of it shows."""
    program = shutil.which(shell)
    if program is None:
        pytest.skip(f"no {shell} here")
    (tmp_path / "drives").mkdir()
    for name in (
        "my way.png",
        "my way.txt",
        "drives/one.mcap",
        "drives/one.txt",
        "notes.txt",
        "corpus.yml",
        "cat.txt",
    ):
        (tmp_path / name).touch()
    options, prepare = _PREPARED[shell]
    terminal = pexpect.spawn(
        program, options, env=shell_environment(tmp_path), cwd=str(tmp_path), encoding="utf-8",
        dimensions=(40, 200), timeout=PATIENCE_S,
    )  # fmt: skip
    terminal.sendline(f'PS1="$ "; {prepare}; eval "$(chatrobot completion {shell})"; echo RE""ADY')
    terminal.expect("READY\r\n")
    for typed, line in _TYPED:
        terminal.send(typed)
        terminal.send("\x01echo 'AS[' \x05 ']'\r")  # at the line's beginning, and at its end
        terminal.expect(r"AS\[ ([^\r\n]*) \]\r\n")
        expected = line.replace("\\ ", " ")
        assert " ".join(terminal.match[1].split()) == expected
    terminal.close(force=True)


@pytest.mark.slow
def test_tab_completes_in_fish(tmp_path: Path) -> None:
    if shutil.which("fish") is None:
        pytest.skip("no fish here")
    (tmp_path / "folder").mkdir()
    for name in ("corpus.yaml", "notes.txt"):
        (tmp_path / name).touch()

    def offered(line: str) -> list[str]:
        script = f"chatrobot completion fish | source; complete -C '{line}'"
        done = subprocess.run(
            ["fish", "--no-config", "-c", script], capture_output=True, text=True, cwd=tmp_path,
            env=shell_environment(tmp_path), timeout=PATIENCE_S, check=True,
        )  # fmt: skip
        return [each.partition("\t")[0] for each in done.stdout.splitlines()]

    assert offered("chatrobot wo") == ["world", "worlds"]
    assert offered("chatrobot do --robot turtles") == ["turtlesim"]
    assert offered("chatrobot do --robot=turtles") == ["--robot=turtlesim"]
    assert offered("chatrobot eval ") == ["corpus.yaml", "folder/"]
    assert offered("chatrobot eval c") == ["corpus.yaml"]
