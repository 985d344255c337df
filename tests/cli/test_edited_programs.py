"""What a person makes of a program or a plan at the question is shown and asked about: nothing edited runs unasked."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from chatrobot.programs.library import Library
from tests.console.terminal import Terminal
from tests.programs.scripted_model import program

NEW = ("program", "new", "drive forward 0.6 m at 0.3 m/s", "--name", "dash", "--fast", "--world", "empty")
QUESTION = r"\[y/N\]"


def command(folder: Path, editor: str, *arguments: str) -> Terminal:
    return Terminal(
        [sys.executable, "-m", "chatrobot", *arguments, "--config-dir", str(folder)],
        environment={"VISUAL": "", "EDITOR": editor, "PATH": "/usr/bin:/bin"},
        rows=120,
    )


def test_an_edited_program_is_the_next_version_and_is_asked_about_again_now_and_later(tmp_path: Path) -> None:
    with command(tmp_path, "sed -i s/linear_x=0.3/linear_x=0.2/", *NEW) as terminal:
        terminal.wait_for(QUESTION)
        assert "version 1:" in terminal.text
        terminal.enter("e")
        terminal.wait_for(QUESTION, times=2)
        assert "version 2:" in terminal.text
        assert "linear_x=0.2" in terminal.text.split("version 2:")[1]
        assert "written by a person" in terminal.text
        assert "drove" not in terminal.text
        terminal.enter("n")
        assert terminal.wait_for_end() == 4
    kept = Library(tmp_path).get("dash")
    assert "linear_x=0.2" in kept.source
    assert (kept.provenance.versions, kept.runs) == (2, ())
    later = ("do", "run the dash", "--approve", "--fast", "--world", "empty")
    with command(tmp_path, "true", *later) as terminal:
        terminal.wait_for(QUESTION)
        assert "version 2:" in terminal.text
        terminal.enter("e")
        terminal.wait_for(QUESTION, times=2)
        terminal.enter("n")
        assert terminal.wait_for_end() == 4


def test_an_editor_that_fails_leads_back_to_the_question(tmp_path: Path) -> None:
    with command(tmp_path, "false", *NEW) as terminal:
        terminal.wait_for(QUESTION)
        terminal.enter("e")
        terminal.wait_for(QUESTION, times=2)
        assert "ended with exit code 1" in " ".join(terminal.text.split())
        assert "version 2" not in terminal.text
        assert "drove" not in terminal.text
        terminal.enter("yes, do it")
        assert terminal.wait_for_end() == 0
        assert "drove 0.60 m" in terminal.text


def test_a_program_that_was_emptied_is_not_done(tmp_path: Path) -> None:
    with command(tmp_path, "truncate -s 0", *NEW) as terminal:
        terminal.wait_for(QUESTION)
        terminal.enter("e")
        assert terminal.wait_for_end() == 4
        assert "drove" not in terminal.text
    assert Library(tmp_path).get("dash").provenance.versions == 1


def test_an_edited_file_is_kept_under_its_name_and_stays_as_it_is(tmp_path: Path) -> None:
    """It is asked about again though nothing is found in it any more."""
    file = tmp_path / "rude.py"
    file.write_text(program("self.drive(0.2, 0.0, 0.5)\nreturn"), encoding="utf-8")
    run = ("program", "run", str(file), "--fast", "--world", "empty")
    with command(tmp_path, "sed -i 's/0.5)/0.8)/;s/return$/pass/'", *run) as terminal:
        terminal.wait_for(QUESTION)
        terminal.enter("e")
        terminal.wait_for(QUESTION, times=2)
        assert "without stopping" not in terminal.text.split("version 2")[1]
        assert "drove" not in terminal.text
        terminal.enter("y")
        assert terminal.wait_for_end() == 0
    assert "0.5)" in file.read_text(encoding="utf-8")
    assert "0.8)" in Library(tmp_path).get("rude").source


@pytest.mark.parametrize("editor", ["true", "no-such-editor"])
def test_a_plan_that_was_not_changed_is_asked_about_again(tmp_path: Path, editor: str) -> None:
    with command(tmp_path, editor, "do", "forward 1 m", "--approve", "--fast") as terminal:
        terminal.wait_for(QUESTION)
        terminal.enter("e")
        terminal.wait_for(QUESTION, times=2)
        terminal.enter("go ahead")
        assert terminal.wait_for_end() == 0


def test_an_edit_that_is_no_python_leaves_the_program_as_it_was_and_asks_again(tmp_path: Path) -> None:
    with command(tmp_path, "sed -i s/^import.time/import:time/", *NEW) as terminal:
        terminal.wait_for(QUESTION)
        terminal.enter("e")
        terminal.wait_for("version before it stays")
        terminal.wait_for(QUESTION, times=2)
        terminal.enter("n")
        assert terminal.wait_for_end() == 4
    assert "import time" in Library(tmp_path).get("dash").source


def test_an_edit_that_is_no_plan_leaves_the_plan_as_it_was_and_asks_again(tmp_path: Path) -> None:
    with command(tmp_path, "sed -i s/drive/fly/", "do", "forward 1 m", "--approve", "--fast") as terminal:
        terminal.wait_for(QUESTION)
        terminal.enter("e")
        terminal.wait_for("version before it stays")
        terminal.wait_for(QUESTION, times=2)
        terminal.enter("y")
        assert terminal.wait_for_end() == 0
        assert "drove 1.00 m of 1.00 m" in terminal.text
