"""Patterns of the data files, each compiled once a text comes that it may match.

To compile all of them takes longer than to read a sentence. A pattern is tried only on a text that has the words which
every match needs; which words those are is read off the pattern. A Chinese character is a word.
"""

from __future__ import annotations

import re
from collections import Counter, defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import cache, cached_property

from chatrobot.language.compiled import compiled
from chatrobot.language.data_files import LANGUAGES, in_full, load_table
from chatrobot.language.numbers import is_chinese

_LEAST_WORTH, _MOST_NEEDS = 2, 3
_TOKEN = re.compile(
    r"\\(?P<escaped>.)|(?P<set>\[\^?\]?(?:\\.|[^\]\\])*\])|(?P<around>\(\?(?:[=!]|<[=!]|\(\w+\)))|\(\?P=\w+\)(?P<back>)"
    r"|(?P<open>\((?:\?(?::|P<\w+>))?)|(?P<close>\))|(?P<or>\|)|(?P<repeat>(?:[*+?]|\{\d*(?:,\d*)?\})[?+]?)"
    r"|(?P<any>[.^$])|(?P<char>.)",
    re.DOTALL,
)
_RANGE = re.compile(r"\\|.-.|^\^")
"""What a set holds that is more than its characters."""
Needed = frozenset[str]
"""Words of which every match has one at least."""


class Form:
    """A pattern, which answers what `re.Pattern` of that name would."""

    def __init__(self, source: str, needs: Sequence[Sequence[str]] = ()) -> None:
        self._source, self.needs = source, needs
        self._is_tried = not needs

    @cached_property
    def pattern(self) -> re.Pattern[str]:
        """The pattern, compiled at the first look."""
        return re.compile(self._source)

    def search(self, text: str, at: int = 0) -> re.Match[str] | None:
        """Return the first match in `text` from `at` on."""
        return self.pattern.search(text, at) if self._is_tried or self._may_match(text) else None

    def match(self, text: str, at: int = 0) -> re.Match[str] | None:
        """Return the match that begins at `at`."""
        return self.pattern.match(text, at) if self._is_tried or self._may_match(text) else None

    def fullmatch(self, text: str) -> re.Match[str] | None:
        """Return the match that is all of `text`."""
        return self.pattern.fullmatch(text) if self._is_tried or self._may_match(text) else None

    def sub(self, put: str | Callable[[re.Match[str]], str], text: str, count: int = 0) -> str:
        """Return `text` with `put` in place of each match, or of the first `count`."""
        return self.pattern.sub(put, text, count=count) if self.search(text) else text

    def _may_match(self, text: str) -> bool:
        for needed in self.needs:
            for word in needed:  # `any` would take three times as long, and most stop here
                if word in text:
                    break
            else:
                return False
        self._is_tried = True
        return True


class Rule(Form):
    """A pattern, and what is put in place of what it matches."""

    def __init__(self, source: str, said: str, needs: Sequence[Sequence[str]]) -> None:
        super().__init__(source, needs)
        self.said = said

    def is_in(self, text: str) -> bool:
        """Return whether it matches somewhere in `text`."""
        return self.search(text) is not None

    def applied(self, text: str) -> str:
        """Return `text` with each match replaced."""
        if not (self._is_tried or self._may_match(text)):
            return text
        # Most do not match, and to prepare what is put there takes longer than to see that.
        return self.pattern.sub(self.said, text) if self.pattern.search(text) else text


class Rules:
    """Rules in their order. Only those are tried on a text that it has a piece of, which a match of them needs: two
    letters, or a Chinese character."""

    def __init__(self, listed: Sequence[Rule]) -> None:
        self._rules = tuple(listed)
        self._unbound, self._by_piece = 0, defaultdict[str, int](int)
        first = [rule.needs[0] if rule.needs else () for rule in listed]
        counts = Counter(piece for needed in first for word in needed for piece in _pieces(word))
        for number, needed in enumerate(first):
            if not needed:
                self._unbound |= 1 << number
            for word in needed:
                self._by_piece[min(_pieces(word), key=counts.__getitem__)] |= 1 << number

    def __iter__(self) -> Iterator[Rule]:
        return iter(self._rules)

    def that_may_match(self, text: str) -> Iterator[Rule]:
        """Yield each rule that may match."""
        tried = self._tried(text)
        while tried:
            yield self._rules[(tried & -tried).bit_length() - 1]
            tried &= tried - 1

    def applied(self, text: str) -> str:
        """Return `text` with each match of each rule replaced, rule by rule."""
        tried = self._tried(text)
        while tried:
            number = (tried & -tried).bit_length() - 1
            tried &= tried - 1
            changed = self._rules[number].applied(text)
            if changed != text:  # it may match other rules now
                text = changed
                tried = self._tried(text) >> (number + 1) << (number + 1)
        return text

    def any_in(self, text: str) -> bool:
        """Return whether any of them matches somewhere in `text`."""
        return any(rule.is_in(text) for rule in self.that_may_match(text))

    def _tried(self, text: str) -> int:
        tried = self._unbound
        for piece in _pieces(text):
            tried |= self._by_piece.get(piece, 0)
        return tried


