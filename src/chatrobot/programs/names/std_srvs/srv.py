"""std_srvs.srv"""

from chatrobot.programs.inside.messages import service

Empty = service("std_srvs/Empty")
SetBool = service("std_srvs/SetBool", "bool data", "bool success; string message")
Trigger = service("std_srvs/Trigger", "", "bool success; string message")
