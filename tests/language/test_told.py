"""What only tells or asks about motion moves nothing, though it is made of the words of a command."""

from __future__ import annotations

import math

import pytest

from tests.language.dialogue_runner import Conversation, conversation


@pytest.mark.parametrize(
    "text",
    [
        "我跑了一米", "他走了两米", "小明往前走了一米", "我刚才右转了九十度", "你走了一米", "刚才往前走了一米",
        "你左转了吗", "前进了一米吗", "动了吗", "你是不是走了一米", "一米有多长", "如何前进一米", "往前走一米会怎么样",
        "前面有一米空间吗", "你有一米长吗", "要不要往前走一米", "我要走了", "我往左，你就往右", "先别急着走",
        "往前走一米，不是往后", "往左转，不是往右转", "往前走一米，不是让你往后",
        "走开", "靠边站", "一圈五秒，转两圈", "走三米，一米五秒", "你先等一下，我先走", "我让你走了吗", "原地踏步",
        "小心后面", "注意左边！", "前面还有两米", "该左转吗", "是往左转吗",
        "大家都前进了一米，你呢",
    ],
)  # fmt: skip
def test_a_report_and_a_question_move_nothing(text: str) -> None:
    meant = Conversation().say(text)
    assert meant.plan is None, meant.reply


@pytest.mark.parametrize(
    ("text", "x_m", "y_m", "turned_deg"),
    [
        ("走了一米再左转90度", 1.0, 0, 90),
        ("往前走了一米之后左转90度", 1.0, 0, 90),
        ("该左转了", 0, 0, 90),
        ("要不往前走一米", 1.0, 0, 0),
        ("你能前进一米吗", 1.0, 0, 0),
        ("我往前走一米，你往后退一米", -1.0, 0, 0),
        ("你往前走一米，我往后退一米", 1.0, 0, 0),
        ("我们一起往前走一米", 1.0, 0, 0),
        ("先别急着走，先右转九十度，再走八十公分", 0, -0.8, -90),
        ("奶奶腿脚不好，你往后倒个一米二，让我过去", -1.2, 0, 0),
        ("倒计时三秒后前进一米", 1.0, 0, 0),
        ("三秒倒计时，左转九十度", 0, 0, 90),
        ("十分缓慢地后退半米", -0.5, 0, 0),
        ("往前两米太多了，一米就好", 1.0, 0, 0),
        ("左转九十度太多了，四十五度吧", 0, 0, 45),
        ("往前走一米，不是，一米五", 1.5, 0, 0),
        ("向左偏移半米", 0, 0.5, 0),
        ("向左偏十度走一米", 0.984807753, 0.173648178, 10),
        ("你往后退一点，我先过", -0.25, 0, 0),
        ("帮我看看后面", 0, 0, 180),
        ("小心左边，往右平移半米", 0, -0.5, 0),
        ("注意，左转", 0, 0, 90),
        ("前面还有两米，走一米", 1.0, 0, 0),
        ("别转弯 就直直地往前溜达溜达", 0.5, 0, 0),
        ("呃就是说往前个半米吧", 0.5, 0, 0),
        ("左转，不对，不是左转，是右转九十度", 0, 0, -90),
    ],
)
def test_a_command_beside_it_is_done_and_nothing_else(
    text: str, x_m: float, y_m: float, turned_deg: float
) -> None:
    talk = conversation(text)
    assert talk.track.pose.x_m == pytest.approx(x_m, abs=1e-6)
    assert talk.track.pose.y_m == pytest.approx(y_m, abs=1e-6)
    assert math.degrees(talk.track.turned_rad) == pytest.approx(turned_deg, abs=1e-6)


@pytest.mark.parametrize(
    ("turns", "x_m", "turned_deg"),
    [
        (("往前走半米", "这回走两倍远"), 1.5, 0),
        (("往前走半米", "这一回左转90度"), 0.5, 90),
        (("往前走半米，这回慢一点",), 0.5, 0),
        (("往前走半米", "下回走慢一点"), 0.5, 0),
        (("前进一米", "那回来吧"), 0, 0),
        (("前进一米", "慢一半再走一遍"), 2.0, 0),
        (("前进一米", "再走一遍，快一倍"), 2.0, 0),
        (("前进两米", "我要的是三米"), 3.0, 0),
        (("前进两米", "其实一米就够了"), 1.0, 0),
        (("前进两米", "你刚才走了两米，退回来一半"), 1.0, 0),
        (("左转90度", "太多了，转回来一点"), 0, 75),
        (("后退一米", "往回一点"), -0.75, 0),
        (("记一下，这里是窗台", "前进一米", "去窗台"), 0, 0),
    ],
)
def test_what_a_later_turn_says_is_not_taken_for_the_way_home(
    turns: tuple[str, ...], x_m: float, turned_deg: float
) -> None:
    talk = conversation(*turns)
    assert talk.track.pose.x_m == pytest.approx(x_m, abs=1e-6)
    assert math.degrees(talk.track.turned_rad) == pytest.approx(turned_deg, abs=1e-6)


