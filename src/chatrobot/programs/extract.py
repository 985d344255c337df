"""Finds the program in a model's answer: in a fence of any flavour, several, or none. The prose is kept, too."""

from __future__ import annotations

import ast
import html
import json
import re
import textwrap
from dataclasses import dataclass

MAX_REPLY_CHARS = 400_000
MAX_DESCRIPTION_CHARS = 2000

_THINKING = re.compile(r"<(think|thinking|reasoning)>.*?(?:</\1>|\Z)", re.S | re.I)
_HTML = re.compile(r"<(pre|code|python)\b[^>]*>(.*?)</\1>", re.S | re.I)
_OPENING = re.compile(r"^(?P<before>[^`~\n]*?)(?P<fence>`{3,}|~{3,})[ \t]*(?P<info>[^`\n]*?)[ \t]*$")
_ONE_LINE = re.compile(r"`{3,}[ \t]*(?:[Pp]y\w*\b)?(?P<code>[^`\n]+)`{3,}")
_PYTHON_INFO = re.compile(r"(?:\{\s*\.?|\b)(?:python[\d.]*|py[\d.]*|rclpy|ros2?)\b", re.I)
_PLAIN_INFO = re.compile(r"(?:text|txt|plain|plaintext|code|source|none|copy code|\S+\.py)?", re.I)
_BEGINS = re.compile(
    r"(?:import [A-Za-z_]|from [\w.]+ import\b|#!\s*/|# -\*-|class [A-Za-z_]\w*.*:|def [A-Za-z_]\w*\(|"
    r'"""|\'\'\'|rclpy\.|@\w)'
)
_PROMPTED = re.compile(r"^(?:>>>|\.\.\.)(?: |$)")
_NUMBERED = re.compile(r"^\s*\d+(?:[:.|]| {2}|\t) ?")
_CODE_KEYS = ("code", "source", "program", "python", "content")
_NOT_A_NODE = re.compile(r"\bsetuptools\b|\bLaunchDescription\b|\bament_target|\bimport pytest\b")
_CURLY = str.maketrans({"“": '"', "”": '"', "‘": "'", "’": "'", "\u2013": "-", "\u2212": "-"})
_INVISIBLE = str.maketrans({"\ufeff": None, "\u200b": None, "\u200c": None, "\u2060": None, "\u00a0": " "})


@dataclass(frozen=True)
class Extracted:
    """A program and the words around it. `source` ends with a line break; it need not be right Python.

    `is_closed`: the fence around it was closed, so that no more of it was to come.
    """

    source: str
    description: str
    is_closed: bool = False


@dataclass(frozen=True)
class _Block:
    info: str
    code: str
    is_closed: bool = True

    @property
    def may_be_python(self) -> bool:
        if _PYTHON_INFO.search(self.info):
            return True
        looks_like_it = any(_BEGINS.match(line) for line in self.code.splitlines())
        return bool(_PLAIN_INFO.fullmatch(self.info)) and (looks_like_it or _parses(self.code))

    @property
    def score(self) -> int:
        """Rate how much this looks like the whole program that was asked for."""
        whole = 4 * ("rclpy" in self.code) + 2 * bool(re.search(r"\.publish\(|\bspin(?:_once)?\(", self.code))
        whole += 2 * _parses(self.code) + bool(re.search(r"__main__|^main\(", self.code, re.M))
        return whole - 8 * bool(_NOT_A_NODE.search(self.code))


def extract(reply: str) -> Extracted | None:
    """Return the program in a model's reply; None where there is none. Never raises, whatever the reply."""
    text = reply[:MAX_REPLY_CHARS].replace("\r\n", "\n").replace("\r", "\n").translate(_INVISIBLE)
    text = _THINKING.sub("", text)
    text = _unwrapped_json(text)
    blocks, prose = _fenced(text)
    if not blocks:
        blocks, prose = _in_html(text)
    python = [block for block in blocks if block.may_be_python]
    if python:
        is_closed = all(block.is_closed for block in blocks)
        return Extracted(_mended(_chosen(python)), _described(prose), is_closed)
    if blocks:  # code, but none of it Python: a C++ node, a shell command
        return None
    return _bare(text)


# --- fences ---


def _fenced(text: str) -> tuple[list[_Block], str]:
    """Every fenced block, closed or cut off, and the text without them."""
    blocks: list[_Block] = []
    prose: list[str] = []
    lines = _unquoted(text).split("\n")
    at = 0
    while at < len(lines):
        opening = _OPENING.match(lines[at])
        if opening is None:
            single = _ONE_LINE.search(lines[at])
            if single is not None:
                blocks.append(_Block("", single["code"].strip()))
            prose.append(_ONE_LINE.sub("", lines[at]))
            at += 1
            continue
        prose.append(opening["before"].strip(" \t>*-"))
        info, first = _split_info(opening["info"])
        body, end = _until_closed(lines, at + 1, opening["fence"])
        is_closed, at = end is not None, len(lines) if end is None else end
        code = textwrap.dedent("\n".join(body)) if not first else "\n".join([first, *body])
        blocks.append(_Block(info, code, is_closed))
    return [block for block in blocks if block.code.strip()], "\n".join(prose)


def _split_info(info: str) -> tuple[str, str]:
    """An info string, and code that a hasty model put on the same line (```python import rclpy)."""
    word, _, rest = info.partition(" ")
    if rest and _BEGINS.match(rest.strip()):
        return word, rest.strip()
    if _BEGINS.match(info) and not _PYTHON_INFO.fullmatch(info):
        return "", info
    return info, ""


