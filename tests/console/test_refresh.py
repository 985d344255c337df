"""The strip is drawn anew by the thread that draws, whoever asks for it."""

from __future__ import annotations

import asyncio
import threading
from types import SimpleNamespace

from prompt_toolkit.application import create_app_session
from prompt_toolkit.input import DummyInput
from prompt_toolkit.output import DummyOutput

from chatrobot.cli.console.chat import Chat


def test_another_thread_never_touches_the_prompt_itself(controller, monkeypatch):
    """prompt_toolkit's `invalidate` fails where the prompt ends meanwhile, and the pump's thread would end with it."""
    monkeypatch.setattr(
        controller.session,
        "understanding",
        SimpleNamespace(place_names=list, can_do=lambda _: True),
        raising=False,
    )
    with create_app_session(input=DummyInput(), output=DummyOutput()):
        chat = Chat(controller, None, lambda: None)
    threads = []
    monkeypatch.setattr(chat._prompt.app, "invalidate", lambda: threads.append(threading.current_thread()))

    async def refresh_from_elsewhere():
        chat._loop = asyncio.get_running_loop()
        await asyncio.to_thread(chat.refresh)
        await asyncio.sleep(0)
        chat._loop = None
        await asyncio.to_thread(chat.refresh)

    asyncio.run(refresh_from_elsewhere())
    assert threads == [threading.main_thread()]
    chat._proxy.close()
