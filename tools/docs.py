"""./run docs --figures: makes each table anew that a command makes (doc_tables/make.py).
./run docs --pictures: draws the pictures of docs/pictures/ anew (docs_pictures.py).
./run docs: README.md, docs/ and the class reference as pages in build/docs/, made by Sphinx.

Sphinx, for it reads Markdown (by MyST), checks every reference between pages, writes plain files that work from a folder as well
as from a server, brings its own themes, and has been kept well for many years; MkDocs, which does most of this, has had no release
since August 2024. A warning is an error: a page that nothing leads to, a link to
nowhere, a heading out of order.
"""

import re
import shutil
import subprocess
import sys
from pathlib import Path

import entry
from setup import cache

# Pages by the shelf they stand on beside every page. README.md is the first page.
CONTENTS = {
    "Guide": [
        "guide", "install", "addon", "editor", "gallery", "existing_project", "effects", "hardware", "platforms", "vr", "performance", "threads", "csharp",
        "migration", "safety", "faq", "troubleshooting", "tutorials/falcon", "tutorials/two_computers", "tutorials/depth_camera",
        "tutorials/own_force_effect", "tutorials/own_driver", "tutorials/own_experiment", "own_teleoperator", "studies",
    ],
    "Reference": ["classes/index", "godot_physics", "glossary", "wire_format", "experiments", "bundles", "bibliography"],
    "Results": [
        "reproduce", "thesis", "comparison", "proxy", "teleoperation", "tool", "soft", "physics", "credibility", "devices", "sensing", "discovery",
        "stress", "proof",
    ],
    "Internals": [
        "development", "architecture", "proxy_steps", "tolerances", "notebook/proxy", "notebook/tool", "notebook/teleoperation", "notebook/soft", "notebook/physics",
        "notebook/effects", "roadmap", "changes",
    ],
    "Project": ["CONTRIBUTING", "SECURITY", "CODE_OF_CONDUCT"],
}  # fmt: skip
# Beside the pages: what they link to and what is no page.
BESIDE = ["LICENSE", "CITATION.cff"]

_PAGES = {"CHANGELOG.md": "changes.md", "README.md": "index.md", "extension/doc_classes": "classes/index.md"}
_LINKED = [*_PAGES, *(f"{name}.md" for name in CONTENTS["Project"]), *BESIDE]
_ABOVE = re.compile(rf"\]\(((?:\.\./)*)\.\./({'|'.join(map(re.escape, _LINKED))})")


def main(arguments: list[str]) -> int:
    if "--figures" in arguments:
        from doc_tables import make as tables

        changed = tables.all_tables()
        print(f"{len(changed)} tables are others than they were{': ' if changed else ''}{', '.join(changed)}")
    if "--pictures" in arguments:
        import docs_pictures

        print(f"docs/pictures: {', '.join(docs_pictures.make())}")
    if arguments:
        return 0
    source = cache.emptied(cache.clone() / "build/docs_source")
    write(source)
    with cache.replacing(cache.clone() / "build/docs") as fresh:
        if problems := make(source, fresh):
            raise RuntimeError(problems)
    print(cache.shown(cache.clone() / "build/docs/index.html"))
    return 0


def write(folder: Path) -> None:
    """All pages as Markdown."""
    sys.path.insert(0, str(cache.clone() / "extension/binding"))
    from bind_classes import ClassTable

    from pages.class_pages import Reference

    shutil.copytree(cache.clone() / "docs", folder, dirs_exist_ok=True)
    for page in folder.rglob("*.md"):
        page.write_text(from_below(page.read_text()))
    (folder / "index.md").write_text(from_above((cache.clone() / "README.md").read_text()) + contents())
    shutil.copy(cache.clone() / "CHANGELOG.md", folder / "changes.md")
    for name in CONTENTS["Project"]:
        (folder / f"{name}.md").write_text(from_above((cache.clone() / f"{name}.md").read_text()))
    for name in BESIDE:
        shutil.copy(cache.clone() / name, folder / name)
    reference = Reference(ClassTable(path).help() for path in sorted((cache.clone() / "extension/doc_classes").glob("*.xml")))
    classes = folder / "classes"
    classes.mkdir()
    (classes / "index.md").write_text(reference.index())
    for name in reference.names():
        (classes / f"{name}.md").write_text(reference.page(name))


def make(source: Path, output: Path) -> str:
    """What is wrong with them; empty where nothing is."""
    options = ["-q", "-W", "--keep-going", "-b", "html", "-c", cache.clone() / "tools/pages", "-d", source.with_name("docs_cache")]
    done = subprocess.run([sys.executable, "-m", "sphinx", *options, source, output], text=True, capture_output=True)
    return done.stderr[-4000:] if done.returncode != 0 else ""


def from_above(text: str) -> str:
    """Links of a file beside docs/, as seen from inside."""
    return text.replace("](docs/", "](")


def from_below(text: str) -> str:
    """Links of a page to what is beside docs/, as seen from where that is a page, too."""
    return _ABOVE.sub(lambda found: f"]({found[1]}{_PAGES.get(found[2], found[2])}", text)


def contents() -> str:
    return "".join(f"\n```{{toctree}}\n:hidden:\n:caption: {title}\n\n" + "\n".join(pages) + "\n```\n" for title, pages in CONTENTS.items())


if __name__ == "__main__":
    entry.leave(main)
