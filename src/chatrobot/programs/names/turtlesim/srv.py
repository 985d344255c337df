"""turtlesim.srv"""

from chatrobot.programs.inside.messages import service

Kill = service("turtlesim/Kill", "string name")
SetPen = service("turtlesim/SetPen", "uint8 r; uint8 g; uint8 b; uint8 width; uint8 off")
Spawn = service("turtlesim/Spawn", "float32 x; float32 y; float32 theta; string name", "string name")
TeleportAbsolute = service("turtlesim/TeleportAbsolute", "float32 x; float32 y; float32 theta")
TeleportRelative = service("turtlesim/TeleportRelative", "float32 linear; float32 angular")
