"""Level 2: a simulated robot, with faults injected on request, and the worlds it lives in.

`sim.world` holds obstacles and places, `sim.robot.SimRobot` is the robot on a wire, `sim.fault_injection` its
faults, `python -m chatrobot.sim` runs it in real time in a process of its own. Importing this package imports
nothing.
"""
