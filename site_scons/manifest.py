"""tactus.gdextension, the file by which Godot finds the extension's libraries.

The methods that a library asks Godot for are those of the API that it was generated from, so an older Godot cannot
load it: `compatibility_minimum` is that API's version.
"""

import json
import re
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "tools"))
from setup import platforms  # noqa: E402

ADDON = Path("demo_project/addons/tactus")  # in the clone
CLONE = Path(__file__).resolve().parents[1]
TARGETS = {"debug": "template_debug", "release": "template_release"}
EYES = ["tactus_sensing", "tactus_camera"]
SUFFIX = {"linux": "so", "windows": "dll", "macos": "dylib"}


def library(platform, target, name="tactus"):
    """The file name of a library: the extension's own, or one that it loads from beside itself."""
    return f"lib{name}.{platform.system}.{target}.{platform.architecture}.{SUFFIX[platform.system]}"


def api_version(description):
    """Version and precision of a generated API: extension_api.json."""
    header = json.loads(description.read_text())["header"]
    return f"{header['version_major']}.{header['version_minor']}", header.get("precision", "single")


def installed_api_version(includes):
    """The same of an installed godot-cpp, from the version header that it generates; None where it has none."""
    for include in includes:
        header = Path(include, "godot_cpp/core/version.hpp")
        if header.is_file():
            numbers = dict(re.findall(r"GODOT_VERSION_(MAJOR|MINOR)\s+(\d+)", header.read_text()))
            if len(numbers) == 2:
                return f"{numbers['MAJOR']}.{numbers['MINOR']}", "single"
    return None


def text(minimum, precision, systems, seeing=()):
    """`systems`: the platforms of every library beside it; `seeing`: those of them that have the eyes' libraries, too."""
    lines = ["[configuration]", "", 'entry_symbol = "tactus_library_init"', f'compatibility_minimum = "{minimum}"']
    lines += ["reloadable = false", "", "[libraries]", ""]
    for platform in systems:
        for feature, target in TARGETS.items():
            lines.append(f'{_tags(platform, feature, precision)} = "bin/{library(platform, target)}"')
    if seeing:
        # Loaded by the extension itself; named here so that exported programs have them beside it.
        lines += ["", "[dependencies]", ""]
    for platform in seeing:
        for feature, target in TARGETS.items():
            eyes = ", ".join(f'"bin/{library(platform, target, name)}": ""' for name in EYES)
            lines.append(f"{_tags(platform, feature, precision)} = {{{eyes}}}")
    lines += ["", "[icons]", ""]
    lines += [f'{name} = "icons/{icon.name}"' for icon in sorted((CLONE / ADDON / "icons").glob("*.svg")) for name in names(icon.stem)]
    return "\n".join(lines) + "\n"


def names(class_name):
    """The classes with the icon of this one: itself under its former name (`was` in the class reference), and statistics of its kind."""
    roots = {path.stem: ElementTree.parse(path).getroot() for path in sorted((CLONE / "extension/doc_classes").glob("*.xml"))}
    was = roots[class_name].get("was") if class_name in roots else None
    kinds = [name for name, root in roots.items() if root.get("statistics_of") and root.get("inherits") == class_name]
    return [class_name, *([was] if was else []), *kinds]


def _tags(platform, feature, precision):
    """A library of one precision cannot be loaded by a Godot of the other: the tag hides it. A universal one is for any processor."""
    one = [] if platform.architecture == platforms.UNIVERSAL else [platform.architecture]
    return ".".join([platform.system, feature, precision, *one])


def write(path, content):
    """Leaves a file that says the same already as it is: Godot imports what has changed."""
    if not path.is_file() or path.read_text() != content:
        path.write_text(content)
