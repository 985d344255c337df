"""MCP server: language agents drive a robot through a session of their own, in the name of `agent`.

What holds for a person at the console holds here: limits, rehearsal, approval, stop. An agent's priority is below any
person's; it neither approves a plan, nor releases an emergency stop, nor raises a limit: Motion refuses that by its
source (`governor/lease.py`).

`robot.py` is the session and who listens to it, `calls.py` one instruction seen through to its measured end, `told.py`
what an agent is told of it, `surroundings.py` what stands where. `tools.py` makes an MCP server of that; `streams.py`
(stdio, and a Unix socket) and `http.py` carry it. Standard output carries nothing but the protocol.
"""
