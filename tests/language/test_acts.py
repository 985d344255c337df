"""What orders nothing moves nothing, and what looks like it and does order is done."""

from __future__ import annotations

import random
import sys
import time
from pathlib import Path

import pytest

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

from chatrobot.cli.eval.corpus import load_corpus
from chatrobot.language.acts import SLOTS, features, orders, read_acts, talk_in
from chatrobot.language.fitted import weights
from chatrobot.language.lexicon import lexicon
from chatrobot.language.normalise import normalise
from chatrobot.language.signs import clauses_of
from chatrobot.plan.text import format_plan
from tests.language.dialogue_runner import Conversation, conversation

FRAMES = Path(__file__).parents[1] / "corpus" / "frames"
TALK = [
    "actually I wanted to have you go forward two metres but there's a bike there", "前进一米？算了，本来想让你走的",
    "I'd have sent you forward 1 m, but someone is standing there", "本来想让你往前走两米，可是前面有人",
    "eigentlich wollte ich dich zwei Meter vorfahren lassen, aber da steht ein Rad",
    "you are right", "what if you drive forward?", "is the kitchen on the left?", "that was a nice square",
    "be right back", "way to go!!", "my car drives 3 m", "haha you drive like my grandma", "wow, it turned left",
    "were you going to turn left just now?", "why did you go forward?", "tomorrow we drive a square",
    "she told me to go back two metres", "if it rains, go home", "don't turn left", "kids, take two steps back",
    "back in a minute", "a square has four sides", "you went 20 centimetres too far", "I always turn left there",
    "right, that was good", "right, you did well", "right, so that's how it works",
    "刚才走得不错", "正方形有四条边", "他昨天往前开了三米", "你会不会原地转圈", "如果我说前进你会怎么样",
    "明天再往前走两米", "老师说等会儿再前进", "不用再往左转了", "我左转的时候摔了一跤", "两米有多远啊",
    "careful, left!", "mind the step on the right", "still 20 cm to go", "2 m forward, 3 cm off",
    "stand back, it's moving",
    "90 left: ok. 90 right: ok", "after 1 m the drift was 2 cm to the left", "nice, a perfect quarter turn to the left",
    "a step forward and two back, that's life", "back to square one", "good dog, turn around", "Henry! get back here!",
    "at three o'clock you'll drive to the kitchen", "fast forward thirty seconds", "go back two slides",
    "左边!小心!", "航向偏左3度", "走完一米后向左漂了两厘米", "走得笔直,两米一点没偏", "快进三十秒",
    "往前两米是不是极限",
    "往后半米,哦不用了,这儿挺好", "Papa, rutsch mal ein Stück nach links", "90 Grad links, 2 Grad daneben",
    "Und ab nach Hause, so ist das Leben", "Soll 1,00 m, ist 1,03 m", "Noch zwei Meter zu fahren",
]  # fmt: skip
REMARKS = [
    "left, of course", "another metre, at this rate we'll be there by Christmas", "too far again",
    "left again, typical",
    "same as last time", "跟刚才一样", "左边,果然", "Nur die Hälfte, tja", "Und wieder links, wie originell",
]  # fmt: skip

ORDERS = {
    "could you go forward a metre?": "drive 1 m",
    "I'd like you to turn left": "turn left 90 deg",
    "you should turn right now": "turn right 90 deg",
    "right 90": "turn right 90 deg",
    "why don't you turn left by 30 degrees?": "turn left 30 deg",
    "I was wondering if you could back up 50 cm": "drive 0.5 m back",
    "would you mind turning around?": "turn left 180 deg",
    "how about going forward 60 cm": "drive 0.6 m",
    "great, two metres forward": "drive 2 m",
    "left 90 degrees, careful": "turn left 90 deg",
    "you're too close to me, back off 50 cm": "drive 0.5 m back",
    "that was nice, now another metre forward": "drive 1 m",
    "你能往前走一米吗": "drive 1 m",
    "能不能帮我往右转九十度": "turn right 90 deg",
    "你应该往后退半米": "drive 0.5 m back",
    "刚才不错，再往前走一米": "drive 1 m",
    "前面没人，往前走一米": "drive 1 m",
}

MIXED = {
    "Haha, that was slow. Whatever. Turn right 90 degrees": "turn right 90 deg",
    "slide 8 cm to the left, my sleeve is at the edge": "drive 0.08 m left",
    "go forward 1 m, grandma is watching": "drive 1 m",
    "奶奶想看看，左转九十度": "turn left 90 deg",
}