def _pieces(text: str) -> set[str]:
    pairs = {text[at : at + 2] for at in range(len(text) - 1)}
    return pairs if text.isascii() else pairs.union(filter(is_chinese, text))


NEVER = Form("(?!)")
"""What `form` answers where a language has none of that name."""


@cache
def forms(language: str, table: str, name: str) -> tuple[Form, ...]:
    """The patterns that a table lists under a name, with its `[parts]` put in; none where that language has none.

    A language that is put into English words has the English ones where its table has none of that name.
    """

    def sources() -> list[str]:
        found = load_table(language, table)
        if name not in found and language not in LANGUAGES:
            found = load_table(LANGUAGES[0], table)
        listed = found.get(name, ())
        listed = [listed] if isinstance(listed, str) else listed
        return [in_full(pattern, found.get("parts", {})) for pattern in listed]

    return forms_of(f"{table}_{language}_{name}", sources)


def form(language: str, table: str, name: str) -> Form:
    """The one pattern under that name; one that never matches where that language has none."""
    return next(iter(forms(language, table, name)), NEVER)


def forms_of(name: str, sources: Callable[[], Iterable[str]]) -> tuple[Form, ...]:
    """Return the patterns of these sources, in order.

    Args:
        name: of the file in the cache folder where they, and what each needs, are kept.
    """

    def build() -> tuple[tuple[str, _Kept], ...]:
        return tuple((source, _kept(source)) for source in sources())

    return tuple(Form(*one) for one in compiled(f"forms_{name}", build))


def rules(name: str, listed: Iterable[Sequence[str]], parts: Mapping[str, str]) -> Rules:
    """Return rules from pairs of a pattern (`<part>` stands for one of `parts`) and what takes its place, in order.

    Args:
        name: of the file in the cache folder where the patterns in full, and what each needs, are kept.
    """

    def build() -> tuple[tuple[str, str, _Kept], ...]:
        full = ((in_full(pattern, parts), said) for pattern, said in listed)
        return tuple((pattern, said, _kept(pattern)) for pattern, said in full)

    return Rules([Rule(*one) for one in compiled(name, build)])


_Kept = tuple[tuple[str, ...], ...]


def _kept(pattern: str) -> _Kept:
    return tuple(tuple(sorted(needed)) for needed in needs_of(pattern))


def needs_of(pattern: str) -> tuple[Needed, ...]:
    """Return what every match of a pattern needs, the rarest first; nothing where that cannot be told."""
    found, _ = _alternatives(list(_TOKEN.finditer(pattern)), 0)
    return found[:_MOST_NEEDS]


def _alternatives(tokens: list[re.Match[str]], at: int) -> tuple[tuple[Needed, ...], int]:
    """What a group needs, from its first token on, and where it ends: the rarest of each alternative."""
    found: list[tuple[Needed, ...]] = []
    while True:
        one, at = _sequence(tokens, at)
        found.append(one)
        if at >= len(tokens) or tokens[at]["or"] is None:
            break
        at += 1
    if len(found) == 1:
        return found[0], at
    return ((frozenset().union(*(one[0] for one in found)),) if all(found) else ()), at


def _sequence(tokens: list[re.Match[str]], at: int) -> tuple[tuple[Needed, ...], int]:
    """What one alternative needs, the rarest first, and where it ends."""
    found: list[Needed] = []
    run = ""
    while at < len(tokens) and tokens[at]["or"] is None and tokens[at]["close"] is None:
        token, last = tokens[at], at + 1
        char, group = "", tuple[Needed, ...]()
        if token["char"] is not None:
            char = token["char"]
        elif token["escaped"] is not None and not token["escaped"].isalnum():
            char = token["escaped"]
        elif token["set"] is not None and not _RANGE.search(token["set"][1:-1]):
            group = (frozenset(token["set"][1:-1]),)
        elif token["open"] or token["around"]:
            group, last = _alternatives(tokens, at + 1)
            last += 1
            group = group if token["open"] or token["around"] in _FOLLOWED else ()
        repeat = tokens[last]["repeat"] if last < len(tokens) else None
        at = last + (repeat is not None)
        if repeat is not None and (repeat[0] in "*?" or repeat.startswith(("{0", "{,"))):
            char, group = "", ()
        run += char
        if not char or repeat is not None:
            found, run = [*found, frozenset({run})], ""
        found += group
    rare = {needed for needed in (*found, frozenset({run})) if _worth(needed) >= _LEAST_WORTH}
    return tuple(sorted(rare, key=lambda needed: (-_worth(needed), len(needed), sorted(needed)))), at


_FOLLOWED = ("(?=", "(?<=")


def _worth(needed: Needed) -> int:
    """How rare a text is that has one of them: as the shortest of them is long, and a Chinese character as two."""
    return min(sum(1 + is_chinese(character) for character in word) for word in needed)
