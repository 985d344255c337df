"""Makes the pictures of README and docs from the real program: `make pictures`."""

from __future__ import annotations

import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT), str(ROOT / "scripts")]

from moving_picture import FILE as RUN  # noqa: E402
from moving_picture import draw as draw_run  # noqa: E402
from moving_picture import record  # noqa: E402
from report_pictures import draw as draw_report  # noqa: E402
from speed_profile import FILE as SPEED_PROFILE  # noqa: E402
from speed_profile import draw as draw_speed_profile  # noqa: E402
from terminal_picture import draw_screen, replay  # noqa: E402
from tests.console.terminal import Terminal, console  # noqa: E402

IMAGES = ROOT / "docs" / "images"
COLUMNS, ROWS = 92, 30
SQUARE = "drive in a square of one metre, then come back and face the other way"
PLANS = {
    "plan-kitchen.png": ("go to the kitchen, then come back", "home"),
    "plan-square.png": (SQUARE, "empty"),
}
TALKS: dict[str, tuple[dict[str, str], str, str]] = {
    "console.png": ({}, SQUARE, "go to the kitchen"),
    "console-zh.png": ({"LC_ALL": "zh_CN.UTF-8"}, "走一个边长一米的正方形，然后掉头", "去厨房"),
}


def main() -> None:
    """Every picture, anew."""
    IMAGES.mkdir(parents=True, exist_ok=True)
    SPEED_PROFILE.write_text(draw_speed_profile(), encoding="utf-8")
    RUN.write_text(draw_run(record()), encoding="utf-8")
    draw_report()
    with tempfile.TemporaryDirectory() as folder:
        for name, (text, world) in PLANS.items():
            command = [sys.executable, "-m", "chatrobot", "plan", text, "--world", world]
            subprocess.run([*command, "--png", str(IMAGES / name), "--config-dir", folder], check=True)
        for name, (environment, *texts) in TALKS.items():
            with console(Path(folder), columns=COLUMNS, rows=ROWS, environment=environment) as terminal:
                _controller(terminal, *texts)
                draw_screen(replay(terminal.raw, COLUMNS, ROWS), "make run", IMAGES / name)


def _controller(terminal: Terminal, first: str, second: str) -> None:
    """The first to its end, then most of the second."""
    terminal.wait_for("Ctrl-D")
    terminal.enter(first)
    terminal.wait_for("✓", timeout_s=90.0)
    terminal.enter(second)
    terminal.wait_for(r" 6\d %", timeout_s=60.0)


if __name__ == "__main__":
    main()
