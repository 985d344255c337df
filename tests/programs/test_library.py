"""Programs are kept as files that a person can read, under names that are easy to say."""

from __future__ import annotations

from pathlib import Path

import pytest

from chatrobot.core.errors import InputError
from chatrobot.programs.library import KeptProgram, Library, Provenance, RunRecord
from tests.programs.replies import NODE

DANCE = KeptProgram(
    "square dance",
    NODE,
    "Moves a little.",
    Provenance("dance in a square", "model", "some:model", "2026-11-21T12:00:00+00:00"),
    {"/turtle1/cmd_vel": "cmd_vel"},
    {"duration_s": 3.0},
    (RunRecord("2026-11-21T12:01:00+00:00", "completed", 1.0, 0.5, 3.0),),
)


def test_what_is_kept_is_there_in_the_next_session(tmp_path: Path) -> None:
    Library(tmp_path).keep(DANCE)
    assert Library(tmp_path).get("square dance") == DANCE


def test_its_source_is_a_file_that_any_editor_opens(tmp_path: Path) -> None:
    Library(tmp_path).keep(DANCE)
    assert (tmp_path / "programs" / "square_dance" / "program.py").read_text(encoding="utf-8") == NODE


@pytest.mark.parametrize("name", ["Square Dance", "square_dance", "  square   dance ", "SQUARE dance"])
def test_case_and_spaces_of_a_name_do_not_matter(name: str, tmp_path: Path) -> None:
    library = Library(tmp_path)
    library.keep(DANCE)
    assert library.get(name) == DANCE


def test_a_name_may_be_chinese(tmp_path: Path) -> None:
    library = Library(tmp_path)
    library.keep(KeptProgram("方块舞", NODE))
    assert Library(tmp_path).get("方块舞").source == NODE


def test_a_name_is_never_a_path(tmp_path: Path) -> None:
    library = Library(tmp_path / "config")
    library.keep(KeptProgram("../../escape", NODE))
    assert {path.name for path in tmp_path.iterdir()} == {"config"}
    assert library.find("../../escape") is not None
    with pytest.raises(InputError, match="cannot be the name"):
        library.keep(KeptProgram("../..", NODE))


def test_a_name_that_is_taken_gets_a_number(tmp_path: Path) -> None:
    library = Library(tmp_path)
    assert library.free_name("square dance") == "square dance"
    library.keep(DANCE)
    assert library.free_name("Square_dance") == "Square dance 2"


def test_an_unknown_name_is_answered_with_those_that_are_known(tmp_path: Path) -> None:
    library = Library(tmp_path)
    library.keep(DANCE)
    with pytest.raises(InputError, match="square dance"):
        library.get("waltz")


def test_renaming_keeps_everything_else(tmp_path: Path) -> None:
    library = Library(tmp_path)
    library.keep(DANCE)
    library.rename("square dance", "waltz")
    assert library.names() == ("waltz",)
    assert library.get("waltz").runs == DANCE.runs


def test_renaming_takes_nobodys_place(tmp_path: Path) -> None:
    library = Library(tmp_path)
    library.keep(DANCE)
    library.keep(KeptProgram("waltz", "pass\n"))
    with pytest.raises(InputError, match="already"):
        library.rename("square dance", "waltz")
    assert library.names() == ("square dance", "waltz")


def test_an_edited_program_has_not_been_rehearsed(tmp_path: Path) -> None:
    library = Library(tmp_path)
    library.keep(DANCE)
    edited = library.edit("square dance", "pass\n")
    assert (edited.source, dict(edited.rehearsal), edited.provenance.versions) == ("pass\n", {}, 2)
    assert edited.runs == DANCE.runs


def test_removing_leaves_nothing(tmp_path: Path) -> None:
    library = Library(tmp_path)
    library.keep(DANCE)
    library.remove("square dance")
    assert not list((tmp_path / "programs").iterdir())


def test_runs_are_noted_and_the_oldest_forgotten(tmp_path: Path) -> None:
    library = Library(tmp_path)
    library.keep(DANCE)
    for number in range(30):
        library.note_run("square dance", RunRecord("2026-11-21", "completed", path_m=float(number)))
    assert [run.path_m for run in library.get("square dance").runs] == [float(n) for n in range(10, 30)]


def test_a_broken_file_is_named(tmp_path: Path) -> None:
    Library(tmp_path).keep(DANCE)
    about = tmp_path / "programs" / "square_dance" / "about.json"
    about.write_text("{", encoding="utf-8")
    with pytest.raises(InputError, match=r"about\.json"):
        Library(tmp_path).names()


def test_without_a_folder_programs_live_as_long_as_the_session() -> None:
    library = Library(None)
    library.keep(DANCE)
    assert library.names() == ("square dance",)
