"""What runs inside the box, around the program: its end of the pipe, its clock, its threads, its names."""
