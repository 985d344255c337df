"""ChatRobot: say it, and a robot does exactly that, safely."""

__version__ = "0.1.0"
