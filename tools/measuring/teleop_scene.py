"""A scene of the demo project as plain lines, for tests/bench/teleop.cpp: bodies below the HapticWorld, the pointer and
the hand's path. Understands what the experiments' scenes consist of: static and rigid bodies with boxes and spheres,
HapticMaterial, one HapticDevice with a HapticPath, one ProxyPointer.
"""

import re
from pathlib import Path

from project import FOLDER

# Godot's defaults, which scene files leave out.
LINEAR_DAMPING = ANGULAR_DAMPING = 0.1
_SECTION = re.compile(r"^\[(\w+)(.*)\]$")
_ATTRIBUTE = re.compile(r'(\w+)=("[^"]*"|\S+)')


class _Section:
    def __init__(self, kind: str, attributes: dict[str, str]):
        self.kind = kind
        self.attributes = attributes
        self.values: dict[str, str] = {}


def _sections(path: Path) -> list[_Section]:
    found: list[_Section] = []
    for line in path.read_text().splitlines():
        section = _SECTION.match(line)
        if section:
            attributes = {key: value.strip('"') for key, value in _ATTRIBUTE.findall(section[2])}
            found.append(_Section(section[1], attributes))
        elif " = " in line and found:
            key, value = line.split(" = ", 1)
            found[-1].values[key] = value
    return found


def _file(resource: str) -> Path:
    return FOLDER / resource.removeprefix("res://")


def _numbers(text: str) -> list[float]:
    return [float(number) for number in re.findall(r"-?\d+(?:\.\d+)?(?:e-?\d+)?", text.partition("(")[2])]


def _reference(text: str) -> str:
    return re.search(r'"([^"]*)"', text)[1]


