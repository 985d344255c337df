"""The report as one page that needs nothing else: no reference leads out of it, and nothing recorded runs as script."""

from __future__ import annotations

import base64
import hashlib
import math
from collections.abc import Iterator
from functools import cache
from html import escape
from pathlib import Path

from chatrobot import __version__
from chatrobot.cli.drawing.surface import Box, Colour
from chatrobot.cli.drawing.svg import SHAPES_STYLE, SvgCanvas, dark_style, printable
from chatrobot.cli.report.drive import Drive
from chatrobot.cli.report.map_figure import (
    LEGEND,
    MARK_COLOURS,
    MEASURED,
    MOST_MARKS,
    TOLD_PX,
    DriveMap,
    map_size,
)
from chatrobot.cli.report.speed_chart import COMMANDED, LIMIT, clock, draw_speeds
from chatrobot.cli.report.summary import Say, headline, sentences, tiles
from chatrobot.cli.report.timeline import MOST_ROWS, Row, Timeline

MAP_WIDTH_PX, MOST_MAP_HEIGHT_PX = 1000, 720
SPEEDS_PX = (1000, 340)
LEFT_PX, FOOT_PX, EDGE_PX = 46, 30, 8
_SHOWN_TIMES = 4
_NUMBERS = ("told", "measured", "took", "tokens", "cost")


def make_page(drive: Drive, say: Say, amiss: str = "") -> str:
    """Return the page, in HTML. `amiss`: the word for what is wrong with the recording."""
    lines = [f"<p>{_text(' '.join(sentences(drive, say)))}</p>"]
    if amiss:
        lines.append(f'<p class="note">{_text(say(amiss))}</p>')
    figures = [*_map(drive, say), *_speeds(drive, say)]
    style = "".join((_asset("page.css"), SHAPES_STYLE, dark_style(), _shape_rule(drive)))
    script = _asset("page.js")
    language = "zh-CN" if drive.language == "zh" else drive.language
    title = _text(say("page_title", robot=drive.title or say("robot_unknown")))
    policy = (
        f"default-src 'none'; style-src '{_digest(style)}'; script-src '{_digest(script)}';"
        " base-uri 'none'; form-action 'none'"
    )
    footer = say("footer", version=__version__, file=drive.recording.path.name)
    return "\n".join(
        [
            f'<!doctype html>\n<html lang="{language}">\n<head>\n<meta charset="utf-8">',
            f'<meta http-equiv="Content-Security-Policy" content="{policy}">',
            '<meta name="viewport" content="width=device-width, initial-scale=1">',
            f"<title>{title}</title>\n<style>{style}</style>\n</head>\n<body>",
            f'<header>\n<h1>{title}</h1>\n<p class="soft">{_text(headline(drive, say))}</p>\n</header>\n<main>',
            *lines,
            f'<dl class="tiles">{"".join(_tile(*tile) for tile in tiles(drive, say))}</dl>',
            *figures,
            *_table(drive, say),
            f"</main>\n<footer><p>{_text(footer)}</p></footer>",
            f"<script>{script}</script>\n</body>\n</html>\n",
        ]
    )


def _text(text: str) -> str:
    return escape(printable(text))


def _tile(name: str, value: str) -> str:
    return f"<div><dt>{_text(name)}</dt><dd>{_text(value)}</dd></div>"


@cache
def _asset(name: str) -> str:
    return Path(__file__).with_name(name).read_text(encoding="utf-8")


def _digest(text: str) -> str:
    return "sha256-" + base64.b64encode(hashlib.sha256(text.encode("utf-8")).digest()).decode("ascii")


# --- figures ---


def _map_canvas_px(drive: Drive) -> tuple[int, int]:
    width, height = map_size(drive, MAP_WIDTH_PX - LEFT_PX - EDGE_PX, MOST_MAP_HEIGHT_PX)
    return width + LEFT_PX + EDGE_PX, height + FOOT_PX + EDGE_PX


def _shape_rule(drive: Drive) -> str:
    """Keep the map's shape at any width."""
    width, height = _map_canvas_px(drive)
    return f"#map .figure{{aspect-ratio:{width}/{height}}}"


