"""The page of the web console: how soon it is usable, and what comes over the line. Run: python -m bench.web_page

Each run begins `chatrobot web` anew, with its robot, and opens the page in a Chromium whose cache is empty. It is
usable when the box takes a sentence and the map and Stop are there. Promised: 1 s after the page is asked for, at the
median, and under 200 kB, as Chromium counts them, headers and all. How soon the server prints its address is shown
beside it.
"""

from __future__ import annotations

import json
import re
import tempfile
import time
from pathlib import Path

from playwright.sync_api import Browser, sync_playwright
from tests.processes import RunningRobot
from tests.web.browser import ARGUMENTS, find_browser

from bench import line, percentile

RUNS = 10
USABLE_S = 1.0
MOST_BYTES = 200_000
USABLE = """() => {
  const ready = document.getElementById("robot-title").textContent !== "ChatRobot";
  return ready && !document.getElementById("say").disabled && !!document.getElementById("stop").offsetWidth;
}"""


def load(browser: Browser, address: str) -> tuple[float, float]:
    """Return the seconds from asking for the page until it is usable, and the bytes that came."""
    context = browser.new_context()
    page = context.new_page()
    received: list[float] = []
    line_to_browser = context.new_cdp_session(page)
    line_to_browser.send("Network.enable")
    line_to_browser.on("Network.loadingFinished", lambda told: received.append(told["encodedDataLength"]))
    line_to_browser.on(
        "Network.webSocketFrameReceived", lambda told: received.append(len(told["response"]["payloadData"]))
    )
    began_s = time.monotonic()
    page.goto(address, wait_until="commit")
    page.wait_for_function(USABLE)
    usable_s = time.monotonic() - began_s
    page.wait_for_load_state("networkidle")
    context.close()
    return usable_s, sum(received)


def main() -> None:
    printed_s, usable_s, received = [], [], []
    with sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=find_browser(), args=list(ARGUMENTS))
        for _ in range(RUNS):
            with tempfile.TemporaryDirectory() as folder:
                began_s = time.monotonic()
                arguments = ("web", "--no-open", "--port", "0", "--no-record")
                robot = RunningRobot(Path(folder), arguments)
                found = re.search(r":(\d+)/", robot.wait_for_line("http://"))
                printed_s.append(time.monotonic() - began_s)
                assert found is not None
                one_s, count = load(browser, f"http://127.0.0.1:{found[1]}/")
                usable_s.append(one_s)
                received.append(count)
                robot.close()
        browser.close()
    line("chatrobot web, from its start until it prints its address", printed_s)
    is_soon = line("the page, from asking for it until it is usable", usable_s, (USABLE_S, 2 * USABLE_S))
    print(f"transfer: {percentile(received, 0.5) / 1000:.0f} kB, {max(received) / 1000:.0f} kB at most")
    print(json.dumps({"kept": is_soon and max(received) < MOST_BYTES}))


if __name__ == "__main__":
    main()
