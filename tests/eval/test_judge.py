"""What counts as correct, wrong and abstained."""

from __future__ import annotations

import math

import pytest

from chatrobot.cli.eval.corpus import Expect, Item, Turn
from chatrobot.cli.eval.judge import Record, Verdict, judge
from chatrobot.core.events import Outcome
from chatrobot.core.geometry import Twist
from tests.eval.traces import forward, left, rest, trace

Piece = tuple[float, Twist]


def verdict(expect: Expect, *pieces: Piece, outcome: Outcome = "completed") -> Verdict:
    item = Item("en-1", "metric", (Turn("…"),), expect)
    return judge(item, [Record(outcome, "a reply", trace(*pieces))])


def numbers(**wanted: float) -> Expect:
    return Expect(numbers=wanted)


@pytest.mark.parametrize(
    ("wanted", "just_right", "just_wrong"),
    [
        ({"x": 0.5}, forward(0.54), forward(0.56)),  # 0.05 m where 5 % would be less
        ({"x": 4.0}, forward(4.19), forward(4.22)),  # 5 % where that is more
        ({"path_m": 2.0}, forward(2.09), forward(2.12)),
        ({"duration_s": 3.0}, forward(3.48, 1.0), forward(3.54, 1.0)),
        ({"duration_s": 10.0}, forward(10.98, 1.0), forward(11.04, 1.0)),
        ({"max_speed": 0.4}, forward(1.0, 0.435), forward(1.0, 0.445)),
        ({"stays_within_m": 1.0}, forward(0.99), forward(1.01)),
    ],
)
def test_tolerances_of_lengths_times_and_speeds(
    wanted: dict[str, float], just_right: Piece, just_wrong: Piece
) -> None:
    assert verdict(numbers(**wanted), just_right).kind == "correct"
    assert verdict(numbers(**wanted), just_wrong).kind == "wrong"


@pytest.mark.parametrize(
    ("wanted", "just_right_deg", "just_wrong_deg"),
    [
        ({"yaw_deg": 90}, 93.5, 94.6),
        ({"yaw_deg": -90}, 270.0, 276.0),  # modulo a turn
        ({"yaw_deg": 180}, -177.0, -175.0),
        ({"turned_deg": 720}, 740.0, 743.0),
        ({"turned_deg": -45}, -46.0, -47.0),
    ],
)
def test_tolerances_of_angles(wanted: dict[str, float], just_right_deg: float, just_wrong_deg: float) -> None:
    def turn(angle_deg: float) -> Piece:  # in whole samples, exactly to the end
        steps = 400
        return steps * 0.02, Twist(0.0, 0.0, math.radians(angle_deg) / (steps * 0.02))

    assert verdict(numbers(**wanted), turn(just_right_deg)).kind == "correct"
    assert verdict(numbers(**wanted), turn(just_wrong_deg)).kind == "wrong"


def test_pauses_are_judged_within_half_a_second() -> None:
    expect = numbers(pause_s=3.0)
    assert verdict(expect, forward(1.0), rest(3.4), forward(1.0)).kind == "correct"
    assert verdict(expect, forward(1.0), rest(3.6), forward(1.0)).kind == "wrong"


def test_signs_judge_the_direction_alone() -> None:
    expect = Expect(sign={"x": "+", "y": "0", "yaw": "0"})
    assert verdict(expect, forward(0.1)).kind == "correct"
    assert verdict(expect, forward(-0.1)).kind == "wrong"
    assert verdict(expect, forward(0.1), left(0.2)).kind == "wrong"
    assert verdict(expect, rest(1.0)).kind == "wrong"


def test_a_closed_path_ends_within_ten_centimetres() -> None:
    assert verdict(Expect(closed=True), forward(1.0), forward(-0.91)).kind == "correct"
    assert verdict(Expect(closed=True), forward(1.0), forward(-0.89)).kind == "wrong"


def test_all_that_is_expected_must_hold_and_all_that_does_not_is_told() -> None:
    result = verdict(numbers(x=1.0, y=1.0, yaw_deg=90), forward(2.0))
    assert result.kind == "wrong"
    assert len(result.reasons) == 3


