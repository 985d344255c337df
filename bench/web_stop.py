"""Stop at the web console, from a page to the zero at a subscriber. Run: python -m bench.web_stop

First a browser's own event: the space bar in Chromium (`event.timeStamp`, on the clock of this process), while a plan,
a program and a plan of a language model that hangs are driven. Then a WebSocket client that beats as a page does, with
nobody else, with 20 who watch, and while the event loop of the pages computes something else and serves nobody. Then a
pupil's page while the other robots of a class of 20 move. This process subscribes to the velocities of the simulated
robot. Promised: 15 ms at the median, 40 ms at p99. Last what 20 who watch a moving robot cost the server, of one core.
"""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
import tempfile
import threading
import time
from collections import deque
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path

import psutil
from playwright.sync_api import Browser, sync_playwright
from tests.processes import RunningRobot
from tests.web.browser import ARGUMENTS, find_browser, open_page
from tests.web.class_rig import RunningClass

from bench import line
from bench.program_stop import SOURCE
from chatrobot.models.fake.script import read_script
from chatrobot.models.fake.server import FakeModel
from chatrobot.programs.library import KeptProgram, Library

REPETITIONS = 20
WATCHERS = 20
PUPILS = 20
PROMISED_S = (0.015, 0.040)
COST_S = 5.0
HANGS = {"match": "nice", "text": "drive 2 m\nturn", "hang_after": 10}
"""A plan whose second line never comes."""

_SERVER = """
import signal, sys, time
from chatrobot.cli.entry import main
from chatrobot.web import server
start = server.WebServer.start
def compute():
    ends_s = time.monotonic() + 0.6
    while time.monotonic() < ends_s:
        pass
def start_and_listen(self, *sockets):
    start(self, *sockets)
    signal.signal(signal.SIGUSR1, lambda *_: self._threads[1].loop.call_soon_threadsafe(compute))
server.WebServer.start = start_and_listen
sys.exit(main(sys.argv[1:]))
"""
"""`chatrobot web`, whose event loop computes for 0.6 s at SIGUSR1."""

_PAGES = """
import asyncio, json, sys, threading, time
import websockets
port, watchers = int(sys.argv[1]), int(sys.argv[2])
def connect(path, at):
    address, origin = f"ws://127.0.0.1:{at}{path}", f"http://127.0.0.1:{port}"
    return websockets.connect(address, origin=origin, proxy=None, max_size=None)
async def read(socket):
    async for _ in socket:
        pass
async def beat(socket):
    while True:
        await socket.send('{"do":"beat","held":false}')
        await asyncio.sleep(0.05)
async def main():
    page = await connect("/ws", port)
    hello = json.loads(await page.recv())
    line = await connect("/stop", hello["stop_port"])
    tasks = [asyncio.ensure_future(read(page)), asyncio.ensure_future(beat(page))] if not watchers else []
    for _ in range(watchers):
        tasks.append(asyncio.ensure_future(read(await connect("/ws", port))))
    if watchers:
        await page.close()
    print("ready", flush=True)
    loop = asyncio.get_running_loop()
    while word := (await loop.run_in_executor(None, sys.stdin.readline)).strip():
        if word == "stop":
            print(time.monotonic(), flush=True)
            await line.send('{"do":"stop"}')
            await line.recv()
        else:
            await page.send(json.dumps({"do": "say", "text": word}))
asyncio.run(main())
"""


@contextmanager
def pages(port: int, watchers: int = 0) -> Iterator[subprocess.Popen[str]]:
    """The page that steers, or so many that watch, in a process of their own."""
    command = [sys.executable, "-c", _PAGES, str(port), str(watchers)]
    process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    assert process.stdout is not None
    assert process.stdout.readline().strip() == "ready"
    try:
        yield process
    finally:
        process.kill()
        process.wait()


def tell(process: subprocess.Popen[str], word: str) -> None:
    assert process.stdin is not None
    process.stdin.write(f"{word}\n")
    process.stdin.flush()


