"""From any language: `chatrobot --json` in a process of its own, text in, one JSON object a line out."""

import json
import subprocess
import sys

command = [sys.executable, "-m", "chatrobot", "--json", "--world", "empty", *sys.argv[1:]]
with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as robot:
    assert robot.stdin is not None
    assert robot.stdout is not None
    for text in ("forward 1 m", "turn left 90 degrees"):
        print(json.dumps({"text": text}), file=robot.stdin, flush=True)
    robot.stdin.close()  # an orderly end: both are still done
    for line in robot.stdout:
        event = json.loads(line)
        if event["event"] == "result":
            print(event["turn"], event["outcome"], event["reply"])
sys.exit(robot.returncode)
