"""Level 1: one small publish/subscribe seam and its backends.

`wire.wire` states the contract, `wire.messages` what travels, `wire.memory` joins the two ends of one process
(simulated time), `wire.local` joins the processes of one machine.
"""
