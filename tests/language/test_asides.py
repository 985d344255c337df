"""An order is driven beside what only tells, greets or explains, and never beside what bears on it."""

from __future__ import annotations

import pytest

from chatrobot.language.acts import read_acts
from chatrobot.language.beside import Aside, asides, is_sure_aside
from chatrobot.language.normalise import normalise
from chatrobot.plan.text import format_plan
from tests.language.dialogue_runner import Conversation

# Each with the order that is left where nothing is said beside it.
ASIDES = [
    ("customer in aisle 4 wants a demo, go forward 2 metres", "go forward 2 metres"),
    ("mum's asleep so keep it down, back 20 cm", "back 20 cm"),
    ("half the class is off sick, still, turn 90 degrees left", "turn left 90 degrees"),
    ("sorry I dropped my sandwich, ok, reverse 20 cm", "back 20 cm"),
    ("1.5 m fwd at 0.15 m/s dont wanna wake anyone", "1.5 m forward at 0.15 m/s"),
    ("单子催得急，每秒零点六米，往前冲三米", "每秒零点六米，往前三米"),
    ("The plumber is under the sink and needs his space. Turn left by 90 degrees.", "turn left 90 degrees"),
    ("careful, hot soup coming through!! go back half a metre", "drive back 0.5 m"),
    ("Somebody's knocking. Half a turn to the left so you're facing the door.", "turn left 180 degrees"),
    ("Thesis deadline's Friday and nothing works, but anyway: forward 1.5 m.", "drive forward 1.5 m"),
    ("Whoa whoa you're squashing my slipper, back 30 cm", "drive back 0.3 m"),
    ("my daughter dared me, one full spin to the left", "turn left 360 degrees"),
    ("customers incoming, reverse two metres, chop chop", "drive back 2 m"),
    ("go forward 1 m to clear the door", "drive forward 1 m"),
    ("can you back up 8 inches ur on my screwdriver", "drive backward 0.2032 m"),
    ("Slide sixty centimetres to your right, rather as the cellos do in a draught.", "drive right 0.6 m"),
    ("You've parked on my extension lead, roll forward 60 cm", "drive forward 0.6 m"),
    ("strafe left a metre, the lads are moving the fridge", "drive left 1 m"),
    ("go back one metre, you're upsetting the rabbit", "drive back 1 m"),
    ("turn left 45 degrees, sun's in my eyes", "turn left 45 degrees"),
    ("half a metre forward, then I can plug the charger in", "drive forward 0.5 m"),
    ("Listen up sausage, go forward one metre", "drive forward 1 m"),
    ("Rightio Geoffrey, reverse 1.2 metres", "drive back 1.2 m"),
    ("mornin' sparkles, turn left 90 degrees", "turn left 90 degrees"),
    ("i cba walking over there, go forward 1m", "drive forward 1 m"),
    ("Kindly proceed forward by one metre, I am obliged to you.", "drive forward 1 m"),
    ("Righty, where was I... oh yes: turn right 60 degrees", "turn right 60 degrees"),
    ("Now where did I leave my glasses? Never mind. Go forward 90 cm.", "drive forward 0.9 m"),
    ("Bit of a faff this, but turn left 120 degrees", "turn left 120 degrees"),
    ("Shame about the weather! Forward 1 m please", "drive forward 1 m"),
    ("Dinner lady needs to get past with the trolley, slide right half a metre", "drive right 0.5 m"),
    ('"Alles klar"... anyway, forward 1 m', "drive forward 1 m"),
    ("The judge has a clipboard and she's frowning at us; back up 25 cm", "drive back 0.25 m"),
    ("Mate, the telly's blocked. Turn right 90 degrees.", "turn right 90 degrees"),
    ("excuse the mess, we're moving house. back up 60 cm", "drive back 0.6 m"),
    ("She's asleep at last so quietly drive forward 2 m", "drive forward 2 m"),
    ("My English is not so good, sorry. Please drive one meter forward.", "drive forward 1 m"),
    ("I am student from Turkey, this is my project. Robot turn right 90 degree.", "turn right 90 degrees"),
    ("please to go back one meter", "drive back 1 m"),
    ("Papa Bear to robot, go forward 1 m, over", "drive forward 1 m"),
    ("Copy that. Robot, turn left 90 degrees.", "turn left 90 degrees"),
    ("Ground control here, proceed 3 m forward", "drive forward 3 m"),
    ("Too much glare on the lens. Reverse by one metre.", "drive back 1 m"),
    ("go back half a metre because Oma wants to vacuum", "drive back 0.5 m"),
    ("slide left 30 cm so the drawer can come out", "drive left 0.3 m"),
    ("turn right 90 degrees cause the plug's on that wall", "turn right 90 degrees"),
    ("before I forget, go forward one metre", "drive forward 1 m"),
    ("Nobody told me how cute you are. Turn left 90 degrees.", "turn left 90 degrees"),
    ("I never thought I'd talk to a machine. Forward one metre, dear.", "drive forward 1 m"),
    ("That's not helping anyone. Go back one metre.", "drive back 1 m"),
    ("I don't get paid enough for this, go forward 1 m", "drive forward 1 m"),
    ("You can't stay there, I'm painting. Move forward half a metre.", "drive forward 0.5 m"),
    ("前进一米", "drive forward 1 m"),
    ("师傅马上来修空调，左转90度", "turn left 90 degrees"),
    ("哎我去踩我鞋了，后退半米", "drive back 0.5 m"),
    ("论文还没写完烦死了，前进2米吧", "drive forward 2 m"),
    ("这边反光太厉害，右转45度", "turn right 45 degrees"),
    ("地上有碎玻璃，后退一米", "drive back 1 m"),
    ("刚看完牙说话不利索，右转90度", "turn right 90 degrees"),
    ("换了新电池试试看，先走两米再左转90度", "drive forward 2 m, turn left 90 degrees"),
    ("闺女跟我打赌，左转一圈", "turn left 360 degrees"),
    ("婴儿车过不去，往右挪20厘米", "drive right 0.2 m"),
    ("赢了请你喝奶茶，前进三米", "drive forward 3 m"),
    ("医院来电话了别吵，后退80厘米", "drive back 0.8 m"),
    ("标签在另一面，左转90度", "turn left 90 degrees"),
    ("你压到插线板了，往前走60厘米", "drive forward 0.6 m"),
    ("后退一米，你把兔子吓着了", "drive back 1 m"),
    ("左转45度，太阳晃眼", "turn left 45 degrees"),
    ("前进2米，看看新轮子行不行", "drive forward 2 m"),
    ("往前半米，我好插充电器", "drive forward 0.5 m"),
    ("后退40厘米，小宝要开抽屉", "drive back 0.4 m"),
    ("右转90度，马上要答辩了", "turn right 90 degrees"),
    ("小乖乖，前进一米", "drive forward 1 m"),
    ("旺财，后退一米二", "drive back 1.2 m"),
    ("铁蛋儿早上好，左转90度", "turn left 90 degrees"),
    ("服了，压我脚了，退50厘米", "drive back 0.5 m"),
    ("我说到哪了，哦对，右转60度", "turn right 60 degrees"),
    ("消防演习要开始了，后退一米", "drive back 1 m"),
    ("天气真糟糕，前进一米吧", "drive forward 1 m"),
    ("食堂阿姨推车要过，往右平移半米", "drive right 0.5 m"),
    ("评委皱眉头了，后退25厘米", "drive back 0.25 m"),
    ("大哥你挡电视了，右转90度", "turn right 90 degrees"),
    ("阿姨刚拖完地不脏的，往前开1.2米", "drive forward 1.2 m"),
    ("家里搬家乱得很见笑了，后退60厘米", "drive back 0.6 m"),
    ("她总算睡了，悄悄前进2米", "drive forward 2 m"),
    ("指挥中心呼叫，前进3米", "drive forward 3 m"),
    ("镜头太晃了，退后一米", "drive back 1 m"),
    ("人齐了，往前走一米", "drive forward 1 m"),
    ("右转90度，插座在那面墙", "turn right 90 degrees"),
    ("趁我烧水的功夫，往前走一米", "drive forward 1 m"),
    ("小朋友们不许偷看，机器人前进两米", "drive forward 2 m"),
    ("这本来不归我管，前进一米吧", "drive forward 1 m"),
    ("工资太低了不想干了，前进1米", "drive forward 1 m"),
    ("电梯又坏了，左转90度", "turn left 90 degrees"),
]

