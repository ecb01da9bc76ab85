"""Writes the mesh library: meshes/NAME.obj, meshes/library.json and what tells Godot to export them as they are.

    python3 tools/make_meshes.py

Everything is made here from formulas, in metres, y up, centred near the origin, closed, counter-clockwise from outside.
Masses follow from volume and density.
"""

import json
import math
import random
from pathlib import Path

FOLDER = Path(__file__).resolve().parent.parent / "meshes"

Point = tuple[float, float, float]
Mesh = tuple[list[Point], list[tuple[int, ...]]]  # vertices; faces as indices into them

WOOD, PLASTIC, ALUMINIUM = 600.0, 1050.0, 2700.0  # densities (kg/m³)


def cube(edge: float = 0.1) -> Mesh:
    h = edge / 2
    vertices = [(x, y, z) for x in (-h, h) for y in (-h, h) for z in (-h, h)]
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return vertices, faces


def icosphere(radius: float = 0.05, subdivisions: int = 3) -> Mesh:
    golden = (1 + math.sqrt(5)) / 2
    vertices = [p for a in (-1.0, 1.0) for b in (-golden, golden) for p in ((a, b, 0.0), (0.0, a, b), (b, 0.0, a))]
    edge = 2.0
    close = [[distance(p, q) < edge * 1.01 for q in vertices] for p in vertices]
    count = len(vertices)
    faces = [
        outward(vertices, (i, j, k))
        for i in range(count)
        for j in range(i + 1, count)
        for k in range(j + 1, count)
        if close[i][j] and close[j][k] and close[i][k]
    ]
    for _ in range(subdivisions):
        vertices, faces = subdivided(vertices, faces)
    return [scaled_to(p, radius) for p in vertices], faces


def subdivided(vertices: list[Point], faces: list[tuple[int, ...]]) -> Mesh:
    vertices = list(vertices)
    middle: dict[tuple[int, int], int] = {}

    def between(i: int, j: int) -> int:
        key = (min(i, j), max(i, j))
        if key not in middle:
            middle[key] = len(vertices)
            size = math.hypot(*vertices[i])
            half = tuple((a + b) / 2 for a, b in zip(vertices[i], vertices[j]))
            vertices.append(scaled_to(half, size))
        return middle[key]

    finer = []
    for a, b, c in faces:
        ab, bc, ca = between(a, b), between(b, c), between(c, a)
        finer += [(a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca)]
    return vertices, finer


def torus(ring: float = 0.06, tube: float = 0.02, around: int = 48, across: int = 24) -> Mesh:
    vertices = []
    for i in range(around):
        u = 2 * math.pi * i / around
        for j in range(across):
            v = 2 * math.pi * j / across
            reach = ring + tube * math.cos(v)
            vertices.append((reach * math.cos(u), tube * math.sin(v), reach * math.sin(u)))

    def index(i: int, j: int) -> int:
        return i % around * across + j % across

    faces = [
        (index(i, j), index(i, j + 1), index(i + 1, j + 1), index(i + 1, j))
        for i in range(around)
        for j in range(across)
    ]
    return vertices, faces


def cylinder(radius: float = 0.04, height: float = 0.1, around: int = 48) -> Mesh:
    h = height / 2
    ring = [(radius * math.cos(t), radius * math.sin(t)) for t in (2 * math.pi * i / around for i in range(around))]
    return extruded([(x, z) for x, z in ring], -h, h)


def bracket(long: float = 0.1, high: float = 0.08, thick: float = 0.02, wide: float = 0.05) -> Mesh:
    """An L standing on its long leg: one concave edge."""
    outline = [(0, 0), (long, 0), (long, thick), (thick, thick), (thick, high), (0, high)]
    x0, y0 = long / 2, high / 2
    flat = [(x - x0, y - y0) for x, y in outline]
    vertices, faces = extruded([(x, y) for x, y in flat], -wide / 2, wide / 2)
    # extruded() grows along y; turn its (x, height, z) so that the outline stands upright.
    return [(x, z, -y) for x, y, z in vertices], triangulated_caps(faces, len(flat))


def triangulated_caps(faces: list[tuple[int, ...]], corners: int) -> list[tuple[int, ...]]:
    """The L's caps are not convex: a fan around the inner corner (3) covers them without leaving them."""
    result = []
    for face in faces:
        if len(face) != corners:
            result.append(face)
            continue
        start = next(i for i, index in enumerate(face) if index % corners == 3)
        turned = face[start:] + face[:start]
        result += [(turned[0], turned[i], turned[i + 1]) for i in range(1, corners - 1)]
    return result


