"""Text as people type it → one plain form: compatibility characters, case, simplified Chinese, no emoji."""

from __future__ import annotations

import re
import unicodedata
from functools import lru_cache

from chatrobot.language.data_files import load_table

MAX_CHARACTERS = 2000
"""More than anybody says in one breath. Longer text is answered at once."""

_QUOTES = str.maketrans(
    {
        "’": "'",
        "‘": "'",
        "`": "`",
        "´": "'",
        "−": "-",
        "‐": "-",
        "‑": "-",
        "×": " x ",
        "·": " ",
        "º": "°",
        "˚": "°",
        "٫": ".",
        "，": ", ",
        "→": ";",
        "➡": ";",
        "⇒": ";",
        "ß": "ss",
        "ẞ": "ss",
    }
)
_CIRCLED = re.compile(r"[①-⑳❶-❿⑴-⒇]")
_GROUPED = re.compile(r"(?<![\d.,])([1-9]\d{0,2}(?:\.\d{3})+),(\d+)(?![\d,.])")
COMMA = re.compile(
    r"(?:(?<=^\d)|(?<=[^\d.,]\d)),(?=\d{1,2}(?![\d,]))|(?<=\d\d),(?=\d ?(?:[cm]m|centi|milli|deg|°|厘米|公分|毫米|度))"
)
"""A decimal comma: `2,35 m`, `10,5 cm`."""
_WITH_UNIT = re.compile(r"\d,\d{1,2} ?[a-z°厘公毫分米度秒]")
"""Where a unit stands behind one of them, all commas between digits are decimal ones: not so in `go to 1,1`."""
_RAISED = re.compile(r"(?<=\d)(?=[⁰¹²³⁴-⁹])")
_ELLIPSIS = re.compile(r"\.{2,}|…+")
_HAN = re.compile(r"[\u3400-\u9fff]")
_REDOUBLED = re.compile(r"([^\W\d一二两三四五六七八九十百千半a-z])一\1")  # 挪一挪
_UNSEEN = "\x7f"
"""Nobody sees it, nor what is of the category Cf: with one of them between its digits 15 cm is still 15 cm."""
_SPACES = re.compile(r"[ \t\u3000]+")


@lru_cache(maxsize=1)
def _simplified() -> dict[int, str]:
    pairs = str(load_table("zh", "traditional")["pairs"]).split()
    return {ord(pair[0]): pair[1] for pair in pairs}


@lru_cache(maxsize=1)
def _retroflex() -> re.Pattern[str]:
    return re.compile(f"(?<=[{load_table('zh', 'traditional')['retroflex']}])儿(?![子女童])")


def normalise(text: str) -> str:
    """Lower case, compatibility forms folded, simplified characters, decimal points; no controls, no emoji."""
    # An ellipsis must not fold into full stops, "1½" not into "11/2", and "1²" not into "12".
    # An item's number in a circle must not run into what stands beside it.
    text = re.sub(r"(?<=\d)(?=[½¼¾⅓⅔])", " ", _RAISED.sub("^", text))
    text = _CIRCLED.sub(" ; ", text.translate(_QUOTES))
    text = unicodedata.normalize("NFKC", _ELLIPSIS.sub("…", text).replace("…", "\ue000"))
    text = text.replace("\ue000", "…").replace("⁄", "/").translate(_simplified()).lower()
    text = _retroflex().sub("", _REDOUBLED.sub(r"\1", text))
    text = _GROUPED.sub(lambda found: f"{found[1].replace('.', '')}.{found[2]}", text)  # 1.000,5
    text = COMMA.sub(".", text) if _WITH_UNIT.search(text) else text
    kept = [c if _kept(c) else "" if c in _UNSEEN or unicodedata.category(c) == "Cf" else " " for c in text]
    return _SPACES.sub(" ", "".join(kept)).strip()


def _kept(character: str) -> bool:
    if character == "\n":
        return True
    category = unicodedata.category(character)
    return category[0] in "LNPZ" or category in ("Sm", "Mn", "Mc") or character in "`^|~+<>=$°º"


def has_chinese(text: str) -> bool:
    """Whether any character is Chinese: the question is then answered in Chinese."""
    return _HAN.search(text) is not None