# None of them orders what stands in it: it is denied, bounded, put off, quoted, told, or second to something unknown.
BEARING = [
    "zorble the widget, then go forward one metre",
    "My landlord used to shout: go forward one metre!",
    "The poster on the wall says turn left 90 degrees",
    "Don't you dare. Go forward 1 m? No way.",
    "If the kettle whistles, go forward one metre",
    "Once granny has sat down, go forward one metre",
    "go forward 1 m, but only after the gong",
    "go forward 1 m, not before Lucy nods",
    "go forward one metre, says the manual",
    "Robot, slide one metre to the right once the glue is off the floor.",
    "once I've found my spectacles, go forward 2 m",
    "should the doorbell ring, drive one metre back",
    "Go forward one metre. Oh, hang on, Daniel is on the carpet.",
    "turn right 60 degrees. wait no the cable is still in",
    "Turn left 90 degrees. That was the sentence on the worksheet.",
    "Turn left 90 degrees. That's for the other robot, sorry.",
    "go forward 2 m. Actually the crane is live, so leave it.",
    "turn left 90 degrees, was the comment that got him banned",
    "the sign on our rival's stand reads, go forward 2 m",
    "My grandson will be here at four. Then you go forward 2 m.",
    "some noob in chat wrote this and im just reading it out. slide 30 cm to the left",
    "for every student who raises a hand, slide 30 cm to the left",
    "turn left 90 degrees, that's what the instructor barked at us",
    "My satnav went: turn left in 90 metres",
    "The bus goes left and my cat ran forward 1 m",
    "I dreamt you went forward two metres",
    'In the play the robot hears "go forward one metre"',
    "Kevin, go home. The other robot should drive forward 1 m",
    "I was about to say go forward one metre, but scrap that",
    "go forward one metre, on second thoughts don't bother",
    "go forward one metre, nah, forget it",
    "go forward one metre, just messing with you",
    "drive forward 1 m, had you worried there, just a joke",
    "tomorrow when the plumber's here, go forward one metre",
    "go forward one metre as soon as the door's open",
    "go forward one metre provided nobody's there",
    "unless Tim objects, go forward one metre",
    "should the alarm ring, turn left 90 degrees",
    "what would happen if I typed go forward one metre",
    "why does it say go forward one metre on the box",
    'why do people type "go forward one metre"',
    'how do I say "go forward one metre" in French',
    "you went forward one metre yesterday, remember?",
    "my sister's scooter turned left 90 degrees and crashed",
    "the recipe for disaster: go forward one metre",
    "go forward one metre is what Simon never says",
    "I said to the taxi driver go forward 100 metres",
    "I'd rather you didn't go forward one metre",
    "nobody asked you to go forward one metre",
    "there's no need to go forward one metre",
    "go forward one metre would be a mistake",
    "suppose the hallway is empty, go forward one metre",
    "when grandma claps, go forward one metre",
    "after my coffee, go forward one metre",
    "the first rule of robot club: never go forward one metre",
    "he typed drive forward 1 m and nothing happened",
    "she wants me to drive forward 1 m in her car",
    "I have to drive forward 1 m to let the van out",
    "let me drive forward 1 m, then you can get out",
    "my wheelchair can turn left 90 degrees",
    "the crane turns left 90 degrees and stops",
    "they made me go forward one metre on the catwalk",
    "wait for the green light, then go forward one metre",
    "hang on till Mia's ready, then turn left 90 degrees",
    "hold it right there. I did not say go forward one metre.",
    "abort! I repeat, abort! no going forward one metre",
    "cancel that, whoever said go forward one metre",
    "as my coach likes to say: drive forward 1 m every day",
    "quote of the day: go forward one metre",
    '"go forward one metre" has four words',
    "translate go forward one metre into German",
    "type go forward one metre into the console",
    "write go forward one metre on the board",
    "read out loud: go forward one metre",
    "next Tuesday go forward one metre",
    "for example go forward one metre",
    "grab the mug, go forward one metre",
    "等水开了，前进一米",
    "如果奶奶点头，前进一米",
    "说明书上写着：前进一米",
    "我爸常说，往前走一米",
    "我梦见你前进了一米",
    "昨天你左转了90度，记得吗",
    "明天师傅来了，前进一米",
    "前进一米，算了不用了",
    "前进一米，逗你玩的",
    "前进一米，我改主意了别走",
    "要是门开着就前进一米",
    "你为什么老是前进一米",
    "“前进一米”用英语怎么说",
    "把“前进一米”写在黑板上",
    "公交车左转90度然后停下",
    "我的猫往前走了一米",
    "小明，往前走一米，我说的是你不是机器人",
    "另一个机器人应该前进一米",
    "别前进一米",
    "没人让你前进一米",
    "用不着前进一米",
    "教练吼道：前进一米",
    "电影里有句台词，前进一米",
    "假如没人，前进一米",
    "只有我拍手了才前进一米",
    "直到我说好之前别前进一米",
    "我得往前走一米才能看见",
    "她让我往前开一米",
    "轮椅可以左转90度",
    "吊车左转90度停了",
    "前进一米会怎么样",
    "翻译：前进一米",
    "先去倒杯水，前进一米",
    "把门打开，前进一米",
    "念一遍前进一米",
    "午饭以后前进一米",
    "刚才谁说的前进一米",
    "比如前进一米",
    "千万不要前进一米",
    "听我口令，等我喊了再前进一米",
]


