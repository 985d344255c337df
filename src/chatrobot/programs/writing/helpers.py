"""The methods that a written program gets, each only if its `run` needs it. `{…}` is filled in by `program`."""

from __future__ import annotations

MOVE = '''\
    def move(self, {signature}seconds):
        """Hold a velocity for so long, telling it again and again: many bases stop when they hear nothing."""
        end = time.monotonic() + seconds
        while rclpy.ok() and time.monotonic() < end:
            self.publish({passed})
            self.pause(min(PERIOD, end - time.monotonic()))
'''

PUBLISH = """\
    def publish(self, {signature}):
        twist = Twist()
{assignments}
        self.publisher.publish(twist)
"""

PUBLISH_STAMPED = """\
    def publish(self, {signature}):
        message = TwistStamped()
        message.header.stamp = self.get_clock().now().to_msg()
        message.header.frame_id = 'base_link'
        twist = message.twist
{assignments}
        self.publisher.publish(message)
"""

STOP = '''\
    def stop(self):
        """Change every velocity to zero, and rest so that the robot really stands."""
        self.publish()
        time.sleep({rest})
'''

REST = '''\
    def rest(self):
        """Stand between two motions: what comes next then begins from rest."""
        self.move(seconds={rest})
'''

PAUSE = """\
    def pause(self, seconds):
        time.sleep(max(0.0, seconds))
"""

PAUSE_LISTENING = '''\
    def pause(self, seconds):
        """Let time pass, and hear what the sensors say meanwhile."""
        end = time.monotonic() + seconds
        while rclpy.ok() and time.monotonic() < end:
            rclpy.spin_once(self, timeout_sec=max(0.0, end - time.monotonic()))
'''

PAUSE_SLEEPING = '''\
    def pause(self, seconds):
        """Sleep, then hear what the sensors have said meanwhile."""
        time.sleep(max(0.0, seconds))
        for _ in range(20):
            rclpy.spin_once(self, timeout_sec=0.0)
'''

ON_ODOM = """\
    def on_odom(self, message):
        position, q = message.pose.pose.position, message.pose.pose.orientation
        yaw = math.atan2(2.0 * (q.w * q.z + q.x * q.y), 1.0 - 2.0 * (q.y * q.y + q.z * q.z))
        self.pose = (position.x, position.y, yaw)
"""

ON_SCAN = """\
    def on_scan(self, message):
        self.scan = message
"""

ON_TURTLE_POSE = """\
    def on_odom(self, message):
        self.pose = (message.x, message.y, message.theta)
"""

WAIT_FOR_POSE = """\
    def wait_for_pose(self):
        while rclpy.ok() and self.pose is None:
            self.pause(PERIOD)
"""

FACE = '''\
    def face(self, yaw, rate={rate}):
        """Turn the short way to a heading (rad), by odometry."""
        while rclpy.ok():
            error = math.remainder(yaw - self.pose[2], 2.0 * math.pi)
            if abs(error) < 0.01:
                break
            self.publish(angular_z=math.copysign(min(rate, max(0.05, 1.5 * abs(error))), error))
            self.pause(PERIOD)
        self.publish()
'''

GO_TO = '''\
    def go_to(self, x, y, speed):
        """Turn to a point (m) and drive there, steering by odometry."""
        self.face(math.atan2(y - self.pose[1], x - self.pose[0]))
        while rclpy.ok():
            dx, dy = x - self.pose[0], y - self.pose[1]
            distance = math.hypot(dx, dy)
            error = math.remainder(math.atan2(dy, dx) - self.pose[2], 2.0 * math.pi)
            if distance < 0.02 or (distance < 0.1 and abs(error) > 1.0):
                break
            steering = 1.5 * error if distance > 0.1 else 0.0
            self.publish(linear_x=min(speed, max(0.05, distance)), angular_z=max(-{rate}, min({rate}, steering)))
            self.pause(PERIOD)
        self.publish()
'''

FROM_START = '''\
    def from_start(self, x, y):
        """A point counted from where the program began, in odom."""
        x0, y0, yaw = self.start
        return x0 + math.cos(yaw) * x - math.sin(yaw) * y, y0 + math.sin(yaw) * x + math.cos(yaw) * y
'''

MOVE_UNTIL_NEAR = '''\
    def move_until_near(self, near, {signature}seconds):
        """Hold a velocity until the lidar sees something nearer than that (m) in the way, or for so long."""
        end = time.monotonic() + seconds
        while rclpy.ok() and time.monotonic() < end:
            free = self.free_ahead({direction})
            if free is not None and free < near:
                break
            if free is not None:
                self.publish({passed})
            else:
                end += PERIOD  # nothing heard yet: stand
            self.pause(PERIOD)
        self.publish()
'''

FREE_AHEAD = '''\
    def free_ahead(self, direction):
        """How far (m) the strip that the robot sweeps is free; None before the lidar has spoken."""
        if self.scan is None:
            return None
        cos, sin = math.cos(direction), math.sin(direction)
        front = max(x * cos + y * sin for x, y in FOOTPRINT)
        half_width = max(abs(y * cos - x * sin) for x, y in FOOTPRINT)
        free = math.inf
        for i, reading in enumerate(self.scan.ranges):
            if not self.scan.range_min <= reading <= self.scan.range_max:
                continue
            angle = self.scan.angle_min + i * self.scan.angle_increment + LIDAR[2]
            x, y = LIDAR[0] + reading * math.cos(angle), LIDAR[1] + reading * math.sin(angle)
            ahead = x * cos + y * sin
            if ahead > 0.0 and abs(y * cos - x * sin) <= half_width:
                free = min(free, ahead - front)
        return free
'''