def once(robot: RunningRobot, page: subprocess.Popen[str], text: str, *, busy: bool) -> float:
    """Seconds from the page's message to the first zero."""
    said_s = time.monotonic()
    tell(page, text)
    robot.velocities.wait_for(lambda twist: abs(twist.vx_mps) > 0.1, said_s)
    if busy:
        robot.process.send_signal(10)  # SIGUSR1
        time.sleep(0.05)
    tell(page, "stop")
    assert page.stdout is not None
    stopped_s = float(page.stdout.readline())
    took_s = robot.velocities.wait_for_zero(stopped_s) - stopped_s
    time.sleep(0.8 if busy else 0.5)
    return took_s


class Chromium:
    """The page in a real browser, driven as by a person at its keyboard."""

    def __init__(self, browser: Browser, address: str) -> None:
        self._page = open_page(browser, address)
        self._page.evaluate(
            """window.pressedMs = 0;
            addEventListener("keydown", (event) => {
              if (event.code === "Space") pressedMs = performance.timeOrigin + event.timeStamp;
            }, true);"""
        )
        self._offset_s = time.time() - time.monotonic()

    def clock_error_s(self) -> float:
        """Return how far the page's clock is off this process's at most."""
        errors_s = []
        for _ in range(REPETITIONS):
            before_s = time.time()
            page_s = self._page.evaluate("performance.timeOrigin + performance.now()") / 1e3
            errors_s.append(max(abs(page_s - before_s), abs(page_s - time.time())))
        return min(errors_s)

    def once(self, robot: RunningRobot, text: str) -> float:
        """Seconds from the space bar to the first zero."""
        said_s = time.monotonic()
        self._page.locator("#say").fill(text)
        self._page.keyboard.press("Enter")
        robot.velocities.wait_for(lambda twist: abs(twist.vx_mps) > 0.1, said_s)
        self._page.keyboard.press("Space")
        pressed_s = self._page.evaluate("pressedMs") / 1e3 - self._offset_s
        took_s = robot.velocities.wait_for_zero(pressed_s) - pressed_s
        time.sleep(0.5)
        return took_s

    def close(self) -> None:
        """Close the page: it steers no more."""
        self._page.context.close()


def in_the_browser(robot: RunningRobot, address: str) -> Iterator[bool]:
    """Print a row for each thing that is driven; yield whether it holds the promise."""
    with sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=find_browser(), args=list(ARGUMENTS))
        page = Chromium(browser, address)
        print(f"the browser's clock is off by at most {page.clock_error_s() * 1e3:.1f} ms")
        driven = {
            "space bar, a plan": ["forward 2 m", "back 2 m"],
            "space bar, a program": ["run the bench program"],
            "space bar, a plan of a model that hangs": ["please do something nice"],
        }
        for name, texts in driven.items():
            took = [page.once(robot, texts[number % len(texts)]) for number in range(REPETITIONS)]
            yield line(name, took, PROMISED_S)
        page.close()
        browser.close()


_PUPILS = """
import asyncio, json, sys, websockets
port, text, *tokens = sys.argv[1:]
async def beat(socket):
    while True:
        await socket.send('{"do":"beat","held":false}')
        await asyncio.sleep(0.05)
async def pupil(token):
    at, headers = f"127.0.0.1:{port}", {"Authorization": f"Bearer {token}"}
    how = {"origin": f"http://{at}", "additional_headers": headers, "proxy": None, "max_size": None}
    async with websockets.connect(f"ws://{at}/ws", **how) as socket:
        await socket.send('{"do":"take"}')
        beating = asyncio.ensure_future(beat(socket))
        await socket.send(json.dumps({"do": "say", "text": text}))
        async for _ in socket:
            pass
async def main():
    await asyncio.gather(*map(pupil, tokens))
asyncio.run(main())
"""
"""The pages of the other pupils, in a process of their own."""


