"""Tables made of the data files are left in the cache folder, and built anew whenever that cannot be trusted."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from chatrobot.language import compiled as tables
from chatrobot.language.compiled import PhraseTable, by_first, compiled

TABLE = {("go", "on"): (("verb", "go"),)}


class Build:
    """Makes the table, and counts how often."""

    def __init__(self) -> None:
        self.times = 0

    def __call__(self) -> dict[tuple[str, ...], tuple[tuple[str, str], ...]]:
        self.times += 1
        return TABLE


@pytest.fixture
def cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    return tmp_path / "chatrobot"


def test_a_table_is_built_once(cache: Path) -> None:
    build = Build()
    assert [compiled("words", build), compiled("words", build)] == [TABLE, TABLE]
    assert build.times == 1
    assert len(list(cache.iterdir())) == 1


@pytest.mark.parametrize("kept", [b"", b"half", b"\0" * 40])
def test_a_broken_file_is_built_anew(cache: Path, kept: bytes) -> None:
    build = Build()
    compiled("words", build)
    (file,) = cache.iterdir()
    file.write_bytes(kept)
    assert compiled("words", build) == TABLE
    assert build.times == 2
    assert compiled("words", build) == TABLE
    assert build.times == 2


def test_each_state_has_its_file_and_the_last_four_stay(cache: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    build = Build()
    for state in (1, 2, 1, 3, 4, 5):
        monkeypatch.setattr(tables, "_fingerprint", lambda state=state: state)
        compiled("words", build)
        os.utime(cache / f"words-{state:08x}.bin", (state, state))
    assert build.times == 5
    assert sorted(file.name for file in cache.iterdir()) == [
        f"words-{state:08x}.bin" for state in (2, 3, 4, 5)
    ]


def test_without_a_folder_to_write_to_it_is_built(cache: Path) -> None:
    cache.write_text("a file stands where the folder would be")
    build = Build()
    assert compiled("words", build) == TABLE
    assert build.times == 1


def test_the_state_is_of_every_data_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(tables, "DATA", tmp_path)
    states = set()
    for text in ("", "a = 1", "a = 12"):
        (tmp_path / "words.toml").write_text(text)
        tables._fingerprint.cache_clear()
        states.add(tables._fingerprint())
    tables._fingerprint.cache_clear()
    assert len(states) == 3


def test_without_a_home_folder_it_is_built(monkeypatch: pytest.MonkeyPatch) -> None:
    def no_home(*_: object) -> Path:
        raise RuntimeError("Could not determine home directory.")

    monkeypatch.setattr("platformdirs.user_cache_path", no_home)
    assert compiled("words", Build()) == TABLE


def test_a_table_of_phrases_holds_what_it_was_made_of(cache: Path) -> None:
    assert not cache.exists()
    made = {("go",): 1, ("go", "on"): 2, ("前", "进"): 3}
    table: PhraseTable[int] = PhraseTable(compiled("phrases", lambda: by_first(made)))
    assert (table.get(("go", "on")), table["前", "进"], table.get(("go", "away"), 0)) == (2, 3, 0)
    assert [key in table for key in (("go",), ("on",), (), "go")] == [True, False, False, False]
    assert table == made
