"""What docs/models.md shows is what there is."""

from __future__ import annotations

import re
import sys
from pathlib import Path

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

import yaml

from chatrobot.cli.arguments import parse
from chatrobot.models.fake.script import Answer, HttpError, read_script
from chatrobot.models.providers import providers, split_name
from chatrobot.plan.text import parse_plan

PAGE = (Path(__file__).resolve().parents[2] / "docs" / "models.md").read_text(encoding="utf-8")


def blocks(kind: str) -> list[str]:
    return re.findall(rf"^```{kind}\n(.*?)^```", PAGE, re.DOTALL | re.MULTILINE)


def test_the_script_of_the_page_can_be_served() -> None:
    (text,) = blocks("yaml")
    script = read_script(yaml.safe_load(text))
    for said in ("go 3 metres", "a square", "hm"):
        assert parse_plan("".join(script.answer(said).tokens(said))).steps
    assert script.answer("busy").error == HttpError(429, "slow down", retry_after_s=20)


def test_every_field_of_a_reply_is_explained() -> None:
    fields = {name for name in Answer.__dataclass_fields__ if name not in ("text", "match", "times")}
    assert not [name for name in fields if f"`{name}" not in PAGE]


def test_every_provider_is_explained_with_its_key_and_its_command() -> None:
    for provider in providers().values():
        assert f"chatrobot model use {provider.name}:" in PAGE
        assert not [variable for variable in provider.key_variables[:1] if f"`{variable}" not in PAGE]
        assert provider.key_page in PAGE


def test_every_command_of_the_page_is_one() -> None:
    commands = re.findall(r"(?:^    |`)chatrobot (model[^`\n#]*)", PAGE, re.MULTILINE)
    assert len(commands) > 15
    for command in commands:
        words = [word for word in re.sub(r"[\[\]]", "", command).split() if word != "…"]
        args = parse(words)
        assert args.command == "model"
        if args.action == "use" and args.name not in ("none", "PROVIDER:NAME", ""):
            split_name(args.name)


def test_the_prices_of_the_page_can_be_read() -> None:
    (text,) = blocks("toml")
    assert tomllib.loads(text)["openai"]["gpt-99"]["reply"] == 8.0
