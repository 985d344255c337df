"""The code inside the sandbox, around the program: its end of the pipe, its clock, its threads, its names."""
