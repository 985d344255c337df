"""Listening: every event of the way from words to motion. Listeners only read; `stop` may be called from anywhere."""

import sys

import chatrobot


def on_event(event: chatrobot.Event) -> None:
    data = event.to_json()
    if data["event"] == "progress" and data["pose"]["x_m"] > 0.5:
        print("half a metre is enough:", data["pose"])
        robot.stop()
    elif data["event"] in ("interpreted", "rehearsed", "started", "result"):
        print(data["event"])


with chatrobot.connect(world="empty", fast="--fast" in sys.argv) as robot:
    robot.on_event(on_event)
    result = robot.do("forward 2 m")
    print(f"{result.outcome} after {result.path_m:.2f} m")
