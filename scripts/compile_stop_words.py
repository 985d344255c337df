"""Writes the JSON file beside each list of stop words, which loads without a TOML parser.

python -m scripts.compile_stop_words            write them anew
python -m scripts.compile_stop_words --check    exit with 1 where one is not what its TOML file says
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

from chatrobot.reflex.words import DATA, parse

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib


def compiled(source: Path) -> str:
    """The JSON text for one TOML file.

    Raises:
        ValueError: the file is not TOML, or its words are not in lists that exist.
    """
    table = tomllib.loads(source.read_text(encoding="utf-8"))
    parse(table)
    return json.dumps(table, ensure_ascii=False) + "\n"


def main(arguments: list[str]) -> int:
    """Compile, or check, all languages."""
    is_stale = False
    for source in sorted(DATA.glob("*.toml")):
        target, text = source.with_suffix(".json"), compiled(source)
        if "--check" not in arguments:
            target.write_text(text, encoding="utf-8")
        elif not target.exists() or target.read_text(encoding="utf-8") != text:
            print(f"{target.name} is not what {source.name} says: python -m scripts.compile_stop_words")
            is_stale = True
    return 1 if is_stale else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
