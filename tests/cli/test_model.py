"""`chatrobot model`, `usage` and `fake-model`, as a person uses them."""

from __future__ import annotations

import contextlib
import json
import os
import signal
import subprocess
import sys
import threading
import urllib.request
from collections.abc import Iterator
from pathlib import Path

import pexpect
import pytest

from chatrobot.cli.entry import main
from chatrobot.models.fake.server import FakeModel
from tests.cli.running import PATIENCE_S, Command, environment
from tests.models.rig import KEY, serving

PLAN = "drive 1 m\nturn left 90 deg"
REPLIES = [{"match": "one metre", "text": PLAN, "prompt_tokens": 40}]


@pytest.fixture
def fake(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Iterator[FakeModel]:
    with serving(REPLIES, keys=[KEY]) as fake:
        for name in [
            name for name in os.environ if name.endswith(("_API_KEY", "_BASE_URL")) or "CHATROBOT" in name
        ]:
            monkeypatch.delenv(name)
        monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path))
        monkeypatch.setenv("OPENAI_BASE_URL", f"{fake.url}/v1")
        monkeypatch.setenv("PYTHON_KEYRING_BACKEND", "keyring.backends.fail.Keyring")
        yield fake


def test_a_model_is_chosen_tried_and_counted(
    fake: FakeModel, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    monkeypatch.setenv("OPENAI_API_KEY", KEY)
    assert main(["model", "use", "openai:fake"]) == 0
    said = capsys.readouterr().out
    assert "drive 1 m" in said
    assert "40 + " in said
    assert main(["model", "test", "--json"]) == 0
    tested = json.loads(capsys.readouterr().out)
    assert (tested["model"], tested["text"], tested["keeps_to_the_form"]) == ("openai:fake", PLAN, True)
    assert main(["usage", "--by", "model", "--json"]) == 0
    (line,) = capsys.readouterr().out.splitlines()
    assert json.loads(line)["calls"] == len(fake.calls) == 2
    assert main(["usage"]) == 0
    assert "model test" in capsys.readouterr().out
    assert main(["model", "list"]) == 0
    listed = capsys.readouterr().out
    assert "in use: openai:fake (stored)" in listed
    assert "key: environment" in listed
    assert main(["model", "list", "openai"]) == 0
    assert "openai:fake" in capsys.readouterr().out.split()
    assert main(["model", "use", "none"]) == 0
    assert main(["model", "test"]) == 2
    kept = [file.read_text(encoding="utf-8") for file in tmp_path.rglob("*") if file.is_file()]
    assert kept
    assert not [text for text in kept if KEY in text]


def test_what_is_wrong_is_said_with_the_way_out(fake: FakeModel, capsys: pytest.CaptureFixture[str]) -> None:
    for arguments, code, said in (
        (["model", "test", "openai:fake"], 1, "OPENAI_API_KEY"),
        (["model", "test", "nobody:x"], 1, "PROVIDER:NAME"),
        (["model", "use", "gpt-5"], 2, "PROVIDER:NAME"),
        (["model", "use"], 2, "use none"),
        (["model", "test"], 2, "PROVIDER:NAME"),
        (["model", "key", "nobody"], 2, "openrouter"),
        (["model", "key", "openai", "--delete"], 2, "export OPENAI_API_KEY"),
        (["model", "list", "nobody"], 2, "openrouter"),
        (["fake-model", "no-such.yaml"], 2, "no-such.yaml"),
    ):
        assert main(arguments) == code, arguments
        assert said in capsys.readouterr().err
    assert not fake.calls


def test_doctor_tells_the_state_of_the_model(fake: FakeModel, monkeypatch: pytest.MonkeyPatch) -> None:
    import argparse

    from chatrobot.cli.doctor import _model

    args = argparse.Namespace(config_dir=None, model="")
    assert _model(args).state == "later"
    monkeypatch.setenv("CHATROBOT_MODEL", "openai:fake")
    assert _model(args).state == "missing"
    assert "OPENAI_API_KEY" in _model(args).text
    monkeypatch.setenv("OPENAI_API_KEY", KEY)
    assert _model(args).state == "ok"
    assert KEY not in _model(args).text
    assert not fake.calls, "a look costs nothing"


@pytest.mark.realtime
def test_the_wizard_finds_what_runs_here_and_sets_it_up(fake: FakeModel, tmp_path: Path) -> None:
    del tmp_path
    env = {**environment(Path(os.environ["XDG_CONFIG_HOME"])), "OLLAMA_HOST": fake.url, "OLLAMA_API_KEY": KEY}
    child = pexpect.spawn(
        sys.executable, ["-m", "chatrobot", "model"], env=env, encoding="utf-8", timeout=PATIENCE_S
    )
    child.expect(r"(\d+)  ollama:fake  \(on this machine")
    assert child.match is not None
    number = child.match[1]
    child.expect("number")
    child.sendline("0")
    child.expect("number")
    child.sendline(number)
    child.expect("ollama:fake is your model")
    child.expect("no cost")
    child.expect(pexpect.EOF)
    child.close()
    assert child.exitstatus == 0


@pytest.mark.realtime
def test_a_fake_model_serves_until_ctrl_c(tmp_path: Path, chatrobot: Command) -> None:
    script = tmp_path / "script.yaml"
    script.write_text("model: parrot\nreplies:\n  - match: ''\n    text: drive 1 m\n", encoding="utf-8")
    with subprocess.Popen(
        [sys.executable, "-m", "chatrobot", "fake-model", str(script), "--port", "0", "--json"],
        stdout=subprocess.PIPE,
        env=environment(chatrobot.folder),
        text=True,
    ) as process:
        assert process.stdout is not None
        ready = json.loads(process.stdout.readline())
        with contextlib.closing(urllib.request.urlopen(f"{ready['url']}/v1/models", timeout=10)) as answer:
            assert json.load(answer)["data"][0]["id"] == ready["model"] == "parrot"
        process.send_signal(signal.SIGINT)
        assert process.wait(PATIENCE_S) == 5


def test_the_key_that_a_script_asks_for_is_the_key_that_is_shown(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    script = tmp_path / "script.yaml"
    script.write_text("keys: [sk-demo]\nreplies:\n  - text: x\n", encoding="utf-8")

    def wait(_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(threading.Event, "wait", wait)
    monkeypatch.setattr(FakeModel, "start", lambda _: None)
    monkeypatch.setattr(FakeModel, "stop", lambda _: None)
    monkeypatch.setattr(FakeModel, "url", "http://127.0.0.1:1")
    main(["fake-model", str(script)])
    assert "OPENAI_API_KEY=sk-demo\n" in capsys.readouterr().out


def test_beyond_loopback_a_token_is_asked_for(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    script = tmp_path / "script.yaml"
    script.write_text("- {match: '', text: x}\n", encoding="utf-8")
    seen: list[FakeModel] = []

    def start(fake: FakeModel) -> None:
        seen.append(fake)
        raise OSError(98, "in use")

    monkeypatch.setattr(FakeModel, "start", start)
    assert main(["fake-model", str(script), "--host", "0.0.0.0"]) == 2
    assert main(["fake-model", str(script)]) == 2
    assert [len(fake.script.keys) for fake in seen] == [1, 0]
    assert len(seen[0].script.keys[0]) > 20
