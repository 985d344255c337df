"""example_interfaces.msg"""

from chatrobot.programs.inside.messages import message

Bool = message("example_interfaces/Bool", "bool data")
Float64 = message("example_interfaces/Float64", "float64 data")
Int64 = message("example_interfaces/Int64", "int64 data")
String = message("example_interfaces/String", "string data")