def wedge(long: float = 0.12, high: float = 0.06, wide: float = 0.08) -> Mesh:
    x, y, z = long / 2, high / 2, wide / 2
    vertices = [(-x, -y, -z), (x, -y, -z), (x, y, -z), (-x, -y, z), (x, -y, z), (x, y, z)]
    faces = [(0, 2, 1), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (0, 3, 5, 2)]
    return vertices, faces


def blob(radius: float = 0.05, seed: int = 5) -> Mesh:
    """A sphere with smooth bumps: plane waves over its surface, seeded."""
    vertices, faces = icosphere(1.0, 4)
    source = random.Random(seed)
    waves = [([source.gauss(0, 2.2) for _ in range(3)], source.uniform(0, 2 * math.pi)) for _ in range(6)]

    def bump(p: Point) -> float:
        return sum(math.sin(sum(a * b for a, b in zip(k, p)) + phase) for k, phase in waves)

    return [scaled_to(p, radius * (1 + 0.06 * bump(p))) for p in vertices], faces


def extruded(outline: list[tuple[float, float]], low: float, high: float) -> Mesh:
    """A prism along y over an outline in x–z."""
    count = len(outline)
    vertices = [(x, y, z) for y in (low, high) for x, z in outline]
    sides = [(i, (i + 1) % count, count + (i + 1) % count, count + i) for i in range(count)]
    faces = [*sides, tuple(reversed(range(count))), tuple(range(count, 2 * count))]
    return (vertices, faces) if volume((vertices, faces)) > 0 else (vertices, [face[::-1] for face in faces])


def distance(p: Point, q: Point) -> float:
    return math.dist(p, q)


def scaled_to(p: tuple[float, ...], length: float) -> Point:
    factor = length / math.hypot(*p)
    x, y, z = (c * factor for c in p)
    return x, y, z


def outward(vertices: list[Point], face: tuple[int, int, int]) -> tuple[int, int, int]:
    a, b, c = (vertices[i] for i in face)
    return face if determinant(a, b, c) > 0 else (face[0], face[2], face[1])


def determinant(a: Point, b: Point, c: Point) -> float:
    return (
        a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) + a[2] * (b[0] * c[1] - b[1] * c[0])
    )


def volume(mesh: Mesh) -> float:
    """By the divergence theorem; positive where the faces look outward (m³)."""
    vertices, faces = mesh
    fans = ((face[0], face[i], face[i + 1]) for face in faces for i in range(1, len(face) - 1))
    return sum(determinant(*(vertices[i] for i in fan)) for fan in fans) / 6


def assert_closed(mesh: Mesh) -> None:
    edges = {(face[i], face[(i + 1) % len(face)]) for face in mesh[1] for i in range(len(face))}
    assert all((b, a) in edges for a, b in edges), "an edge has a face on one side only"
    assert sum(len(face) for face in mesh[1]) == len(edges), "two faces run along an edge the same way"
    assert volume(mesh) > 0, "the faces look inward"


def obj_text(name: str, mesh: Mesh) -> str:
    vertices, faces = mesh
    lines = [f"# {name}: made by tools/make_meshes.py; metres, y up", f"o {name}"]
    lines += ["v " + " ".join(f"{c:.9f}" for c in vertex) for vertex in vertices]
    lines += ["f " + " ".join(str(i + 1) for i in face) for face in faces]
    return "\n".join(lines) + "\n"


LIBRARY = {
    "cube": (cube(), WOOD),
    "icosphere": (icosphere(), PLASTIC),
    "torus": (torus(), PLASTIC),
    "cylinder": (cylinder(), WOOD),
    "bracket": (bracket(), ALUMINIUM),
    "wedge": (wedge(), WOOD),
    "blob": (blob(), PLASTIC),
}


def main() -> None:
    FOLDER.mkdir(exist_ok=True)
    entries = {}
    for name, (mesh, density) in sorted(LIBRARY.items()):
        assert_closed(mesh)
        (FOLDER / f"{name}.obj").write_text(obj_text(name, mesh))
        (FOLDER / f"{name}.obj.import").write_text('[remap]\n\nimporter="keep"\n')
        entries[name] = {
            "mass_kg": round(volume(mesh) * density, 4),
            "density_kg_m3": density,
            "source": "generated by tools/make_meshes.py",
        }
    (FOLDER / "library.json").write_text(json.dumps(entries, indent=2) + "\n")


if __name__ == "__main__":
    main()
