"""A real local model end to end: llama.cpp serves a tiny random one, held to a grammar of plan text; the robot drives.

Run by `make try-llamacpp`: the first time it builds llama.cpp, which takes minutes.
"""

from __future__ import annotations

import socket
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import chatrobot.api
from chatrobot.core.errors import ChatRobotError
from chatrobot.models.config import ModelConfig
from chatrobot.models.discovery import find_local
from chatrobot.models.make import make_model, warm
from chatrobot.models.providers import Provider, register
from chatrobot.models.seam import CallLimits, Message
from chatrobot.plan.text import parse_plan

ROOT = Path(__file__).parent.parent
PATIENCE_S = 120.0
GRAMMAR = r"""
root ::= step "\n" step "\n" step "\n"
step ::= drive | turn
drive ::= "drive " length " m" (" back")?
turn ::= "turn " ("left" | "right") " " [1-9] [0-9] " deg"
length ::= "0." [1-9]
"""
"""A part of the plan language (docs/plan-language.md) that ends: random weights never do."""


def main(python: str) -> int:
    """`python` is one that has llama-cpp-python[server] and gguf."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "tiny.gguf"
        subprocess.run([python, str(ROOT / "scripts" / "tiny_gguf.py"), str(path)], check=True)
        print(f"a model of {path.stat().st_size / 1e6:.1f} MB with random weights")
        port = _free_port()
        command = [
            python,
            "-m",
            "llama_cpp.server",
            "--model",
            str(path),
            "--port",
            str(port),
            "--chat_format",
            "chatml",
        ]
        with subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as server:
            try:
                return _try(f"http://127.0.0.1:{port}/v1", server)
            finally:
                server.terminate()


def _free_port() -> int:
    with socket.socket() as found:
        found.bind(("127.0.0.1", 0))
        port: int = found.getsockname()[1]
        return port


def _try(address: str, server: subprocess.Popen[bytes]) -> int:
    config = ModelConfig(environ={"LLAMACPP_BASE_URL": address}, keyring=False)
    name = _wait_for(config, server)
    print(f"llama.cpp serves {name} at {address}")
    register(
        Provider(
            "constrained", "llama.cpp, held to a grammar", needs_key=False, base_url=address,
            settings={"temperature": 1.0, "seed": 7, "extra_body": {"grammar": GRAMMAR}},
        )
    )  # fmt: skip
    model = make_model(f"constrained:{name}", config)
    warm(model, wait_s=PATIENCE_S)
    began_s = time.monotonic()
    reply = model.ask([Message("user", "dance a little")], CallLimits(reply_tokens=200))
    text = "".join(reply)
    print(f"it said, in {time.monotonic() - began_s:.2f} s ({reply.usage}):\n{text}")
    with chatrobot.api.connect(world="empty", fast=True) as robot:
        result = robot.run(parse_plan(text))
    print(f"the robot: {result.outcome}: {result.reply}")
    return 0 if result.outcome == "completed" else 1


def _wait_for(config: ModelConfig, server: subprocess.Popen[bytes]) -> str:
    ends_s = time.monotonic() + PATIENCE_S
    while time.monotonic() < ends_s and server.poll() is None:
        for found in find_local(config):
            if found.provider == "llamacpp":
                return found.models[0]
        time.sleep(0.5)
    raise ChatRobotError("the llama.cpp server did not start")


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
