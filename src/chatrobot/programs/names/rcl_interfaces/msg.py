"""rcl_interfaces.msg"""

from chatrobot.programs.inside.messages import message

_KINDS = (
    "NOT_SET", "BOOL", "INTEGER", "DOUBLE", "STRING",
    "BYTE_ARRAY", "BOOL_ARRAY", "INTEGER_ARRAY", "DOUBLE_ARRAY", "STRING_ARRAY",
)  # fmt: skip

ParameterType = message(
    "rcl_interfaces/ParameterType", "", **{f"PARAMETER_{kind}": number for number, kind in enumerate(_KINDS)}
)
ParameterValue = message(
    "rcl_interfaces/ParameterValue",
    "uint8 type; bool bool_value; int64 integer_value; float64 double_value; string string_value;"
    "byte[] byte_array_value;"
    "bool[] bool_array_value; int64[] integer_array_value; float64[] double_array_value; string[] string_array_value",
)
Parameter = message("rcl_interfaces/Parameter", "string name; rcl_interfaces/ParameterValue value")
FloatingPointRange = message(
    "rcl_interfaces/FloatingPointRange", "float64 from_value; float64 to_value; float64 step"
)
IntegerRange = message("rcl_interfaces/IntegerRange", "int64 from_value; int64 to_value; uint64 step")
ParameterDescriptor = message(
    "rcl_interfaces/ParameterDescriptor",
    "string name; uint8 type; string description; string additional_constraints; bool read_only; bool dynamic_typing;"
    "rcl_interfaces/FloatingPointRange[<=1] floating_point_range; rcl_interfaces/IntegerRange[<=1] integer_range",
)
ParameterEvent = message(
    "rcl_interfaces/ParameterEvent",
    "builtin_interfaces/Time stamp; string node; rcl_interfaces/Parameter[] new_parameters;"
    "rcl_interfaces/Parameter[] changed_parameters; rcl_interfaces/Parameter[] deleted_parameters",
)
ListParametersResult = message("rcl_interfaces/ListParametersResult", "string[] names; string[] prefixes")
SetParametersResult = message("rcl_interfaces/SetParametersResult", "bool successful; string reason")
Log = message(
    "rcl_interfaces/Log",
    "builtin_interfaces/Time stamp; uint8 level; string name; string msg; string file; string function; uint32 line",
)
