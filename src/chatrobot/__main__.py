"""`python -m chatrobot`: the same as the `chatrobot` command."""

import sys

from chatrobot.cli.entry import main

if __name__ == "__main__":
    sys.exit(main())
