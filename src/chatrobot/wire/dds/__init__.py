"""The wire over DDS (Eclipse Cyclone), which is how ROS 2 processes speak: `pip install 'chatrobot[dds]'`.

`discovery` decides whom to meet, `ros_types` turns ROS definitions into Cyclone's, `graph` is who is there,
`wire` is the backend. Importing this package imports none of them.
"""
