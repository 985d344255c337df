"""`chatrobot lesson`: a lesson at the console, or lines checked without a person."""
