"""What changes nothing when it is changed was not understood: the interpreter asks back."""

from __future__ import annotations

import math
from collections.abc import Sequence

import pytest

from chatrobot.language.context import Context
from chatrobot.language.heeded import check_heeded
from chatrobot.language.interpreter import OfflineInterpreter
from chatrobot.language.tokens import Atom, quantity
from chatrobot.language.unclear import Unclear
from chatrobot.plan.steps import Drive, Step, Turn
from chatrobot.robots.load import DEFAULT_PROFILE, load_profile

METRE, SECONDS = quantity("length", 1.0, "1 m"), quantity("time", 3.0, "3 s")


def drives_by_length(atoms: Sequence[Atom]) -> list[Step]:
    """Rules that read a length and pass over everything else."""
    length = next(atom.number for atom in atoms if atom.value == "length")
    return [Drive(length)]


def test_an_amount_that_the_rules_pass_over_is_asked_about() -> None:
    atoms = [Atom("verb", "go", "go"), METRE, SECONDS]
    with pytest.raises(Unclear, match="3 s"):
        check_heeded(atoms, drives_by_length(atoms), drives_by_length)


def test_a_direction_that_the_rules_pass_over_is_asked_about() -> None:
    atoms = [METRE, Atom("dir", "back", "backwards")]
    with pytest.raises(Unclear, match="backwards"):
        check_heeded(atoms, drives_by_length(atoms), drives_by_length)


def test_amounts_that_matter_are_not_asked_about() -> None:
    check_heeded([METRE], drives_by_length([METRE]), drives_by_length)


def test_what_was_taken_back_may_count_for_nothing() -> None:
    atoms = [METRE, Atom("correction", "x", "no, wait"), SECONDS]
    check_heeded(atoms, drives_by_length(atoms), drives_by_length)


@pytest.mark.parametrize("said", ["1 m forward, back to the point, 2 m forward", "point left 3 metres"])
def test_a_length_beside_a_word_that_takes_none_moves_nothing(said: str) -> None:
    meant = OfflineInterpreter(load_profile(DEFAULT_PROFILE)).interpret(said, Context())
    assert meant.outcome == "unclear"


COMMA = Atom("sep", "weak", ",")


def every_length(atoms: Sequence[Atom]) -> list[Step]:
    """Rules that read every length and pass over all times."""
    return [Drive(atom.number) for atom in atoms if atom.value == "length"]


def test_a_long_list_is_not_read_again_as_a_whole_for_each_amount() -> None:
    atoms = [atom for _ in range(300) for atom in (METRE, COMMA)]
    read = 0

    def counted(part: list[Atom]) -> list[Step]:
        nonlocal read
        read += len(part)
        return every_length(part)

    check_heeded(atoms, every_length(atoms), counted)
    assert read < 20 * len(atoms)


def test_what_is_passed_over_is_found_in_the_midst_of_a_long_list() -> None:
    clauses = [atom for _ in range(150) for atom in (METRE, COMMA)]
    atoms = [*clauses, METRE, SECONDS, COMMA, *clauses]
    with pytest.raises(Unclear, match="3 s"):
        check_heeded(atoms, every_length(atoms), every_length)


def test_a_clause_that_is_passed_over_only_after_a_certain_one_is_found_in_a_long_list() -> None:
    def lost_after_a_second(atoms: Sequence[Atom]) -> list[Step]:
        kept = [
            a for i, a in enumerate(atoms) if a.value == "length" and atoms[max(i - 2, 0)].value != "time"
        ]
        return [Drive(atom.number) for atom in kept] + [Drive(a.number) for a in atoms if a.value == "time"]

    clauses = [atom for _ in range(60) for atom in (METRE, COMMA)]
    atoms = [*clauses, SECONDS, COMMA, quantity("length", 2.0, "2 m"), COMMA, *clauses]
    with pytest.raises(Unclear, match="2 m"):
        check_heeded(atoms, lost_after_a_second(atoms), lost_after_a_second)


@pytest.mark.parametrize(
    ("said", "last"), [("draw a triangle and turn around", 180), ("画个三角形，然后掉头", 180)]
)
def test_a_motion_beside_a_shape_is_done_after_it(said: str, last: int) -> None:
    plan = OfflineInterpreter(load_profile(DEFAULT_PROFILE)).interpret(said, Context()).plan
    assert plan is not None
    assert len(plan.steps) == 7
    assert plan.steps[-1] == Turn(math.radians(last))


def test_a_motion_before_a_shape_is_done_before_it() -> None:
    plan = (
        OfflineInterpreter(load_profile(DEFAULT_PROFILE))
        .interpret("turn around and draw a triangle", Context())
        .plan
    )
    assert plan is not None
    assert plan.steps[0] == Turn(math.pi)


def test_a_clause_that_the_rules_pass_over_is_asked_about() -> None:
    atoms = [METRE, Atom("sep", "weak", ","), Atom("verb", "uturn", "turn around")]
    with pytest.raises(Unclear, match="turn around"):
        check_heeded(atoms, drives_by_length(atoms), drives_by_length)
