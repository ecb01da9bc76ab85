"""What a depth camera has seen and found, and the forces that came of it: scenario 5."""

from pathlib import Path

import numpy as np

from plots import style
from project import FOLDER

MESHES = FOLDER / "addons/tactus/meshes"
FOUND = style.WARNING


def read_mesh(path: Path) -> tuple[np.ndarray, np.ndarray]:
    """Corners, and the edges between two faces that differ, of an .obj file of triangles."""
    words = [line.split() for line in path.read_text().splitlines()]
    corners = np.array([[float(value) for value in line[1:4]] for line in words if line[:1] == ["v"]])
    faces = np.array([[int(value.split("/")[0]) - 1 for value in line[1:4]] for line in words if line[:1] == ["f"]])
    normals = np.cross(corners[faces[:, 1]] - corners[faces[:, 0]], corners[faces[:, 2]] - corners[faces[:, 0]])
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
    of_edge: dict[tuple[int, int], list[int]] = {}
    for number, face in enumerate(faces):
        for a, b in zip(face, np.roll(face, 1), strict=True):
            of_edge.setdefault((min(a, b), max(a, b)), []).append(number)
    creased = [edge for edge, two in of_edge.items() if len(two) < 2 or normals[two[0]] @ normals[two[1]] < 0.9]
    return corners, np.array(creased or list(of_edge))


def seen_from(points: np.ndarray) -> np.ndarray:
    """Where points of the camera's frame are in its image, in units of the focal length, y up."""
    return points[:, :2] / -points[:, 2:3]


def depth_image(points: np.ndarray) -> tuple[np.ndarray, list[float]]:
    """Depths by rows and columns of an image, not a number where nothing is seen; and where it lies (left, right, top, bottom).

    Points come row by row, some of each row: a cell is as wide as two that follow each other are mostly apart.
    """
    at = seen_from(points) * np.array([1.0, -1.0])
    steps = np.diff(at[:, 0])
    cell = np.median(steps[steps > 0.0])
    low = at.min(axis=0)
    column, row = np.round((at - low) / cell).astype(int).T
    sums, counts = np.zeros((row.max() + 1, column.max() + 1)), np.zeros((row.max() + 1, column.max() + 1))
    np.add.at(sums, (row, column), -points[:, 2])
    np.add.at(counts, (row, column), 1.0)
    image = np.where(counts > 0.0, sums / np.maximum(counts, 1.0), np.nan)
    left, top = low - 0.5 * cell
    rows, columns = image.shape
    return image, [left, left + columns * cell, -(top + rows * cell), -top]


def draw_seen(seen: dict, path: Path) -> None:
    """Depths as the camera has them, and over them the objects at the places where they were found."""
    points = np.array(seen["points"]).reshape(-1, 3)
    drawn, ((axes,),) = style.figure(1, 1, 7.2, 5.4)
    image, extent = depth_image(points)
    axes.set_facecolor(style.QUIET)
    depths = axes.imshow(image, extent=extent, cmap="viridis", interpolation="nearest")
    drawn.colorbar(depths, ax=axes, label="depth (mm)", shrink=0.8)
    for name, (x, y, z, origin) in seen["objects"].items():
        if not (MESHES / f"{name}.obj").is_file():
            continue
        corners, edges = read_mesh(MESHES / f"{name}.obj")
        placed = seen_from(1e3 * corners @ np.array([x, y, z]) + np.array(origin))
        for a, b in edges:
            axes.plot(*placed[[a, b]].T, color=FOUND, linewidth=0.9)
        axes.annotate(name, placed[np.argmax(placed[:, 1])], textcoords="offset points", xytext=(0, 6), color=FOUND, ha="center")
    axes.set(title="What the camera sees, and what was found in it", aspect="equal", xticks=[], yticks=[])
    axes.grid(False)
    style.save(drawn, path)


def draw_forces(time: np.ndarray, forces: dict[str, np.ndarray], title: str, path: Path) -> None:
    """Sizes of forces (n × 3) over time."""
    looks = {"direct touch": (style.QUIET, 3.0), "on the hand": (style.MEASURED, 1.2), "on the robot": (style.REFERENCE, 1.0)}
    drawn, ((axes,),) = style.figure(1, 1, 9.0, 3.2)
    for name, force in forces.items():
        colour, width = looks[name]
        axes.plot(time, np.linalg.norm(force, axis=1), color=colour, linewidth=width, label=name)
    axes.set(title=title, xlabel="time (s)", ylabel="force (N)", ylim=(0, None))
    axes.legend(loc="upper left")
    style.save(drawn, path)
