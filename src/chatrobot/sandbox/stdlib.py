"""Modules that are imported before a program runs: inside the sandbox no file can be opened, so nothing is
loaded later.

Modules that reach out (`socket`, `subprocess`) are here too: using them is what fails, with a PermissionError.
"""

from __future__ import annotations

_NAMES = """
abc argparse array ast asyncio asyncio.taskgroups atexit base64 binascii bisect builtins calendar cmath codecs
collections collections.abc colorsys concurrent.futures concurrent.futures.process concurrent.futures.thread
configparser contextlib contextvars copy copyreg csv ctypes ctypes.util dataclasses datetime decimal difflib dis enum
errno faulthandler fcntl fnmatch fractions functools gc getopt getpass gettext glob gzip hashlib heapq hmac html
http.client importlib importlib.util inspect io ipaddress itertools json keyword linecache locale logging
logging.config logging.handlers marshal math mmap multiprocessing multiprocessing.pool multiprocessing.queues
multiprocessing.shared_memory multiprocessing.synchronize numbers opcode operator os pathlib pickle pickletools pkgutil
platform pprint queue random re reprlib resource sched secrets select selectors shlex shutil signal socket
socketserver stat statistics string struct subprocess sys sysconfig tempfile textwrap threading time timeit token
tokenize traceback tracemalloc types typing unicodedata urllib.error urllib.parse urllib.request uuid warnings weakref
zlib zoneinfo _strptime
encodings.ascii encodings.cp1252 encodings.gbk encodings.hex_codec encodings.idna encodings.latin_1
encodings.raw_unicode_escape encodings.unicode_escape encodings.utf_16 encodings.utf_32 encodings.utf_8_sig
numpy numpy.fft numpy.linalg numpy.random
"""

PRELOADED = tuple(_NAMES.split())
"""Those that this Python does not have (numpy may be missing) are left out."""