def test_asking_back_or_declining_instead_of_moving_is_abstaining() -> None:
    assert verdict(numbers(x=1.0), outcome="unclear").kind == "abstained"
    assert verdict(numbers(x=1.0), outcome="refused").kind == "abstained"
    assert verdict(numbers(x=0.0), outcome="unclear").kind == "abstained"  # though it holds by chance


def test_asking_back_after_having_moved_is_wrong() -> None:
    assert verdict(numbers(x=1.0), forward(0.5), outcome="unclear").kind == "wrong"


def test_saying_done_without_having_moved_is_wrong_and_told() -> None:
    result = verdict(numbers(x=1.0))
    assert result.kind == "wrong"
    assert "it did not move; completed: a reply" in result.reasons


def test_answering_instead_of_moving_is_wrong() -> None:
    assert verdict(numbers(x=1.0), outcome="answered").kind == "wrong"


def test_a_failure_is_not_correct_even_where_the_robot_arrived() -> None:
    assert verdict(numbers(x=1.0), forward(1.0), outcome="failed").kind == "wrong"


def test_moving_where_it_must_not_is_wrong_even_if_it_comes_back() -> None:
    expect = Expect(no_motion=True)
    assert verdict(expect, outcome="stopped").kind == "correct"
    assert verdict(expect, forward(0.1), forward(-0.1), outcome="stopped").kind == "wrong"


@pytest.mark.parametrize(
    ("answer", "outcome", "kind"),
    [
        ("clarify", "unclear", "correct"),
        ("refuse", "refused", "correct"),
        ("info", "answered", "correct"),
        ("clarify", "refused", "abstained"),
        ("refuse", "unclear", "abstained"),
        ("info", "unclear", "abstained"),
        ("refuse", "answered", "wrong"),
        ("clarify", "completed", "wrong"),
        ("info", "stopped", "wrong"),
    ],
)
def test_answers(answer: str, outcome: Outcome, kind: str) -> None:
    expect = Expect(no_motion=True, answer=answer)  # type: ignore[arg-type]
    assert verdict(expect, outcome=outcome).kind == kind


def test_a_right_answer_while_driving_off_is_wrong() -> None:
    assert verdict(Expect(no_motion=True, answer="info"), forward(0.5), outcome="answered").kind == "wrong"


# --- dialogues ---


def dialogue(item: Item, *records: Record) -> str:
    return judge(item, records).kind


def test_only_the_end_of_a_dialogue_counts() -> None:
    item = Item("en-1", "dialogue", (Turn("by three"), Turn("metres, forward")), numbers(x=3.0, path_m=3.0))
    asked_back = Record("unclear", "three what?", trace())
    assert dialogue(item, asked_back, Record("completed", "done", trace(forward(3.0)))) == "correct"


def test_a_dialogue_is_measured_from_its_start() -> None:
    item = Item("en-1", "dialogue", (Turn("forward 1 m"), Turn("again")), numbers(x=2.0, path_m=2.0))
    whole = trace(forward(1.0), forward(1.0))
    first, second = whole[: len(whole) // 2 + 1], whole[len(whole) // 2 :]
    assert dialogue(item, Record("completed", "", first), Record("completed", "", second)) == "correct"


def test_no_motion_in_a_dialogue_speaks_of_its_own_turn() -> None:
    ask = Expect(no_motion=True, answer="info")
    item = Item("en-1", "dialogue", (Turn("forward 1 m"), Turn("where are you?")), ask)
    driven = trace(forward(1.0))
    assert (
        dialogue(item, Record("completed", "", driven), Record("answered", "here", driven[-1:])) == "correct"
    )


def test_a_turn_with_an_expectation_of_its_own_is_judged_when_it_ends() -> None:
    turns = (Turn("forward 1 m", numbers(x=1.0)), Turn("back 1 m"))
    item = Item("en-1", "dialogue", turns, numbers(x=0.0))
    whole = trace(forward(0.5), forward(-0.5))
    first, second = whole[: len(whole) // 2 + 1], whole[len(whole) // 2 :]
    assert dialogue(item, Record("completed", "", first), Record("completed", "", second)) == "wrong"
