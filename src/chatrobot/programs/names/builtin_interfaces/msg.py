"""builtin_interfaces.msg"""

from chatrobot.programs.inside.messages import message

Time = message("builtin_interfaces/Time", "int32 sec; uint32 nanosec")
Duration = message("builtin_interfaces/Duration", "int32 sec; uint32 nanosec")
