"""A plan that was saved is driven again: rehearsed, limited and asked about like any other."""

from __future__ import annotations

from pathlib import Path

import pytest

from chatrobot.cli.plan import MOST_BYTES, read_plan_file
from chatrobot.core.errors import UsageError
from tests.cli.running import Command

FAST = ("--fast", "--world", "empty")


def plan(folder: Path, text: str | bytes) -> str:
    path = folder / "my plan.txt"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return str(path)


def test_a_saved_plan_is_driven_and_texts_are_the_turns_after_it(chatrobot: Command, tmp_path: Path) -> None:
    file = plan(tmp_path, "# there\ndrive 0.5 m\nturn left 90 deg\n")
    done = chatrobot("do", "--plan", file, "undo", "--json", *FAST)
    assert done.code == 0
    first, undone = done.named("result")
    assert first["pose"]["x_m"] == pytest.approx(0.5, abs=0.02)
    assert first["turned_rad"] == pytest.approx(1.571, abs=0.02)
    assert abs(undone["pose"]["x_m"]) < 0.02
    assert done.named("interpreted")[0]["plan_text"] == "drive 0.5 m\nturn left 90 deg"
    assert len(done.named("rehearsed")) == 2


def test_one_of_two_plans_is_not_lost_without_a_word(chatrobot: Command, tmp_path: Path) -> None:
    file = plan(tmp_path, "drive 0.5 m")
    done = chatrobot("do", "--plan", file, "--plan", file, *FAST)
    assert (done.code, "--plan is given twice" in done.err) == (2, True)


def test_a_plan_of_a_file_is_held_to_the_limits_and_to_the_world(chatrobot: Command, tmp_path: Path) -> None:
    too_fast = chatrobot("do", "--plan", plan(tmp_path, "drive 1 m at 9 m/s"), *FAST)
    assert (too_fast.code, "1.00 m/s is possible" in too_fast.out) == (4, True)
    into_the_wall = chatrobot("do", "--plan", plan(tmp_path, "drive 9 m"), "--fast", "--world", "home")
    assert into_the_wall.code == 4
    over_budget = chatrobot("do", "--plan", plan(tmp_path, "drive 3 m"), "--max-distance", "2", *FAST)
    assert over_budget.code == 4
    after = chatrobot("do", "--plan", plan(tmp_path, "drive 1 m at 9 m/s"), "turn left", *FAST)
    assert "“turn left”" in after.out + after.err, "what follows a refused plan is not done"


def test_a_plan_may_be_json_and_may_come_through_a_pipe(chatrobot: Command, tmp_path: Path) -> None:
    steps = (
        '{"steps": [{"kind": "drive", "distance_m": 0.5}, {"kind": "turn", "angle_rad": 1.5707963267948966}]}'
    )
    for file, said in ((plan(tmp_path, steps), ""), ("-", steps), ("-", "drive 0.5 m\nturn left 90 deg")):
        done = chatrobot("do", "--plan", file, "--json", *FAST, stdin=said)
        assert done.code == 0
        assert done.named("interpreted")[0]["plan_text"] == "drive 0.5 m\nturn left 90 deg"
    broken = chatrobot("do", "--plan", "-", *FAST, stdin='{"steps": [{"kind": "fly"}]}')
    assert (broken.code, "standard input: steps[0].kind: 'fly' is not a kind of step" in broken.err) == (
        2,
        True,
    )


def test_a_broken_file_says_which_line_and_what_is_allowed(chatrobot: Command, tmp_path: Path) -> None:
    done = chatrobot("do", "--plan", plan(tmp_path, "# mine\ndrive 0.5 m\nturn lft 90 deg\n"), *FAST)
    assert done.code == 2
    assert done.out == ""
    assert done.err.endswith(
        "my plan.txt: line 3: 'turn lft 90 deg': 'lft' is not understood here ('left' or 'right')\n"
    )


@pytest.mark.parametrize(
    ("content", "problem"),
    [
        (b"", "there is no step in this plan"),
        (b"\x89PNG\xff", "not a text file"),
        (b"drive 1 m\n" * MOST_BYTES, "too long for a plan"),
        ("drive 1 m\nend\n".encode("utf-16"), "not a text file"),
    ],
)
def test_what_is_no_plan_is_refused(tmp_path: Path, content: bytes, problem: str) -> None:
    with pytest.raises(UsageError, match=problem):
        read_plan_file(plan(tmp_path, content))


def test_a_file_with_a_byte_order_mark_and_windows_line_ends_is_read(tmp_path: Path) -> None:
    assert read_plan_file(plan(tmp_path, b"\xef\xbb\xbfdrive 1 m\r\nwait 1 s\r\n")).startswith("drive 1 m")


def test_a_file_that_is_not_there_and_nothing_at_all_say_the_way_out(
    chatrobot: Command, tmp_path: Path
) -> None:
    missing = chatrobot("do", "--plan", str(tmp_path / "none.plan"), *FAST)
    assert (missing.code, "none.plan: No such file or directory" in missing.err) == (2, True)
    nothing = chatrobot("do", *FAST)
    assert (nothing.code, "--plan FILE" in nothing.err) == (2, True)
