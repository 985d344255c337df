"""docs/cli.md and docs/events.md say what the code does, and every key of every JSON object is explained."""

from __future__ import annotations

import json
import re
import urllib.request
from collections.abc import Iterator
from pathlib import Path
from typing import Any, get_args, get_type_hints

import pytest
import yaml
from scripts import make_reference as reference

from chatrobot.cli.entry import main
from chatrobot.core.event import Event
from chatrobot.programs.library import KeptProgram, Library
from tests.cli.running import Command, chatrobot
from tests.models.rig import KEY, serving

__all__ = ["chatrobot"]
MEANINGS = reference.read_meanings()
COMMANDS: dict[str, dict[str, Any]] = MEANINGS["commands"]
TYPES: dict[str, tuple[type, ...]] = {
    "s": (str,), "i": (int,), "n": (float, int), "b": (bool,), "l": (list,), "o": (dict,),
}  # fmt: skip
FOR_OURSELVES = {"CHATROBOT_ID"}
"""What our processes tell each other."""
LESSON = """\
{title: a, world: empty, tasks: [{title: a, task: b, check: {path_m: {at_least: 0.1}},
  solution: {en: forward 20 cm}}]}
"""
CORPUS = """\
- {id: t-1, category: primitive, say: forward 1 m, expect: {x: 1.0}}
"""


@pytest.mark.parametrize("page", list(reference.PAGES), ids=lambda page: page.name)
def test_a_page_is_what_the_code_says(page: Path) -> None:
    assert page.read_text(encoding="utf-8") == reference.PAGES[page](), "make reference"


@pytest.mark.parametrize("kind", reference.event_types(), ids=lambda kind: kind.name)
def test_every_key_of_an_event_has_a_meaning(kind: type[Event]) -> None:
    said = {**MEANINGS["every"], **MEANINGS.get(kind.name, {})}
    hints = get_type_hints(kind)
    assert not [key for key in reference.keys_of(kind) if key not in said]
    told = [key for key in reference.keys_of(kind) if key not in kind.unmeasured]
    optional = [key for key in told if type(None) in get_args(hints[key])]
    assert not [key for key in optional if "null" not in said[key]]


def test_no_meaning_is_of_a_key_that_is_gone() -> None:
    known = {kind.name: {"about", *reference.keys_of(kind)} for kind in reference.event_types()}
    everywhere = set().union(*known.values())
    assert set(MEANINGS) == {"every", "commands"} | {name for name in MEANINGS if name in known}
    assert set(MEANINGS["every"]) <= everywhere
    assert not [f"{name}.{key}" for name in known for key in MEANINGS.get(name, {}) if key not in known[name]]


def test_neither_page_says_that_the_time_driven_contains_the_time_stood() -> None:
    """As `tests/motion/test_pause.py` measures them."""
    for name in ("finished", "result"):
        said = {**MEANINGS["every"], **MEANINGS[name]}
        assert "without the time in which it stood" in said["duration_s"]
        assert "no part of `duration_s`" in said["paused_s"]
    page = (reference.ROOT / "docs" / "python-api.md").read_text(encoding="utf-8")
    assert (
        "| `duration_s`, `paused_s` | how long the robot was driven; and, no part of it, how long it stood"
        in page
    )


def test_every_variable_of_ours_that_a_person_sets_is_told() -> None:
    ours = {
        name
        for file in (reference.ROOT / "src").rglob("*.py")
        for name in re.findall(r"\bCHATROBOT_[A-Z_]+\b", file.read_text(encoding="utf-8"))
    }
    assert ours - FOR_OURSELVES == {name for name in reference.VARIABLES if name.startswith("CHATROBOT_")}


@pytest.fixture
def objects(
    chatrobot: Command, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> list[dict[str, Any]]:
    """What every command prints with `--json` that drives nothing."""
    folder = tmp_path / "settings"
    Library(folder).keep(KeptProgram("square", "print(1)\n", "a square"))
    corpus = tmp_path / "corpus.yaml"
    corpus.write_text(CORPUS, encoding="utf-8")
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path))
    where = ("--json", "--config-dir", str(folder))
    with serving([{"match": "one metre", "text": "drive 1 m"}], keys=[KEY]) as fake:
        monkeypatch.setenv("OPENAI_BASE_URL", f"{fake.url}/v1")
        monkeypatch.setenv("OPENAI_API_KEY", KEY)
        for model in ("openai:fake", "openai:"):
            main(["model", "test", "--model", model, *where])
        for command in ("robots", "worlds", "doctor", "usage", "program list", "program show square"):
            main([*command.split(), *where])
    main(["eval", str(corpus), "--json"])
    sheet, lines = tmp_path / "lesson.yaml", tmp_path / "lines.txt"
    sheet.write_text(LESSON, encoding="utf-8")
    lines.write_text("forward 20 cm\n", encoding="utf-8")
    for words in (
        ["world", "check", str(corpus)],
        ["lesson"],
        ["lesson", str(sheet), "--check", str(lines)],
        ["lesson", str(sheet), "--test"],
    ):
        main([*words, "--json"])
    printed = [json.loads(line) for line in capfd.readouterr().out.splitlines()]
    return [*printed, *_of_a_fake_model(chatrobot, tmp_path)]


def _of_a_fake_model(chatrobot: Command, folder: Path) -> Iterator[dict[str, Any]]:
    script = folder / "script.yaml"
    script.write_text(yaml.safe_dump({"replies": [{"text": "drive 1 m"}]}), encoding="utf-8")
    with chatrobot.start("fake-model", str(script), "--port", "0", "--json") as running:
        listening = running.event("listening")
        yield listening
        body = json.dumps(
            {"model": listening["model"], "messages": [{"role": "user", "content": "go"}]}
        ).encode()
        request = urllib.request.Request(
            f"{listening['url']}/v1/chat/completions", body, {"Content-Type": "application/json"}
        )
        urllib.request.urlopen(request, timeout=10.0).read()
        yield running.event("call")


def test_the_objects_of_other_commands_are_as_told(objects: list[dict[str, Any]]) -> None:
    assert {each["event"] for each in objects} == set(COMMANDS)
    for each in objects:
        told = {key: kind for key, kind in COMMANDS[each["event"]].items() if key != "command"}
        assert set(each) - {"event"} <= set(told), each
        for key, (kind, _) in told.items():
            value = each.get(key)
            assert isinstance(value, TYPES[kind[0]]) or (kind.endswith("?") and value is None), (key, each)