@pytest.mark.parametrize(("text", "order"), ASIDES)
def test_an_order_beside_an_aside_is_the_order_alone(text: str, order: str) -> None:
    meant, alone = Conversation().say(text), Conversation().say(order)
    assert alone.plan is not None
    assert meant.plan == alone.plan, meant.reply


@pytest.mark.parametrize("text", BEARING)
def test_what_denies_bounds_quotes_or_puts_off_an_order_is_no_aside(text: str) -> None:
    assert Conversation().say(text).plan is None


@pytest.mark.parametrize(
    "text", ["my landlord used to shout: go forward one metre!", "电影里有句台词，前进一米"]
)
def test_what_sounds_like_talk_but_may_bear_on_the_order_leaves_it_a_proposal(text: str) -> None:
    meant = Conversation().say(text)
    assert meant.plan is None
    assert meant.proposal is not None


@pytest.mark.parametrize(
    "clause",
    [
        "the radius is 2 m",
        "the speed is 0.1 m/s",
        "not before noon",
        "if it is dry",
        "two of them",
        "半径两米",
        "如果没人",
    ],
)
def test_a_clause_with_an_amount_a_condition_or_a_denial_is_never_surely_an_aside(clause: str) -> None:
    reads = read_acts(normalise(f"{clause}, go forward 1 m"))
    odds = dict.fromkeys(asides(reads), Aside(99.0, apart=False))
    assert not is_sure_aside(reads[0].clause, odds)


def test_a_refused_word_in_an_aside_refuses_nothing() -> None:
    assert _plan("the guy on the phone is laughing, go forward 1 m") == "drive 1 m"
    assert _plan("grab the phone, go forward 1 m") is None


def _plan(text: str) -> str | None:
    plan = Conversation().say(text).plan
    return format_plan(plan) if plan is not None else None