@pytest.mark.parametrize(
    ("asked_back", "answer", "y_m", "turned_deg"),
    [
        ("往旁边挪二十公分", "右边", -0.2, 0),
        ("向左或者向右平移半米", "左吧", 0.5, 0),
        ("往左转还是往右转九十度", "右", 0, -90),
        ("左转还是右转九十度", "往左", 0, 90),
        ("横着走一米", "左边", 1.0, 0),
        ("走20", "左边", 0, 0),
    ],
)
def test_a_side_answers_what_was_left_open_and_is_no_turn_of_its_own(
    asked_back: str, answer: str, y_m: float, turned_deg: float
) -> None:
    talk = conversation(asked_back, answer)
    assert talk.track.pose.x_m == pytest.approx(0, abs=1e-6)
    assert talk.track.pose.y_m == pytest.approx(y_m, abs=1e-6)
    assert math.degrees(talk.track.turned_rad) == pytest.approx(turned_deg, abs=1e-6)


def test_what_was_only_asked_about_is_not_done_with_the_next_command() -> None:
    assert conversation("如何前进一米", "前进一米").track.pose.x_m == pytest.approx(1.0)


@pytest.mark.parametrize(
    "text",
    ["停止左转", "立刻停止向右平移", "停止往前走", "停止后退！", "暂停前进", "前进停止", "停止转圈", "停止前进三秒",
     "停止后退一米"],
)  # fmt: skip
def test_to_stop_a_motion_is_not_to_make_it(text: str) -> None:
    talk = conversation(text)
    assert talk.track.path_m == 0
    assert talk.track.turned_rad == 0


def test_after_the_stop_of_one_motion_comes_another() -> None:
    assert math.degrees(conversation("停止左转，右转九十度").track.turned_rad) == pytest.approx(-90)
    assert conversation("停止后，退一米").track.pose.x_m == pytest.approx(-1.0)


@pytest.mark.parametrize(
    "text",
    [
        "Grandpa, you go back a bit", "爷爷，你慢慢往前走，不着急", "退后退后，大家都退后，地滑",
        "Alexa, forward thirty seconds",
        "Sit, Bella. Good girl. Now turn around.", "Rusty, go back", "大黄，过来",
        "ten centimetres, I measured it twice", "三米，我量过的", "我先往右挪半米，给你让路",
        "ahead it's two metres, behind three",
        "To go forward one metre you need about three seconds", "左后方三十厘米处有根线", "别看它小，能一口气退十米呢",
        "Vorne sind es zwei Meter, hinten drei", "Der fährt nur einen Meter vor",
        "Einen Meter vorwärts fährt er in drei Sekunden",
        "Warte, bevor du einen Meter vorfährst, muss ich das Kabel wegräumen", "Shall we let it go forward one metre?",
        "yesterday I published linear.x 0.3, angular.z 0.6 for 4 s", "never publish a twist: linear.x 0.3 for 4 s",
        "刚右转90度", "原地别转半圈", "前进两米不是三米", "往前走两米，后一米慢点", "almost turn around",
        "turn right until you face left", "turn completely to the left", "turn right by 90 i mean left by 90 don't",
    ],
)  # fmt: skip
def test_what_is_told_others_or_denied_moves_nothing(text: str) -> None:
    meant = Conversation().say(text)
    assert meant.plan is None, meant.reply


@pytest.mark.parametrize(
    ("text", "x_m", "turned_deg"),
    [
        ("Rusty, drive forward 1 m", 1.0, 0),
        ("By all means drive 1 m", 1.0, 0),
        ("我的意思是左转九十度", 0, 90),
        ("what I mean is turn left 90 degrees", 0, 90),
        ("spin round once on the spot, never anticlockwise", 0, -360),
        ("原地转一圈，不要逆时针", 0, -360),
        ("前进不是两米，是三米", 3.0, 0),
        ("Ninety degrees to the right would be nice", 0, -90),
        ("Bitte einmal komplett links herum drehen", 0, 360),
        ("Wenn's geht, fahr zwei Meter geradeaus", 2.0, 0),
        ("现在轮到你了，前进两米", 2.0, 0),
    ],
)
def test_an_order_that_looks_like_it_is_done(text: str, x_m: float, turned_deg: float) -> None:
    talk = conversation(text)
    assert talk.track.pose.x_m == pytest.approx(x_m, abs=1e-6)
    assert math.degrees(talk.track.turned_rad) == pytest.approx(turned_deg, abs=1e-6)


def test_a_name_that_the_robot_was_given_calls_it() -> None:
    talk = conversation("Rusty, go back", "yes")
    assert talk.say("Rusty, turn left").plan is not None


@pytest.mark.parametrize(
    "text",
    [
        "go left or right, whichever, 30 cm", "往左还是往右都行，走半米",
        "fahr nach links oder nach rechts, egal, 30 cm",
        "ok, right, thanks a lot", "drive a circle without turning", "drive in a circle until I say stop",
        "slide right 1 m, then left", "我说左你就往左挪三十厘米", "Fahr -30 cm",
        "the robot can drive a square. Robot, show us a square with 50 cm sides!",
    ],
)  # fmt: skip
def test_a_choice_a_statement_or_what_has_no_end_is_not_driven(text: str) -> None:
    meant = Conversation().say(text)
    assert meant.plan is None, meant.reply


@pytest.mark.parametrize(
    "text", ["Rückwärts raus da, zweieinhalb Meter, dann umdrehn", "backward out the frobble, two metres"]
)
def test_the_way_that_leads_an_amount_is_not_passed_over(text: str) -> None:
    meant = Conversation().say(text)
    offered = meant.proposal.plan_text if meant.proposal is not None else ""
    assert meant.plan is None
    assert not offered or "back" in offered
