"""How every plot looks."""

from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

INK = "#1f2933"
QUIET = "#7b8794"
GRID = "#e4e7eb"
# Told apart without colour vision, and equally dark.
MEASURED, REFERENCE, WARNING = "#1f5fa8", "#c4622d", "#a63d57"
AXES = {"x": "#b2443f", "y": "#3f8148", "z": "#33649c"}  # as Godot paints them

plt.rcParams.update(
    {
        "svg.hashsalt": "tactus",  # the same rows give the same names inside
        "pdf.fonttype": 42,  # letters as letters, which journals ask for
        "figure.dpi": 140,
        "figure.facecolor": "white",
        "font.size": 10,
        "font.family": "DejaVu Sans",
        "text.color": INK,
        "axes.labelcolor": INK,
        "axes.edgecolor": QUIET,
        "axes.titlesize": 11,
        "axes.titleweight": "bold",
        "axes.titlelocation": "left",
        "axes.spines.top": False,
        "axes.spines.right": False,
        "axes.grid": True,
        "axes.axisbelow": True,
        "grid.color": GRID,
        "xtick.color": QUIET,
        "ytick.color": QUIET,
        "xtick.labelcolor": INK,
        "ytick.labelcolor": INK,
        "legend.frameon": False,
        "lines.linewidth": 1.6,
    }
)


def figure(rows: int, columns: int, width: float, height: float, **more):
    return plt.subplots(rows, columns, figsize=(width, height), layout="constrained", squeeze=False, **more)


def save(drawn, path: Path) -> None:
    # Without the program's version in it, the same rows give the same bytes.
    drawn.savefig(path, metadata={"Software": None})
    plt.close(drawn)


# What a paper takes: pixels for a draft, curves for print. Without dates, as above.
FOR_PAPERS = {".png": {"Software": None}, ".svg": {"Date": None}, ".pdf": {"CreationDate": None}}


def save_for_paper(drawn, path: Path) -> list[Path]:
    """`path` without its ending, one file for each."""
    paths = [path.with_name(path.name + ending) for ending in FOR_PAPERS]
    for one, metadata in zip(paths, FOR_PAPERS.values()):
        drawn.savefig(one, metadata=metadata, dpi=300)
    plt.close(drawn)
    return paths


def told_apart(count: int) -> list[dict[str, object]]:
    """How so many lines look: by brightness, by the line and by the mark on it, so that a grey print tells them apart."""
    marks = ("o", "s", "^", "D", "v", "P", "X", "<", ">", "*")
    lines = ("-", (0, (5, 2)), (0, (1, 1.2)), (0, (6, 2, 1, 2)), (0, (3, 1, 1, 1, 1, 1)))
    shades = matplotlib.colormaps["viridis"]([0.8 * number / max(count - 1, 1) for number in range(count)])
    return [
        {"color": shade, "marker": marks[number % len(marks)], "linestyle": lines[number % len(lines)], "markersize": 4.5}
        for number, shade in enumerate(shades)
    ]
