"""The programs that docs/agents.md shows drive the robot, and print what it says."""

from __future__ import annotations

import ast
import os
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from tests.docs.test_shown_output import ROOT
from tests.mcp_server.mcp_rig import HttpServer

pytestmark = pytest.mark.realtime
PAGE = (ROOT / "docs" / "agents.md").read_text(encoding="utf-8")
OVER_STDIO, OVER_HTTP = re.findall(r"^```python\n(.*?)^```", PAGE, re.DOTALL | re.MULTILINE)
(SHOWN,) = re.findall(r"^```text\n(.*?)^```", PAGE, re.DOTALL | re.MULTILINE)


def test_the_client_over_stdio_prints_what_the_page_shows(tmp_path: Path) -> None:
    script = tmp_path / "chatrobot"
    script.write_text(f'#!/bin/sh\nPYTHONPATH={ROOT / "src"} exec {sys.executable} -m chatrobot "$@"\n')
    script.chmod(0o755)
    check(printed(OVER_STDIO, {"HOME": str(tmp_path), "PATH": f"{tmp_path}:{os.environ['PATH']}"}))


def test_the_client_over_http_prints_the_same(tmp_path: Path) -> None:
    server = HttpServer(tmp_path)
    try:
        code = OVER_HTTP.replace("http://127.0.0.1:8765/mcp", server.url).replace("TOKEN", server.token)
        assert code != OVER_HTTP
        check(printed(code, {}))
    finally:
        server.close()


def printed(code: str, environment: dict[str, str]) -> dict[str, Any]:
    """What the program prints, read as Python."""
    run = subprocess.run(
        [sys.executable, "-c", code],
        env={**os.environ, **environment},
        check=True,
        stdout=subprocess.PIPE,
        text=True,
        timeout=60.0,
    )
    return dict(ast.literal_eval(run.stdout))


def check(told: dict[str, Any]) -> None:
    """It is what the page shows; a motion takes a moment more or less."""
    shown = ast.literal_eval(SHOWN)
    assert told.keys() == shown.keys()
    for key in ("outcome", "turn", "plan", "measured"):
        assert told[key] == shown[key]
    assert told["pose"].keys() == shown["pose"].keys()
    assert told["path_m"] == pytest.approx(shown["path_m"], abs=0.05)
