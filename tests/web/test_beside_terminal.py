"""`chatrobot --web`: one conversation, at the terminal and in a browser."""

from __future__ import annotations

import re
import sys
from pathlib import Path

import pytest
from websockets.sync.client import connect

from tests.console.terminal import Terminal
from tests.web.rig import Client

pytestmark = pytest.mark.realtime
PATIENCE_S = 60.0


def test_both_hear_what_is_said_at_either(tmp_path: Path) -> None:
    config = ["--world", "empty", "--config-dir", str(tmp_path)]
    with Terminal([sys.executable, "-m", "chatrobot", "--web", *config]) as terminal:
        terminal.wait_for("In a browser: http://", PATIENCE_S)
        found = re.search(r"127\.0\.0\.1:(\d+)/", terminal.text)
        assert found is not None
        address, origin = f"ws://127.0.0.1:{found[1]}/ws", f"http://127.0.0.1:{found[1]}"
        with connect(address, origin=origin, proxy=None, close_timeout=0.5) as socket:  # type: ignore[arg-type]
            page = Client(socket)
            page.wait_for("hello")
            page.hold()
            page.say("say", text="turn left 10 degrees")
            terminal.wait_for("page 1: turn left 10 degrees", PATIENCE_S)
            terminal.wait_for("Done: ", PATIENCE_S)
            assert page.wait_for_event("result", PATIENCE_S)["event"]["outcome"] == "completed"
            terminal.enter("turn right 10 degrees")
            assert page.wait_for("said", PATIENCE_S, by="terminal")["text"] == "turn right 10 degrees"
            assert page.wait_for_event("result", PATIENCE_S)["event"]["outcome"] == "completed"
            page.say("emergency_stop")
            terminal.wait_for("EMERGENCY STOP", PATIENCE_S)
            terminal.enter("/release")
            page.wait_for("emergency", PATIENCE_S, set=False)
            terminal.type("\x04")
            assert page.wait_for("gone", PATIENCE_S)["what"] == "server"
        assert terminal.wait_for_end(PATIENCE_S) == 0
