"""One table of what a local model gives the hand: scenario 4 beside scenario 2."""

from collections.abc import Sequence

HEAD = ("Displayed force", "Direct (2)", "Model-mediated (4)", "Gained")
SCENES = {"static": "Static bodies", "dynamic": "A pushed box, local model wrong"}

_ROWS = (
    ("force_error_mean_N", "force error, mean", "{:.3f} N", 1.0),
    ("force_error_p95_N", "force error, 95 %", "{:.3f} N", 1.0),
    ("contact_delay_ms", "contact delay", "{:.0f} ms", 1.0),
    ("phantom_force_share", "phantom contact", "{:.1f} % of the time", 100.0),
)
NEVER = "never"  # of what has not happened, such as a touch that was felt
# Less than this is none (units as shown).
_NONE = 5e-4


def rows(summary: dict) -> list[tuple[str, str, str, str]]:
    found = []
    for scene, title in SCENES.items():
        for key, name, form, scale in _ROWS:
            both = [summary[f"{scene}.{scenario}.{key}"] for scenario in ("traditional", "mmt")]
            shown = [NEVER if value is None else form.format(scale * float(value)) for value in both]
            told = "" if None in both else gained(*(scale * float(value) for value in both))
            found.append((f"{title}: {name}", *shown, told))
    return found


def gained(before: float, after: float) -> str:
    if before < _NONE:
        return "–" if after < _NONE else "worse"
    if after < _NONE:
        return "no error left"
    return f"{before / after:.1f} × less" if after < before else f"{after / before:.1f} × more" if after > before else "nothing"


def text(summary: dict) -> str:
    table = [HEAD, *rows(summary)]
    widths = [max(len(line[column]) for line in table) for column in range(len(HEAD))]

    def line(cells: Sequence[str]) -> str:
        first, *others = cells
        return "  ".join([first.ljust(widths[0]), *(cell.rjust(width) for cell, width in zip(others, widths[1:]))])

    rule = "  ".join("─" * width for width in widths)
    return "\n".join(["", line(HEAD), rule, *(line(cells) for cells in table[1:]), ""])