@pytest.mark.parametrize("text", TALK)
def test_talk_moves_nothing(text: str) -> None:
    assert Conversation().say(text).plan is None


@pytest.mark.parametrize("text", REMARKS)
def test_a_remark_on_what_was_done_moves_nothing(text: str) -> None:
    assert conversation("drive 1 m").say(text).plan is None


@pytest.mark.parametrize(("text", "plan"), [*ORDERS.items(), *MIXED.items()])
def test_an_order_is_done_however_it_is_put_and_whatever_is_said_beside_it(text: str, plan: str) -> None:
    meant = Conversation().say(text)
    assert meant.plan is not None, meant.reply
    assert format_plan(meant.plan) == plan


@pytest.mark.parametrize(
    "text",
    ["go forward 1 m if the door is open", "turn left, but not the camera", "go forward 1 m, without spilling it",
     "where are you? go forward 1 m", "go forward 1 m and sing a song", "前进一米，同时说“你好”"],
)  # fmt: skip
def test_what_bears_on_an_order_or_asks_for_more_is_never_passed_over(text: str) -> None:
    assert Conversation().say(text).plan is None
    assert talk_in(read_acts(normalise(text))) == []


@pytest.mark.parametrize("language", ["en", "zh"])
def test_no_word_of_motion_moves_anything_in_a_frame_that_orders_nothing(language: str) -> None:
    table = tomllib.loads((FRAMES / f"{language}.toml").read_text(encoding="utf-8"))
    frames = [frame for frame in table["still"] if "{v}" in frame and frame.count("{") == 1]
    written = [" ".join(key) for key, meaning in lexicon().words.items() if meaning[0][0] == "verb"]
    verbs = sorted(word for word in written if word.isascii() == (language == "en"))
    chance = random.Random(3)
    said = [frame.replace("{v}", verb) for frame in frames for verb in chance.sample(verbs, 2)]
    moved = [text for text in said if Conversation().say(text).plan is not None]
    assert len(said) > 350
    assert len(moved) <= 0.01 * len(said), moved


@pytest.mark.parametrize("language", ["en", "zh"])
def test_remarks_about_a_motion_that_is_seen_and_questions_without_a_verb_move_nothing(language: str) -> None:
    items = load_corpus(FRAMES.parent / "sources" / f"dev_lead_moves_{language}.yaml")
    still = [item.turns[0].say for item in items if item.must_stand]
    assert len(still) >= 30
    assert [text for text in still if Conversation().say(text).plan is not None] == []


@pytest.mark.parametrize(
    "text", ["nice turn", "you turn too fast", "left, right?", "now it turns left, I see"]
)
def test_a_remark_leaves_no_question_open(text: str) -> None:
    assert Conversation().say(text).code == "nothing_to_do"


def test_a_text_is_cut_at_its_marks_and_its_words_are_labelled() -> None:
    first, second = clauses_of("were you going to turn left just now? ok, go 2.5 m")[:2]
    assert [sign.label for sign in first.signs] == ["ask", "VERB", "DIR", "earlier"]
    assert first.end == "?"
    assert first.moves
    assert not second.moves


def test_a_longer_request_removes_the_evidence_in_it() -> None:
    (clause,) = clauses_of("i was wondering if you could go forward")
    assert [sign.label for sign in clause.signs] == ["request", "VERB", "DIR"]


def test_a_word_of_this_dialogue_is_one_of_motion() -> None:
    (clause,) = clauses_of("try the flip", names={("flip",)})
    assert clause.moves
    assert not clauses_of("try the flip")[0].moves


def test_weights_are_few_and_the_features_of_a_clause_are_the_same_each_time() -> None:
    assert len(weights("acts")) == SLOTS <= 120_000
    clauses = clauses_of("he said you are right, so go forward 1 m")
    assert sorted(features(clauses, 1)) == sorted(features(clauses, 1))


def test_nonsense_costs_little() -> None:
    for text in ("", ",", "？！。", "\n\n", "🙂" * 50, "a, " * 700, "左" * 2000, "?" * 2000):
        began_s = time.process_time()
        read_acts(text)
        orders(text)
        assert time.process_time() - began_s < 0.5, "of the processor, however busy it is"
