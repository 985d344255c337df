"""What all tests share: a busy machine is no reason for a property to fail, so hypothesis sets no deadline."""

from __future__ import annotations

import atexit
import gc
import os
import shutil
import signal
import tempfile

import pytest

try:
    from hypothesis import settings
except ImportError:
    pass  # tests/ros runs beside ROS with nothing else installed, and needs none
else:
    settings.register_profile("chatrobot", deadline=None)
    settings.load_profile("chatrobot")
    # For `make mutants`: a thousand runs with few examples each, the same ones every time.
    settings.register_profile("mutants", deadline=None, max_examples=30, derandomize=True, database=None)

# Under `nohup`, or in the background of a script, these are ignored, and stay so in every process that a test starts.
for number in (signal.SIGHUP, signal.SIGINT):
    if signal.getsignal(number) is signal.SIG_IGN:
        signal.signal(number, signal.SIG_DFL if number is signal.SIGHUP else signal.default_int_handler)

# Hundreds of tests start a process of ours; where none may keep its bytecode, each compiles all of it anew.
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)

# No robot of a test may be found by a stop, or by an agent, of another one, or of whoever works on this machine.
os.environ["XDG_RUNTIME_DIR"] = tempfile.mkdtemp(prefix="robots-")
atexit.register(shutil.rmtree, os.environ["XDG_RUNTIME_DIR"], ignore_errors=True)

# Nine thousand collected tests are no garbage: looked through again and again, they took a twelfth of the whole time.
gc.disable()


@pytest.fixture(autouse=True)
def speaks_for_the_console(monkeypatch: pytest.MonkeyPatch) -> None:
    """A node, a command and `connect` say for their whole process which face people read."""
    monkeypatch.setattr("chatrobot.language.typed._face", "console")


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """`make test` looks for tests in real time only in files that name the marker."""
    files = {item.path for item in items if item.get_closest_marker("realtime")}
    nameless = [str(path) for path in files if "mark.realtime" not in path.read_text(encoding="utf-8")]
    if nameless:
        raise pytest.UsageError(
            f"name pytest.mark.realtime in {', '.join(sorted(nameless))}: make test misses it"
        )


def pytest_collection_finish() -> None:
    gc.freeze()
    gc.set_threshold(50_000)  # a parsed source is a million objects, and no garbage either
    gc.enable()
