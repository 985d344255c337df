"""No key, token or value of the environment gets into a recording, however it came there."""

from __future__ import annotations

from pathlib import Path

import pytest
from mcap.reader import make_reader

from chatrobot.core.events import Notice, ProgramLog, ProgramWritten
from chatrobot.core.reason import Reason
from chatrobot.models.secret import HIDDEN
from chatrobot.recording.recorder import Recorder
from chatrobot.recording.redactor import Redactor

IN_USE = "k3y-in-use/\"with'quotes\\and\\backslashes"
TOKEN = "pageTokenOf_30.letters-and-more"
ENVIRONMENT = {
    "OPENAI_API_KEY": "not-like-a-key-at-all",
    "DB_PASSWORD": "пароль mit ü und leer",
    "GITHUB_TOKEN": "plain0words0here",
    "DATABASE_URL": "postgres://anna:s3cr3tpass@db.example/robots",
    "PWD": "/home/anna/robots",
    "LANG": "en_US.UTF-8",
    "SHORT_KEY": "none",
}
LOOKS = (
    "sk-proj-abcdefghijklmnop", "ghp_0123456789abcdefghijABCDEFGHIJ", "AKIAIOSFODNN7EXAMPLE",
    "eyJhbGciOiJIUzI1NiJ9.eyJzdWIiOiIxMjM0In0.abcdefghijk",
)  # fmt: skip
SECRETS = (
    IN_USE, TOKEN, "not-like-a-key-at-all", "пароль mit ü und leer", "plain0words0here", "s3cr3tpass", *LOOKS,
)  # fmt: skip


def test_planted_secrets_are_in_no_byte_of_the_file(tmp_path: Path) -> None:
    known_later: list[str] = []
    recorder = Recorder(tmp_path / "a.mcap", Redactor(lambda: known_later, ENVIRONMENT))
    recorder.start(lambda: {"on": f"rosbridge:ws://{TOKEN}@robot", "title": "the robot"})
    known_later += [IN_USE, TOKEN]
    for number, secret in enumerate(SECRETS, start=1):
        text = f"see {secret}" if secret != "s3cr3tpass" else f"see {ENVIRONMENT['DATABASE_URL']}"
        recorder.said(number, text)
        recorder.hear(Notice(number, Reason("model_refused", {"said": f"wrong: {text!r}"}), text))
        source = f"import os\nkey = {text!r}\nprint(key)  # {text}\n"
        recorder.hear(ProgramWritten(number, "p", "model", source, diff=f"+{source}"))
        recorder.hear(ProgramLog(number, 0.1, "info", f"log: {text!r} {[text]!r}"))
    recorder.said(99, "drive to the kitchen in /home/anna/robots, none of en_US.UTF-8")
    recorder.close()
    found = _text_of(recorder.path)
    for secret in SECRETS:
        for form in (secret, repr(secret)[1:-1], secret.encode("unicode_escape").decode()):
            assert form not in found, form
    assert found.count(HIDDEN) >= 4 * len(SECRETS)
    assert "drive to the kitchen in /home/anna/robots, none of en_US.UTF-8" in found
    assert "the robot" in found


def _text_of(path: Path) -> str:
    with path.open("rb") as file:
        reader = make_reader(file)
        parts = [bytes(message.data) for _, _, message in reader.iter_messages()]
        about = [str(record.metadata) for record in reader.iter_metadata()]
    return "\n".join([*(part.decode("utf-8", "replace") for part in parts), *about])


@pytest.mark.parametrize(
    "harmless",
    [
        "forward 1 m then turn left, 前进一米",
        '{"event":"result","turn":1,"pose":{"x_m":1.0,"yaw_rad":0.0}}',
        "http://127.0.0.1:8080/ and dds://42/robot1",
    ],
)
def test_ordinary_texts_pass_unchanged(harmless: str) -> None:
    assert Redactor(tuple, {"MY_KEY": "x", "API_TOKEN": "   "})(harmless) == harmless
