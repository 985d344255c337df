"""Recordings: what happened, as rosbag2-compatible MCAP (docs/recordings.md). Extra: `pip install 'chatrobot[record]'`.

`topics` has what is recorded, `writer` the file; importing this package imports neither library.
"""
