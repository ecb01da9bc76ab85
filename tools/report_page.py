"""A page of HTML that needs nothing but itself: style and pictures are inside."""

import base64
from collections.abc import Sequence
from html import escape
from pathlib import Path

STYLE = """
:root { --ink: #1f2933; --quiet: #65717e; --line: #e1e5ea; --good: #2f7d4f; --bad: #b3372f; --paper: #fff; --panel: #f6f7f9; }
* { box-sizing: border-box; }
body { margin: 0; background: var(--paper); color: var(--ink);
       font: 16px/1.55 "Source Serif 4", "Iowan Old Style", Charter, Georgia, serif; }
main { max-width: 60rem; margin: 0 auto; padding: 3rem 1.5rem 5rem; }
h1, h2, h3, table, figcaption, .lead, nav { font-family: "Inter", "Segoe UI", system-ui, "DejaVu Sans", sans-serif; }
h1 { font-size: 2.1rem; letter-spacing: -.02em; margin: 0 0 .3rem; }
h2 { font-size: 1.35rem; margin: 3rem 0 .6rem; padding-top: 1.2rem; border-top: 1px solid var(--line); }
h3 { font-size: 1.05rem; margin: 2rem 0 .5rem; }
p { max-width: 44rem; margin: .6rem 0; }
.lead { color: var(--quiet); font-size: 1.05rem; }
table { border-collapse: collapse; width: 100%; margin: 1rem 0 1.6rem; font-size: .875rem; font-variant-numeric: tabular-nums; }
th { text-align: left; font-weight: 600; color: var(--quiet); border-bottom: 2px solid var(--line); padding: .4rem .9rem .4rem 0; }
td { border-bottom: 1px solid var(--line); padding: .4rem .9rem .4rem 0; vertical-align: top; }
th.number, td.number { text-align: right; }
.met { color: var(--good); font-weight: 600; white-space: nowrap; }
.missed { color: var(--bad); font-weight: 600; white-space: nowrap; }
figure { margin: 1.4rem 0; }
figure img { display: block; width: 100%; height: auto; border: 1px solid var(--line); border-radius: 6px; }
figcaption { color: var(--quiet); font-size: .85rem; margin-top: .5rem; }
@media (max-width: 45rem) { table { display: block; overflow-x: auto; } main { padding: 2rem 1rem 3rem; } }
@media print { main { padding: 0; } figure, table { break-inside: avoid; } }
"""


def page(title: str, lead: str, sections: Sequence[str]) -> str:
    return (
        f'<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        f'<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f"<title>{escape(title)}</title>\n<style>{STYLE}</style>\n</head>\n<body>\n<main>\n"
        f'<h1>{escape(title)}</h1>\n<p class="lead">{escape(lead)}</p>\n' + "\n".join(sections) + "\n</main>\n</body>\n</html>\n"
    )


def section(title: str, *parts: str, level: int = 2) -> str:
    return f"<section>\n<h{level}>{escape(title)}</h{level}>\n" + "\n".join(parts) + "\n</section>"


def paragraph(text: str) -> str:
    return f"<p>{escape(text)}</p>"


def picture(path: Path, caption: str) -> str:
    data = base64.b64encode(path.read_bytes()).decode()
    return (
        f'<figure><img alt="{escape(caption)}" src="data:image/png;base64,{data}">'
        f"<figcaption>{escape(caption)}</figcaption></figure>"
    )


def files(paths: Sequence[Path]) -> str:
    """Links to files that lie beside the page."""
    return "<p>" + ", ".join(f'<a href="{escape(path.name)}">{escape(path.name)}</a>' for path in paths) + "</p>"


def table(head: Sequence[str], rows: Sequence[Sequence[str | bool]], numbers_from: int = 1) -> str:
    """Columns from `numbers_from` on are set to the right; True and False become words."""

    def cell(tag: str, column: int, value: str | bool) -> str:
        if isinstance(value, bool):
            return f'<{tag} class="{"met" if value else "missed"}">{"met" if value else "missed"}</{tag}>'
        return f"<{tag}{' class=number' if column >= numbers_from else ''}>{escape(value)}</{tag}>"

    def line(tag: str, values: Sequence[str | bool]) -> str:
        return "<tr>" + "".join(cell(tag, column, value) for column, value in enumerate(values)) + "</tr>"

    return f"<table>\n<thead>{line('th', head)}</thead>\n<tbody>\n" + "\n".join(line("td", row) for row in rows) + "\n</tbody>\n</table>"
