"""Level 1: one small publish/subscribe seam and its backends.

`wire` has the contract, `messages` what travels, `connect` opens a wire by its address; `memory` joins the two ends of
one process (simulated time), `local` the processes of one machine, `dds`, `ros` and `rosbridge` reach ROS 2.
"""