class Scene:
    def __init__(self, resource: str):
        sections = _sections(_file(resource))
        self._external = {s.attributes["id"]: s.attributes["path"] for s in sections if s.kind == "ext_resource"}
        self._inner = {s.attributes["id"]: s for s in sections if s.kind == "sub_resource"}
        self._nodes = [s for s in sections if s.kind == "node"]

    def bodies(self) -> list[str]:
        return [node.attributes["name"] for node in self._nodes if _is_body(node)]

    def lines(self) -> str:
        """What the runner reads."""
        lines = []
        for node in self._nodes:
            kind = node.attributes.get("type")
            if _is_body(node):
                lines += self._body(node)
            elif kind == "HapticDevice":
                lines += [f"limit {node.values.get('force_limit', '8')}", self._path(node)]
            elif kind == "ProxyPointer":
                lines.append(f"radius {node.values.get('radius', '0.01')}")
        return "\n".join(lines) + "\n"

    def dynamic(self) -> list[str]:
        return [node.attributes["name"] for node in self._nodes if node.attributes.get("type") == "RigidBody3D"]

    def place(self, body: str) -> list[float]:
        return _placement(next(node for node in self._nodes if node.attributes["name"] == body))[:3]

    def varied(self, variation: dict) -> str:
        """What the runner reads, with copies of bodies elsewhere, hinges to the world, and another path of the hand:
        {"copies": {"Box2": {"of": "Box", "at": [x, y, z]}}, "hinges": {"Box": {"at": [x, y, z], "axis": [x, y, z]}},
        "frictionless": ["Box"], "damping": {"Box": [linear, angular]}, "without": ["Sphere"], "path": [[seconds, x, y, z], …]}
        """
        lines = self.lines().splitlines()
        if "path" in variation:
            keys = [word for keyframe in variation["path"] for word in _texts(keyframe)]
            lines = [" ".join(["path", "linear", *keys]) if line.startswith("path ") else line for line in lines]
        for name in variation.get("without", []):
            start = next(i for i, line in enumerate(lines) if line.startswith(f"body {name} "))
            del lines[start : next(i for i in range(start + 1, len(lines) + 1) if not _is_shape(lines[i : i + 1]))]
        for name in variation.get("frictionless", []):
            start = next(i for i, line in enumerate(lines) if line.startswith(f"body {name} "))
            words = lines[start].split()
            lines[start] = " ".join([*words[:8], "0", "0", *words[10:]])
        for name, damping in variation.get("damping", {}).items():
            start = next(i for i, line in enumerate(lines) if line.startswith(f"body {name} "))
            lines[start] = " ".join([*lines[start].split()[:-2], *_texts(damping)])
        for name, copy in variation.get("copies", {}).items():
            start = next(i for i, line in enumerate(lines) if line.startswith(f"body {copy['of']} "))
            _, _, *words = lines[start].split()
            words[8:11] = _texts(copy["at"])
            lines.append(" ".join(["body", name, *words]))
            for line in lines[start + 1 :]:
                if not _is_shape([line]):
                    break
                lines.append(line)
        for name, hinge in variation.get("hinges", {}).items():
            lines.append(" ".join(["hinge", name, *_texts(hinge["at"]), *_texts(hinge["axis"])]))
        return "\n".join(lines) + "\n"

    def _resource(self, text: str) -> dict[str, str]:
        """The values of an ExtResource or SubResource."""
        name = _reference(text)
        if text.startswith("SubResource"):
            return self._inner[name].values
        return next(s.values for s in _sections(_file(self._external[name])) if s.kind == "resource")

    def _body(self, node: _Section) -> list[str]:
        material = self._resource(node.values["physics_material_override"])
        dynamic = node.attributes["type"] == "RigidBody3D"
        surface = [material.get("friction", "1"), material.get("bounce", "0")]
        touch = [
            material.get(key, default)
            for key, default in (
                ("stiffness", "500"), ("damping", "0"), ("static_friction", "0"), ("dynamic_friction", "0"),
            )
        ]  # fmt: skip
        name = node.attributes["name"]
        head = [name, "dynamic" if dynamic else "static", node.values.get("mass", "1"), *surface, *touch]
        damping = [LINEAR_DAMPING, ANGULAR_DAMPING] if dynamic else [0.0, 0.0]
        lines = [" ".join(["body", *head, *_texts(_placement(node)), *_texts(damping)])]
        for child in self._nodes:
            if child.attributes.get("parent", "").endswith(f"/{name}") and "shape" in child.values:
                lines.append(self._shape(child))
        return lines

    def _shape(self, node: _Section) -> str:
        shape = self._inner[_reference(node.values["shape"])]
        place = _placement(node)
        if shape.attributes["type"] == "BoxShape3D":
            half = [size / 2 for size in _numbers(shape.values["size"])]
            return " ".join(["box", *_texts(half), *_texts(place)])
        return " ".join(["sphere", shape.values.get("radius", "0.5"), *_texts(place[:3])])

    def along(self, resource: str) -> str:
        """What the runner reads, with another path resource for the hand."""
        path = next(s.values for s in _sections(_file(resource)) if s.kind == "resource")
        lines = self.lines().splitlines()
        return "\n".join(_path_line(path) if line.startswith("path ") else line for line in lines) + "\n"

    def _path(self, device: _Section) -> str:
        return _path_line(self._resource(device.values["path"]))


def _path_line(path: dict[str, str]) -> str:
    if "points_positions" in path:
        points, times = _numbers(path["points_positions"]), _numbers(path["points_times"])
        how = "smooth" if path.get("points_interpolation", "0") == "1" else "linear"
        keys = [_texts([time, *points[3 * i : 3 * i + 3]]) for i, time in enumerate(times)]
        return " ".join(["path", how, *(word for key in keys for word in key)])
    circle = [path.get(f"circle_{key}") for key in ("radius", "amplitude", "turn_time", "waves")]
    return " ".join(["path", "circle", *_texts(_numbers(path["circle_center"])), *circle])


def _is_body(node: _Section) -> bool:
    return node.attributes.get("type") in ("StaticBody3D", "RigidBody3D")


def _is_shape(lines: list[str]) -> bool:
    return bool(lines) and lines[0].split()[0] in ("box", "sphere")


def _texts(numbers: list[float]) -> list[str]:
    return [repr(float(number)) for number in numbers]


def _placement(node: _Section) -> list[float]:
    """Position and quaternion (w, x, y, z) of a node's transform: three rows of a rotation, then the origin."""
    if "transform" not in node.values:
        return [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]
    xx, xy, xz, yx, yy, yz, zx, zy, zz, *origin = _numbers(node.values["transform"])
    w = max(0.0, 1.0 + xx + yy + zz) ** 0.5 / 2.0
    if w < 1e-6:
        raise ValueError(f"{node.attributes['name']} is turned by half a turn: turn it a little less")
    return [*origin, w, (zy - yz) / (4 * w), (xz - zx) / (4 * w), (yx - xy) / (4 * w)]