def _until_closed(lines: list[str], first_line: int, fence: str) -> tuple[list[str], int | None]:
    """The lines up to the closing fence, and the number of the line after it; None where it is never closed."""
    for at in range(first_line, len(lines)):
        stripped = lines[at].strip()
        if stripped.startswith(fence) and not stripped.strip(fence[0]):
            return lines[first_line:at], at + 1
        if stripped.endswith(fence) and fence not in stripped[: -len(fence)] and not stripped.startswith("#"):
            return [*lines[first_line:at], lines[at].rstrip()[: -len(fence)]], at + 1
    return lines[first_line:], None


def _unquoted(text: str) -> str:
    """Without the `> ` of a quotation, where fences stand inside one."""
    if re.search(r"^> ?(?:`{3}|~{3})", text, re.M):
        return re.sub(r"^> ?", "", text, flags=re.M)
    return text


def _in_html(text: str) -> tuple[list[_Block], str]:
    blocks = [
        _Block("python", html.unescape(re.sub(r"</?\w[^>]*>", "", m[2])).strip("\n"))
        for m in _HTML.finditer(text)
    ]
    return [block for block in blocks if "\n" in block.code], _HTML.sub("", text)


def _unwrapped_json(text: str) -> str:
    """A reply that is one JSON object with the code in it becomes a fenced one."""
    stripped = re.sub(r"^\s*```json\s*|\s*```\s*$", "", text).strip() if "{" in text else ""
    if not (stripped.startswith("{") and stripped.endswith("}")):
        return text
    try:
        data = json.loads(stripped, strict=False)
    except (ValueError, RecursionError):
        return text
    code = next((data[key] for key in _CODE_KEYS if isinstance(data.get(key), str)), None)
    if code is None:
        return text
    words = [value for key, value in data.items() if key not in _CODE_KEYS and isinstance(value, str)]
    return "\n".join(words) + "\n" + (code if "```" in code else f"~~~~~~python\n{code}\n~~~~~~")


# --- which of several ---


def _chosen(blocks: list[_Block]) -> str:
    """The block that is the program: the last of the best ones, or all of them where none is whole."""
    best = max(block.score for block in blocks)
    whole = [block.code for block in blocks if block.score == best]
    if len(blocks) == 1 or best >= 8:
        return whole[-1]
    joined = "\n\n".join(block.code for block in blocks if not _NOT_A_NODE.search(block.code))
    return joined if "rclpy" in joined and _parses(joined) else whole[-1]


# --- no fence at all ---


def _bare(text: str) -> Extracted | None:
    """Code that begins at a line that can only be Python, up to the last line that still belongs to it."""
    lines = text.split("\n")
    begin = next((at for at, line in enumerate(lines) if _is_bare_begin(line)), None)
    if begin is None:
        return None
    end = _bare_end(lines, begin)
    prose = "\n".join([*lines[:begin], *lines[end:]])
    return Extracted(_mended("\n".join(lines[begin:end])), _described(prose))


def _is_bare_begin(line: str) -> bool:
    line = _PROMPTED.sub("", _NUMBERED.sub("", line)).strip()
    if re.fullmatch(r"import [\w.]+(?: as \w+)?(?:, ?[\w.]+)*|from [\w.]+ import [\w ,*()]+", line):
        return True
    return bool(re.fullmatch(r"class \w+(?:\([\w., ]*\))?:|def \w+\(.*\).*:|#!\s*/.*python.*", line))


def _bare_end(lines: list[str], first_line: int) -> int:
    """Prose at the end is cut off piece by piece, as long as what is left does not parse."""
    ends = [
        at for at in range(first_line + 1, len(lines) + 1) if at == len(lines) or not lines[at - 1].strip()
    ]
    for end in reversed(ends[-200:]):
        if _parses(_mended("\n".join(lines[first_line:end]))):
            return end
    last = max(at for at in range(first_line, len(lines)) if at == first_line or _looks_like_code(lines[at]))
    return last + 1


def _looks_like_code(line: str) -> bool:
    return bool(re.match(r"\s+\S|.*[:=()\[\]#]\s*$|.*\w\(.*\)", line)) or bool(_BEGINS.match(line))


# --- mending ---


def _mended(code: str) -> str:
    """Prompts, line numbers, common indentation and curly quotes taken away, as far as they are no part of it."""
    lines = code.expandtabs(8).split("\n") if "\t" in code and not _parses(code) else code.split("\n")
    said = [line for line in lines if line.strip()]
    if said and all(_NUMBERED.match(line) for line in said):
        lines = [_NUMBERED.sub("", line) for line in lines]
    if any(line.startswith(">>> ") for line in said):
        lines = [_PROMPTED.sub("", line) for line in lines if _PROMPTED.match(line)]
    code = textwrap.dedent("\n".join(lines)).strip("\n") + "\n"
    if not _parses(code):
        straight = code.translate(_CURLY)
        code = straight if straight != code and _parses(straight) else code
    return code


def _parses(code: str) -> bool:
    try:
        ast.parse(code)
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return False
    return bool(code.strip())


def _described(prose: str) -> str:
    lines = [line.strip() for line in prose.split("\n")]
    text = re.sub(
        r"\n{2,}",
        "\n",
        "\n".join(line for line in lines if line.casefold() not in ("python", "copy code", "copy")),
    )
    return text.strip()[:MAX_DESCRIPTION_CHARS]
