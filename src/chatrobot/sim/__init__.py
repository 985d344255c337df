"""Level 2: a simulated robot that can lie on purpose, and the worlds it lives in.

`sim.world` holds obstacles and places, `sim.robot.SimRobot` is the robot on a wire, `sim.faults` what it lies
about, `python -m chatrobot.sim` runs it in real time in a process of its own. Importing this package imports
nothing.
"""