def in_a_class(folder: Path) -> bool:
    """Print the row of a pupil who stops a robot while those of all others move; return whether it holds."""
    running = RunningClass(folder, PUPILS)
    mine, *others = running.pupils_tokens()
    command = [sys.executable, "-c", _PUPILS, str(running.port), "turn left 3600 degrees", *others]
    pages = subprocess.Popen(command)
    try:
        page = running.pupil(0)
        threading.Thread(target=deque, args=(page.socket, 0), daemon=True).start()
        line_of_stop = running.dial("/stop", mine, page.heard[0]["stop_port"])
        for ear in running.heard[1:]:
            ear.wait_for_motion()
        took = []
        for number in range(REPETITIONS):
            said_s = time.monotonic()
            page.say("say", text=f"turn {'left' if number % 2 else 'right'} 90 degrees")
            running.heard[0].wait_for_motion(said_s)
            time.sleep(0.3)
            stopped_s = time.monotonic()
            line_of_stop.say("stop")
            took.append(running.heard[0].wait_for_zero(stopped_s) - stopped_s)
            time.sleep(0.3)
        moving = sum(any(ear.all[-1][1]) for ear in running.heard[1:])
        return line("the others of a class move", took, PROMISED_S, f"{moving} of them at the end")
    finally:
        pages.kill()
        pages.wait()
        running.close()


def cost_of_watching(robot: RunningRobot, page: subprocess.Popen[str]) -> float:
    """Processor time of the server, as a share of one core, while a robot moves that so many watch."""
    tell(page, "turn left 720 degrees")
    time.sleep(0.5)
    server = psutil.Process(robot.process.pid)
    before, began_s = server.cpu_times(), time.monotonic()
    time.sleep(COST_S)
    after, took_s = server.cpu_times(), time.monotonic() - began_s
    return (after.user + after.system - before.user - before.system) / took_s


def main() -> None:
    print(f"{'stop at the page -> zero at a subscriber':62s} {'median':>11s} {'p99':>10s}")
    arguments = ("web", "--no-open", "--port", "0", "--world", "empty", "--model", "openai:fake")
    with tempfile.TemporaryDirectory() as folder, ExitStack() as open_:
        fake = open_.enter_context(FakeModel(read_script({"models": ["fake"], "replies": [HANGS]})))
        os.environ.update(OPENAI_BASE_URL=f"{fake.url}/v1", OPENAI_API_KEY="sk-bench")
        Library(Path(folder) / "config").keep(KeptProgram("bench", SOURCE))
        robot = RunningRobot(Path(folder), arguments, ("-c", _SERVER))
        open_.callback(robot.close)
        found = re.search(r":(\d+)/", robot.wait_for_line("http://"))
        assert found is not None
        kept = list(in_the_browser(robot, f"http://127.0.0.1:{found[1]}/"))
        page = open_.enter_context(pages(int(found[1])))
        texts = ["forward 2 m" if number % 2 else "back 2 m" for number in range(REPETITIONS)]
        kept += [line("nobody else", [once(robot, page, text, busy=False) for text in texts], PROMISED_S)]
        kept.append(
            line(
                "the pages' event loop computes",
                [once(robot, page, text, busy=True) for text in texts],
                PROMISED_S,
            )
        )
        alone = cost_of_watching(robot, page)
        tell(page, "stop")
        with pages(int(found[1]), WATCHERS):
            name = f"{WATCHERS} watch"
            kept.append(line(name, [once(robot, page, text, busy=False) for text in texts], PROMISED_S))
            watched = cost_of_watching(robot, page)
    with tempfile.TemporaryDirectory() as folder:
        kept.append(in_a_class(Path(folder)))
    print(
        f"the server while the robot moves: {alone:.0%} of one core; with {WATCHERS} who watch: {watched:.0%}"
    )
    print(json.dumps({"kept": all(kept)}))


if __name__ == "__main__":
    main()
