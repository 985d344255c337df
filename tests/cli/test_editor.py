"""A person's own editor: what cannot be used as one is told in a sentence."""

from __future__ import annotations

from pathlib import Path

import pytest

from chatrobot.cli.approval import edited_text
from chatrobot.core.errors import UsageError


@pytest.mark.parametrize(
    ("editor", "problem"),
    [
        ("false", "ended with exit code 1"),
        ("no-such-editor", "'no-such-editor' cannot be started"),
        ("", "'vi' cannot be started"),
        ("'unclosed", "cannot be read"),
        ("sed -i 's/drive/\\xff/'", "left a file that is not UTF-8 text"),
    ],
)
def test_an_editor_that_fails_is_told_in_a_sentence(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, editor: str, problem: str
) -> None:
    monkeypatch.setenv("VISUAL", "")
    monkeypatch.setenv("EDITOR", editor)
    if not editor:
        monkeypatch.setenv("PATH", str(tmp_path))  # and no `vi` in it
    with pytest.raises(UsageError, match=problem):
        edited_text("drive 1 m", ".txt")


def test_what_it_leaves_is_the_text(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("VISUAL", "sed -i s/1/2/")
    assert edited_text("drive 1 m\n", ".txt") == "drive 2 m\n"