def _map(drive: Drive, say: Say) -> Iterator[str]:
    yield f'<section id="map">\n<h2>{_text(say("heading_map"))}</h2>'
    if not (drive.told or drive.measured or drive.true):
        yield f'<p class="soft">{_text(say("no_map"))}</p>\n</section>'
        return
    width, height = _map_canvas_px(drive)
    canvas = SvgCanvas(width, height)
    box: Box = (LEFT_PX, EDGE_PX, width - EDGE_PX, height - FOOT_PX)
    DriveMap(drive, canvas, box).draw()
    yield canvas.markup(say("map_name", marks=len(drive.marks)))
    yield '<ul class="legend">'
    ways = {"told": drive.told, "measured": drive.measured, "true": drive.true}
    for name, colour in LEGEND:
        if ways[name]:
            yield _key(say(f"legend_{name}"), colour, TOLD_PX if name == "told" else 3.0)
    for number, mark in enumerate(drive.marks[:MOST_MARKS], 1):
        times = say("comma").join(map(clock, mark.times_s[:_SHOWN_TIMES]))
        if len(mark.times_s) > _SHOWN_TIMES:
            times = say("listed", name=f"{times} …", count=len(mark.times_s))
        line = say("mark_line", number=number, kind=say(f"mark_{mark.kind}"), time=times)
        yield _key(line, MARK_COLOURS[mark.kind], disc=str(number))
    yield "</ul>"
    if len(drive.marks) > MOST_MARKS:
        yield f'<p class="soft">{_text(say("more_marks", count=MOST_MARKS))}</p>'
    yield "</section>"


def _speeds(drive: Drive, say: Say) -> Iterator[str]:
    recording = drive.recording
    if not (recording.commands or recording.odometry or recording.truth):
        return
    canvas = SvgCanvas(*SPEEDS_PX)
    draw_speeds(drive, canvas, (0.0, 0.0, float(SPEEDS_PX[0]), float(SPEEDS_PX[1])), say)
    yield f'<section id="speeds">\n<h2>{_text(say("heading_speeds"))}</h2>\n{canvas.markup(say("speeds_name"))}'
    keys = [("commanded", COMMANDED), ("measured", MEASURED), *([("limit", LIMIT)] if drive.limits else [])]
    yield f'<ul class="legend">{"".join(_key(say(f"legend_{name}"), colour) for name, colour in keys)}</ul>'
    yield "</section>"


def _key(name: str, colour: Colour, width_px: float = 3.0, *, disc: str = "") -> str:
    """Return one entry of a legend: a line, or a numbered disc."""
    canvas = SvgCanvas(28, 12) if not disc else SvgCanvas(18, 18)
    if disc:
        canvas.circle((9, 9), 8.5, fill=colour)
        canvas.text((9, 9), disc, (255, 255, 255), 11, "mm")
    else:
        canvas.line([(4, 6), (24, 6)], colour, width_px)
    return f"<li>{canvas.markup('', css_class='disc' if disc else 'key')}{_text(name)}</li>"


# --- the table ---


def _table(drive: Drive, say: Say) -> Iterator[str]:
    rows = Timeline(drive, say).rows()
    if not rows:
        return
    used = [name for name in _NUMBERS if any(_number(row, name) is not None for row in rows)]
    heads = ["".join(f'<th scope="col"{_sort(name)}><span>{_text(say(f"column_{name}"))}</span></th>'
                     for name in ("time", "turn", "kind", "text", *used))]  # fmt: skip
    yield f'<section id="timeline">\n<h2>{_text(say("heading_timeline"))}</h2>'
    yield f"<table>\n<thead><tr>{''.join(heads)}</tr></thead>\n<tbody>"
    for row in rows[:MOST_ROWS]:
        yield _row(row, used, say)
    yield "</tbody>\n</table>"
    if len(rows) > MOST_ROWS:
        yield f'<p class="soft">{_text(say("rows_left_out", count=len(rows) - MOST_ROWS))}</p>'
    yield "</section>"


def _sort(name: str) -> str:
    is_number = ' class="n"' if name in ("time", "turn", *_NUMBERS) else ""
    return is_number + (' aria-sort="ascending"' if name == "time" else "")


def _row(row: Row, used: list[str], say: Say) -> str:
    text = _text(row.text)
    if row.more:
        text = f"<details><summary>{text}</summary><pre>{_text(row.more)}</pre></details>"
    turn = _cell(str(row.turn), say("column_turn")) if row.turn > 0 else _cell("", "")
    cells = [_cell(clock(row.t_s, 1), "", f"{row.t_s:.3f}"), turn]
    cells.append(f'<td><span class="kind">{_text(say(f"kind_{row.kind}"))}</span></td>')
    cells.append(f'<td class="text" dir="auto">{text}</td>')
    for name in used:
        value = _number(row, name)
        cells.append(_cell("" if value is None else f"{value:.{_DECIMALS[name]}f}", say(f"column_{name}")))
    return f'<tr class="{row.kind}">{"".join(cells)}</tr>'


_DECIMALS = {"told": 2, "measured": 2, "took": 1, "tokens": 0, "cost": 4}


def _number(row: Row, name: str) -> float | None:
    values = (row.told_m, row.measured_m, row.duration_s, row.token_count, row.cost_usd)
    value = dict(zip(_NUMBERS, values))[name]
    return value if value is not None and math.isfinite(value) else None


def _cell(text: str, name: str, value: str = "") -> str:
    named = f' data-name="{_text(name)}"' if name and text else ""
    sorted_by = f' data-value="{value}"' if value else ""
    return f'<td class="n"{named}{sorted_by}>{text}</td>'
