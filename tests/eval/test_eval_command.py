"""`chatrobot eval`: items run in sessions of their own and are judged by where the robot really was."""

from __future__ import annotations

import sys
from pathlib import Path

import pexpect
import pytest

from chatrobot.cli.eval.corpus import Expect, Item, Meant, Turn, load_corpus
from chatrobot.cli.eval.run import run_items
from chatrobot.compose import Setup
from chatrobot.plan.text import parse_plan
from tests.cli.running import PATIENCE_S, Command, chatrobot, environment

__all__ = ["chatrobot"]

CORPUS = """
- {id: a-1, category: metric, say: "forward 1 m", expect: {x: 1.0, y: 0, yaw_deg: 0, duration_s: 3.6}}
- {id: a-2, category: metric, say: "forward 1 m", expect: {x: 2.0}}
- {id: a-3, category: clarify, say: "florble the wug", expect: {answer: clarify, motion: none}}
- {id: a-4, category: metric, say: "florble the wug", expect: {x: 1.0}}
- id: a-5
  category: dialogue
  turns: ["forward 1 m", {say: "where are you?", expect: {answer: info, motion: none}}, "again"]
  expect: {x: 2.0, path_m: 2.0}
"""


@pytest.fixture
def corpus(tmp_path: Path) -> str:
    file = tmp_path / "corpus.yaml"
    file.write_text(CORPUS, encoding="utf-8")
    return str(file)


def judge_one(say: str, sim: str = "", **numbers: float) -> str:
    item = Item("a-1", "metric", (Turn(say),), Expect(numbers=numbers))
    (judged,) = run_items([item], Setup(world="empty", sim=sim))
    return judged.verdict.kind


def test_the_table_counts_by_category_and_in_total(chatrobot: Command, corpus: str) -> None:
    done = chatrobot("eval", corpus)
    assert done.code == 0
    rows = {line.split()[0]: line.split()[1:] for line in done.out.splitlines() if line.strip()}
    assert rows["metric"] == ["3", "1", "1", "1", "33.3", "0"]
    assert rows["clarify"] == ["1", "1", "0", "0", "100.0", "0"]
    assert rows["total"] == ["5", "3", "1", "1", "60.0", "0"]


def test_what_went_wrong_is_listed_with_what_happened(chatrobot: Command, corpus: str) -> None:
    assert "a-2 forward 1 m" not in chatrobot("eval", corpus).out
    out = chatrobot("eval", corpus, "--misses").out
    assert "a-2 forward 1 m" in out
    assert "did: drive 1 m" in out
    assert "x is 1.00" in out


def test_json_has_a_line_an_item_and_the_totals_last(chatrobot: Command, corpus: str) -> None:
    done = chatrobot("eval", corpus, "--json")
    items = done.named("item")
    assert [item["verdict"] for item in items] == ["correct", "wrong", "correct", "abstained", "correct"]
    assert items[0]["measured"]["path_m"] == pytest.approx(1.0, abs=0.02)
    assert items[4]["outcomes"] == ["completed", "answered", "completed"]
    assert done.events[-1]["event"] == "total"
    assert done.events[-1]["correct"] == 3


def test_a_bad_corpus_is_wrong_usage(chatrobot: Command, tmp_path: Path) -> None:
    file = tmp_path / "bad.yaml"
    file.write_text("- {id: a-1, category: metric, say: hi, expect: {z: 1}}", encoding="utf-8")
    done = chatrobot("eval", str(file))
    assert done.code == 2
    assert "bad.yaml: a-1" in done.err


def test_the_truth_is_judged_and_not_what_the_robot_believes() -> None:
    assert judge_one("forward 2 m", x=2.0) == "correct"
    assert judge_one("forward 2 m", sim="slip=0.2", x=2.0) == "wrong"


def test_nothing_is_remembered_from_one_item_to_the_next() -> None:
    turns = (Turn("remember this place as larder"), Turn("forward 1 m"))
    first = Item("a-1", "dialogue", turns, Expect(numbers={"x": 1.0}))
    second = Item("a-2", "dialogue", (Turn("go back to larder"),), Expect(no_motion=True))
    judged = list(run_items([first, second], Setup(world="empty")))
    assert judged[0].verdict.kind == "correct"
    assert judged[1].records[0].outcome in ("unclear", "refused")


def test_half_of_a_corpus_can_be_chosen(chatrobot: Command, corpus: str) -> None:
    odd = chatrobot("eval", corpus, "--only", "odd", "--json").named("item")
    even = chatrobot("eval", corpus, "--only", "even", "--json").named("item")
    assert [item["id"] for item in odd] == ["a-1", "a-3", "a-5"]
    assert [item["id"] for item in even] == ["a-2", "a-4"]


def test_of_what_must_stand_it_is_told_how_much_moved(chatrobot: Command, tmp_path: Path) -> None:
    file = tmp_path / "still.yaml"
    file.write_text(
        '- {id: a-1, category: still, say: "forward 1 m", still: true}\n'
        '- {id: a-2, category: still, say: "where are you?", still: true}\n'
        '- {id: a-3, category: metric, say: "forward 1 m", plan: "drive 1 m"}\n',
        encoding="utf-8",
    )
    assert "2 items must stand still: 1 moved" in chatrobot("eval", str(file)).out
    totals = chatrobot("eval", str(file), "--json").events[-1]
    assert totals["still"] == {"items": 2, "moved": 1, "proposals": 0}


def test_what_was_asked_back_is_driven_as_a_yes_would(monkeypatch: pytest.MonkeyPatch) -> None:
    item = Item("a-1", "metric", (Turn("florble the wug"),), meant=Meant((parse_plan("drive 1 m"),)))
    for proposal, is_right in (("drive 1 m", True), ("drive 2 m", False)):
        monkeypatch.setattr("chatrobot.cli.eval.run.proposed_plan", lambda _, text=proposal: text)
        (judged,) = run_items([item], Setup(world="empty"))
        assert judged.verdict.kind == "abstained"
        assert judged.was_proposed is is_right


def test_the_shipped_corpora_are_valid_and_nothing_of_them_is_done_wrongly() -> None:
    """All is said to an ideal robot by `tests/language/test_corpus.py`; here every eighth is driven."""
    files = sorted((Path(__file__).parent.parent / "corpus").glob("*.yaml"))
    items = [item for file in files for item in load_corpus(file)]
    assert len(items) >= 200
    wrong = [
        one.item.id for one in run_items(items[::8], Setup(world="empty")) if one.verdict.kind == "wrong"
    ]
    assert wrong == []


@pytest.mark.parametrize("output", [[], ["--json"]], ids=["table", "json"])
def test_on_a_terminal_it_says_how_many_are_done_from_the_first_moment(
    corpus: str, tmp_path: Path, output: list[str]
) -> None:
    child = pexpect.spawn(
        sys.executable,
        ["-m", "chatrobot", "eval", corpus, *output],
        env=environment(tmp_path),
        encoding="utf-8",
        timeout=PATIENCE_S,
    )
    child.expect_exact("\r\x1b[K0 of 5")
    child.expect(r"[1-5] of 5, \d+ s to go")
    child.expect(pexpect.EOF)
    assert child.before is not None
    last = child.before.rsplit("\r\x1b[K", 1)[1]
    assert "to go" not in last
    for line in child.before.splitlines():
        shown = line.rsplit("\x1b[K", 1)[-1]
        assert not ("{" in shown and "to go" in shown), "a line of output stands alone"


def test_where_errors_go_elsewhere_nothing_is_said_of_progress(chatrobot: Command, corpus: str) -> None:
    assert chatrobot("eval", corpus).err == ""
