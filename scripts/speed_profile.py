"""Draws docs/images/speed-profile.svg: what the tutorial's line for a second sends, as executor and governor send it.

python -m scripts.speed_profile     (`make pictures` does it, too; a test compares)
"""

from __future__ import annotations

from pathlib import Path

from chatrobot.core.clock import TICK_S
from chatrobot.plan.text import parse_plan
from chatrobot.testing.rig import Rig

FILE = Path(__file__).resolve().parents[1] / "docs" / "images" / "speed-profile.svg"
SPEED_MPS, HOLD_S = 0.5, 1.0
LEFT, TOP, WIDTH, HEIGHT = 56, 34, 480, 170
END_S, TOP_MPS = 2.0, 0.6
GREY, BLUE = "#888", "#1565c0"


def speeds() -> list[float]:
    """What goes out on cmd_vel, tick by tick, with the zero at the end."""
    rig = Rig()
    rig.run(parse_plan(f"twist {SPEED_MPS:g} 0 0 for {HOLD_S:g} s"))
    return [*(twist.vx_mps for twist in rig.sent), 0.0]


def draw() -> str:
    """The picture, as SVG."""
    sent = speeds()
    last_s = next(index for index in range(len(sent), 0, -1) if sent[index - 1] > 0.0) * TICK_S
    return "\n".join(
        [
            f'<svg xmlns="http://www.w3.org/2000/svg" width="{LEFT + WIDTH + 24}" height="{TOP + HEIGHT + 44}"'
            ' font-family="sans-serif" font-size="13">',
            '<rect width="100%" height="100%" fill="white"/>',
            *_axes(),
            _line([(0.0, SPEED_MPS), (HOLD_S, SPEED_MPS), (HOLD_S, 0.0)], GREY, ' stroke-dasharray="5 4"'),
            _line([(index * TICK_S, speed) for index, speed in enumerate(sent)], BLUE, ' stroke-width="2"'),
            _text(0.06, SPEED_MPS + 0.03, f"asked: {SPEED_MPS:g} m/s for {HOLD_S:g} s", GREY),
            _text(HOLD_S + 0.3, 0.3, f"sent: {sum(sent) * TICK_S:.2f} m in {last_s:.1f} s", BLUE),
            "</svg>\n",
        ]
    )


def _axes() -> list[str]:
    found = [_line([(0.0, TOP_MPS), (0.0, 0.0), (END_S, 0.0)], "black")]
    found += [_text(t_s - 0.02, -0.08, f"{t_s:g}", "black") for t_s in (0.0, 0.5, 1.0, 1.5)]
    found += [_text(-0.13, speed - 0.015, f"{speed:g}", "black") for speed in (0.25, 0.5)]
    return [*found, _text(END_S - 0.06, -0.08, "s", "black"), _text(-0.2, TOP_MPS + 0.03, "m/s", "black")]


def _line(points: list[tuple[float, float]], color: str, more: str = "") -> str:
    placed = " ".join(f"{x:.0f},{y:.0f}" for x, y in (_at(*point) for point in points))
    return f'<polyline points="{placed}" fill="none" stroke="{color}"{more}/>'


def _text(t_s: float, speed_mps: float, text: str, color: str) -> str:
    x, y = _at(t_s, speed_mps)
    return f'<text x="{x:.0f}" y="{y:.0f}" fill="{color}">{text}</text>'


def _at(t_s: float, speed_mps: float) -> tuple[float, float]:
    return LEFT + WIDTH * t_s / END_S, TOP + HEIGHT * (1.0 - speed_mps / TOP_MPS)


if __name__ == "__main__":
    FILE.write_text(draw(), encoding="utf-8")
