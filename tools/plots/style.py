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
