"""While a model thinks the console counts the seconds, for a plan and for a program; nothing here sleeps."""

import os

import pytest

from tests.console.terminal import console
from tests.models.rig import KEY, serving

pytestmark = pytest.mark.realtime

THINKING = r"the model is thinking, {} s"
FIRST_PIECE_S = 1.5
REPLIES = [{"match": "nice", "text": "drive 0.2 m\n"}, {"match": "program", "text": "I cannot."}]


@pytest.fixture
def chat(tmp_path):
    with serving(REPLIES, first_piece_s=FIRST_PIECE_S) as fake:
        own = {"OPENAI_BASE_URL": f"{fake.url}/v1", "OPENAI_API_KEY": KEY}
        own["PYTHON_KEYRING_BACKEND"] = "keyring.backends.fail.Keyring"
        options = ("--model", "openai:fake", "--world", "empty")
        with console(tmp_path, *options, environment={**os.environ, **own}) as terminal:
            terminal.wait_for("standing · ")
            yield terminal


def shows(chat, seconds):
    chat.wait_for(THINKING.format(seconds))
    assert any("thinking" in line for line in chat.shown)


def test_the_strip_counts_the_seconds_of_a_plan_and_is_quiet_after_it(chat):
    chat.enter("do something nice for me")
    shows(chat, 0)
    shows(chat, 1)
    chat.wait_for("drove 0.20 m")
    chat.wait_for("standing · ")
    assert not any("thinking" in line for line in chat.shown)


def test_it_counts_while_a_program_is_written(chat):
    chat.enter("/program that does a nice pirouette of seven quarters")
    shows(chat, 0)
    shows(chat, 1)
