"""turtlesim.msg"""

from chatrobot.programs.inside.messages import message

Pose = message(
    "turtlesim/Pose", "float32 x; float32 y; float32 theta; float32 linear_velocity; float32 angular_velocity"
)
Color = message("turtlesim/Color", "uint8 r; uint8 g; uint8 b")
