"""build/bench/device_conditioning.csv as a chart: how well the hand is held by the arm, over the workspace."""

import csv
import sys
from pathlib import Path

import numpy
from plots import style

GEOMETRIES = {"falcon": "libnifalcon's geometry", "falcon_martin": "Martin and Hillier's geometry"}


def slices(path: Path) -> dict[str, dict[str, numpy.ndarray]]:
    """Grids of condition numbers by geometry: x across, z along the axis of the device (millimetres)."""
    with path.open(newline="") as file:
        rows = list(csv.DictReader(file))
    found = {}
    for name in GEOMETRIES:
        own = [row for row in rows if row["geometry"] == name]
        x = sorted({float(row["x_mm"]) for row in own})
        z = sorted({float(row["z_mm"]) for row in own})
        grid = numpy.full((len(x), len(z)), numpy.nan)
        for row in own:
            if row["condition"]:
                grid[x.index(float(row["x_mm"])), z.index(float(row["z_mm"]))] = float(row["condition"])
        found[name] = {"x": numpy.array(x), "z": numpy.array(z), "condition": grid}
    return found


def draw(result: Path) -> None:
    source = result.with_name("device_conditioning.csv")
    if not source.is_file():
        return
    figure, ((*all_axes,),) = style.figure(1, 2, 10.0, 4.4)
    for axes, (name, one) in zip(all_axes, slices(source).items(), strict=True):
        levels = [1, 1.5, 2, 3, 4, 6, 8, 12]
        drawn = axes.contourf(one["z"], one["x"], one["condition"], levels=levels, extend="max")
        axes.set_title(GEOMETRIES[name])
        axes.set_xlabel("along the device's axis (mm)")
        axes.set_aspect("equal")
        axes.grid(False)
    all_axes[0].set_ylabel("across (mm)")
    figure.colorbar(drawn, ax=all_axes, label="condition of the Jacobian")
    style.save(figure, result.with_name("device_conditioning.png"))


if __name__ == "__main__":
    draw(Path(sys.argv[1]))
