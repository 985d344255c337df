"""std_msgs.msg"""

from chatrobot.programs.inside.messages import message
from chatrobot.programs.names.builtin_interfaces import msg as _builtin_interfaces  # noqa: F401

Bool = message("std_msgs/Bool", "bool data")
Byte = message("std_msgs/Byte", "byte data")
Char = message("std_msgs/Char", "char data")
ColorRGBA = message("std_msgs/ColorRGBA", "float32 r; float32 g; float32 b; float32 a")
Empty = message("std_msgs/Empty")
Float32 = message("std_msgs/Float32", "float32 data")
Float64 = message("std_msgs/Float64", "float64 data")
Header = message("std_msgs/Header", "builtin_interfaces/Time stamp; string frame_id")
Int8 = message("std_msgs/Int8", "int8 data")
Int16 = message("std_msgs/Int16", "int16 data")
Int32 = message("std_msgs/Int32", "int32 data")
Int64 = message("std_msgs/Int64", "int64 data")
String = message("std_msgs/String", "string data")
UInt8 = message("std_msgs/UInt8", "uint8 data")
UInt16 = message("std_msgs/UInt16", "uint16 data")
UInt32 = message("std_msgs/UInt32", "uint32 data")
UInt64 = message("std_msgs/UInt64", "uint64 data")
MultiArrayDimension = message("std_msgs/MultiArrayDimension", "string label; uint32 size; uint32 stride")
MultiArrayLayout = message(
    "std_msgs/MultiArrayLayout", "std_msgs/MultiArrayDimension[] dim; uint32 data_offset"
)
Float32MultiArray = message("std_msgs/Float32MultiArray", "std_msgs/MultiArrayLayout layout; float32[] data")
Float64MultiArray = message("std_msgs/Float64MultiArray", "std_msgs/MultiArrayLayout layout; float64[] data")
Int32MultiArray = message("std_msgs/Int32MultiArray", "std_msgs/MultiArrayLayout layout; int32[] data")
UInt8MultiArray = message("std_msgs/UInt8MultiArray", "std_msgs/MultiArrayLayout layout; uint8[] data")
