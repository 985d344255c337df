"""A file is written whole, or what was there stays."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from chatrobot.core.files import write_new, write_whole
from chatrobot.programs.library import KeptProgram, Library


def full(*_: object) -> None:
    raise OSError(28, "No space left on device")


def test_a_full_disk_takes_nothing_away(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = tmp_path / "model.toml"
    write_whole(file, "old")
    library = Library(tmp_path)
    library.keep(KeptProgram("waltz", "pass"))
    monkeypatch.setattr(os, "replace", full)
    with pytest.raises(OSError, match=r"model\.toml"):
        write_whole(file, "new")
    with pytest.raises(OSError, match="No space"):
        library.rename("waltz", "tango")
    assert file.read_text("utf-8") == "old"
    assert Library(tmp_path).get("waltz").source == "pass"
    assert not list(tmp_path.glob(".*"))


def test_what_cannot_be_written_leaves_no_empty_file_behind(tmp_path: Path) -> None:
    with pytest.raises(UnicodeEncodeError):
        write_new(tmp_path / "plan.txt", "\ud800")
    assert not (tmp_path / "plan.txt").exists()


def test_a_link_stays_one(tmp_path: Path) -> None:
    (tmp_path / "link").symlink_to("file")
    write_whole(tmp_path / "link", "new")
    assert (tmp_path / "file").read_text("utf-8") == "new"
