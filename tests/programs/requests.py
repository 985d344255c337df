"""The tutorial's two requests, word for word."""

from __future__ import annotations

ROTATION = """\
Generate a ROS 2 Python program to control the car rotation. Specific requirements are as follows:

1, the car needs to rotate at the angular speed of 0.5 for 6 seconds, after the rotation is finished, the speed is changed to 0.0, so that the car stops moving. The topic name should be “/cmd_vel”;

2. Make “geometry_msgs/msg/twist.hpp” the header file of the twist message, which contains two members: linear velocity and angular velocity;

3. All twist messages should be of floating point type. Make sure that the generated code can fulfill the above functional requirements. Just the code, no explanation required."""  # noqa: E501

SQUARE = """\
Generate a ROS 2 Python program to control the car movement. Specific requirements are as follows:

1. The motion path is a square. The topic name should be “/cmd_vel”;

2. Use geometry_msgs/msg/twist.hpp as the header file of the twist message containing both linear and angular velocity members with a linear velocity of 0.2 and a movement time of 3 seconds. The angular velocity is 1.0 and the rotation time is 2 seconds.

3, time control use time.sleep;

4. All twist messages should be of floating point type;

5, after the end of the operation, change all speed to 0, and sleep for 1 second to ensure that the car stops moving. Make sure that the generated code can fulfill the above functional requirements. Just the code, no explanation required."""  # noqa: E501
