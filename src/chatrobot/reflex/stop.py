"""Is this a stop? Whole words and phrases, never substrings; Chinese is cut by the longest phrase."""

from __future__ import annotations

import re
from functools import lru_cache

from chatrobot.reflex import words_en, words_zh

MAX_CHARACTERS = 300
"""A longer utterance is no stop as a whole; its beginning is still looked at."""

_TRADITIONAL = str.maketrans(
    "車剎動別緊煩關電機馬達執運轉終斷這裡裏給說們聽沒來對開後進過許準跑嗎讓幾點個馬請亂棄滅鎖複復",
    "车刹动别紧烦关电机马达执运转终断这里里给说们听没来对开后进过许准跑吗让几点个马请乱弃灭锁复复",
)
_WORD = re.compile(r"[a-z0-9]+(?:['’][a-z]+)*|[\u3400-\u9fff]")
_BREAK = re.compile(r"[.,;!?…。，；！？\n—]+|\s-+\s|\.\.+")
_STRETCHED = re.compile(r"(.)\1{2,}")
_WIDE = {code: code - 0xFEE0 for code in range(0xFF01, 0xFF5F)}

Phrase = tuple[str, ...]


@lru_cache(maxsize=32)
def _units(text: str) -> Phrase:
    """Several questions are asked about one text: it is cut once."""
    lowered = text.translate(_WIDE).lower().replace("’", "'").replace("-", " ").translate(_TRADITIONAL)
    return tuple(_unstretched(word) for word in _WORD.findall(lowered))


def _unstretched(word: str) -> str:
    """`stoooop` → `stop`, `haaalt` → `halt`; other words stay."""
    short = _STRETCHED.sub(r"\1", word)
    if short != word:
        return short
    single = re.sub(r"(.)\1+", r"\1", word)
    return single if single in words_en.DOUBLED else word


def _phrases(*groups: tuple[str, ...]) -> dict[str, set[Phrase]]:
    """By their first unit."""
    found: dict[str, set[Phrase]] = {}
    for group in groups:
        for phrase in group:
            units = _units(phrase)
            found.setdefault(units[0], set()).add(units)
    return found


_STOP = _phrases(words_en.STOP, words_zh.STOP, words_en.EMERGENCY, words_zh.EMERGENCY)
"""An emergency stop is a stop, too."""
_EMERGENCY = _phrases(words_en.EMERGENCY, words_zh.EMERGENCY)
_RELEASE = _phrases(words_en.RELEASE, words_zh.RELEASE)
_FILLER = _phrases(words_en.FILLER, words_zh.FILLER)
_CANCELLED = _phrases(words_en.CANCELLED, words_zh.CANCELLED)
_TAKEN_BACK = _phrases(words_en.TAKEN_BACK, words_zh.TAKEN_BACK)
_NOUNS = frozenset({"sign", "signs", "牌", "标", "watch", "light", "lights"})
_NUMBERS = frozenset("一二两三四五六七八九十半几") | {
    "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten", "half", "between",
    "after", "every",
}  # fmt: skip
_NOT_LEADING = {
    _units(p)
    for p in (
        "不要",
        "别",
        "stop sign",
        "no more",
        "不行",
        "够了",
        "wo",
        "ho",
        "取消",
        "算了",
        "cancel",
        "enough",
    )
}


def _matches(units: Phrase, i: int, table: dict[str, set[Phrase]]) -> list[Phrase]:
    return [p for p in table.get(units[i], ()) if units[i : i + len(p)] == p]


def _forbids_stopping(units: Phrase) -> bool:
    """别停, 不要停下, `don't stop`: the opposite of a stop."""
    joined = " ".join(units)
    return (
        re.search(
            r"(?:别|不要|不许|不准|不能|don't|dont|not|never|without) (?:停|刹|stop)".replace("不", "不 ?"),
            joined,
        )
        is not None
    )


def _consists(units: Phrase, table: dict[str, set[Phrase]]) -> bool:
    """Whether phrases of `table` (at least one) and fillers cover all of `units`."""
    reached = {0: False}
    for i in range(len(units)):
        if i not in reached:
            continue
        for phrase in _matches(units, i, table):
            reached[i + len(phrase)] = True
        for phrase in _matches(units, i, _FILLER):
            reached[i + len(phrase)] = reached.get(i + len(phrase), False) or reached[i]
    return reached.get(len(units), False)


def is_stop(text: str) -> bool:
    """Whether the whole utterance is a stop: stop phrases and fillers, nothing else. For a standing robot."""
    if len(text) > MAX_CHARACTERS:
        return False
    units = _units(text)
    return bool(units) and not _forbids_stopping(units) and (_consists(units, _STOP) or _takes_back(text))


def _takes_back(text: str) -> bool:
    """`往前……算了算了，别走了`: a command that breaks off, then taken back to the end."""
    parts = [part for part in _BREAK.split(text) if _units(part)]
    if len(parts) < 2 or not _consists(_units(parts[-1]), _CANCELLED):
        return False
    broken = re.search(r"…|\.\.|—|--|\s-\s", text) is not None
    if not broken and not _consists(_units(parts[-1]), _TAKEN_BACK):
        return False
    tail = len(parts) - 1
    while tail > 0 and _consists(_units(parts[tail - 1]), _CANCELLED | _STOP):
        tail -= 1
    return tail <= 1 or broken


def leads_with_stop(text: str) -> bool:
    """Whether a stop leads, or ends, the utterance. For a moving robot: the rest does not matter."""
    if is_stop(text):
        return True
    units = _units(text[:MAX_CHARACTERS])
    if _forbids_stopping(units):
        return False
    i = 0
    while i < len(units):
        found = [p for p in _matches(units, i, _STOP) if p not in _NOT_LEADING]
        if found and not _is_no_stop(units, i + max(len(p) for p in found)):
            return True
        fillers = _matches(units, i, _FILLER)
        if not fillers:
            break
        i += max(len(p) for p in fillers)
    parts = [part for part in _BREAK.split(text[-MAX_CHARACTERS:]) if _units(part)]
    return len(parts) > 1 and _consists(_units(parts[-1]), _CANCELLED)


def _is_no_stop(units: Phrase, after: int) -> bool:
    """`stop-sign shape` is a noun, and 停一秒 or `stop for two seconds` is a pause."""
    if after >= len(units):
        return False
    following = units[after]
    if following in _NOUNS or following in _NUMBERS or following[0].isdigit():
        return True
    return (
        following == "for"
        and after + 1 < len(units)
        and units[after + 1] not in ("now", "a", "god's", "heaven's")
    )


def is_emergency_stop(text: str) -> bool:
    """Whether the whole utterance is an emergency stop (which is a stop, too)."""
    if len(text) > MAX_CHARACTERS:
        return False
    units = _units(text)
    if not units:
        return False
    has = any(_matches(units, i, _EMERGENCY) for i in range(len(units)))
    return has and _consists(units, _STOP)


def is_release(text: str) -> bool:
    """Whether the whole utterance asks to release the emergency stop."""
    units = _units(text[:MAX_CHARACTERS])
    return bool(units) and _consists(units, _RELEASE)
