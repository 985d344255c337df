"""example_interfaces.srv"""

from chatrobot.programs.inside.messages import service

AddTwoInts = service("example_interfaces/AddTwoInts", "int64 a; int64 b", "int64 sum")
SetBool = service("example_interfaces/SetBool", "bool data", "bool success; string message")
Trigger = service("example_interfaces/Trigger", "", "bool success; string message")
