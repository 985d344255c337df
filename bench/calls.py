"""What a call to each kind of provider costs beside the model itself. Run: python -m bench.calls

Over real HTTP on loopback, against the scripted server: our own part of a call from `ask` to the end of a reply that
the server gives at once; how long a token takes from the server's send to our caller; how long `cancel` takes.
"""

from __future__ import annotations

import threading
import time

from tests.models.rig import WIRES, Got, model_at, serving

from bench import line
from chatrobot.models.make import make_model, warm
from chatrobot.models.seam import CallLimits, Message, Reply

REPETITIONS = 40


def call(provider: str) -> list[float]:
    with serving([{"match": "", "text": "drive 1 m"}]) as fake:
        model = model_at(provider, fake.url)
        Got(model, "warm up")
        began_s = time.process_time()
        took = [Got(model, "go").took_s for _ in range(REPETITIONS)]
        spent_s = (time.process_time() - began_s) / REPETITIONS
        print(f"{provider}: processor time of a call, with the server's {spent_s * 1e3:13.2f} ms")
        return took


def pieces(provider: str) -> list[float]:
    with serving([{"match": "", "text": "drive 1 m\n" * 20, "tokens_per_s": 50}]) as fake:
        model = model_at(provider, fake.url)
        Got(model, "warm up", limits=CallLimits(total_s=0.2))
        got_s = [time.monotonic() for _ in model.ask([Message("user", "go")], CallLimits())]
        return [got - sent for got, sent in zip(got_s, fake.calls[-1].sent_s)]


def cancel(provider: str) -> list[float]:
    took: list[float] = []
    with serving([{"match": "", "text": "drive 1 m\n" * 20, "hang_after": 3}]) as fake:
        model = model_at(provider, fake.url)
        for _ in range(10):
            reply = model.ask([Message("user", "go")], CallLimits())
            cancelled_s: list[float] = []

            def end(cancelled_s: list[float] = cancelled_s, reply: Reply = reply) -> None:
                cancelled_s.append(time.monotonic())
                reply.cancel()

            threading.Timer(0.05, end).start()
            list(reply)
            took.append(time.monotonic() - cancelled_s[0])
    return took


def main() -> int:
    began_s = time.monotonic()
    warm(make_model("openai:any"), wait_s=60)
    print(f"loading the library, in the background: {time.monotonic() - began_s:.1f} s")
    print(f"{'':62s} {'median':>11s} {'p99':>10s}")
    for provider in WIRES:
        line(f"{provider}: a whole call", call(provider))
        line(f"{provider}: a token, from its send to our caller", pieces(provider))
        line(f"{provider}: from cancel to the end of the iteration", cancel(provider))
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
