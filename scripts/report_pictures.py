"""Records a run in simulated time and draws its report, docs/images/report.svg and .gif (`make pictures` does, too).

A stop, a limit, a refusal and a program are in it, and wheels that slip: what was measured is not quite what is true.

python -m scripts.report_pictures
"""

from __future__ import annotations

import os
import tempfile
from pathlib import Path

from tests.report.recorded import session

from chatrobot.cli.entry import main

IMAGES = Path(__file__).resolve().parents[1] / "docs" / "images"
SAID = (
    "go to the kitchen",
    "linear.x = 2.5,linear.y = 0,angular.z = 0",
    "forward 20 m",
    "write a program that drives backwards at 0.3 m/s for 2 seconds",
    "go to the sofa",
)
FAULTS = "slip=0.03,noise=on,seed=3"
MOST_BYTES = {"svg": 200_000, "gif": 400_000}


def draw() -> None:
    """Draw both pictures."""
    with tempfile.TemporaryDirectory() as folder:
        recording = session(Path(folder) / "report.mcap", SAID, FAULTS)
        outs = {kind: IMAGES / f"report.{kind}" for kind in MOST_BYTES}
        main(
            [
                "report",
                str(recording),
                *(part for kind, out in outs.items() for part in (f"--{kind}", str(out))),
            ]
        )
    for kind, out in outs.items():
        os.chmod(out, 0o644)  # a report is private; these are not
        size = out.stat().st_size
        assert size < MOST_BYTES[kind], f"{out.name} has {size} bytes"


if __name__ == "__main__":
    draw()
