"""./run docs --figures: makes each table anew that a command makes (doc_tables/make.py).
./run docs: README.md, docs/ and the class reference as pages in build/docs/, made by Sphinx.

Sphinx, for it reads Markdown (by MyST), checks every reference between pages, writes plain files that work from a folder as well
as from a server, brings its own themes, and has been kept well for many years; MkDocs, which does most of this, has had no release
since August 2024. A warning is an error: a page that nothing leads to, a link to
nowhere, a heading out of order.
"""

import shutil
import subprocess
import sys
from pathlib import Path

import entry
from setup import cache

# Pages by the heading they stand under beside every page. README.md is the first page.
CONTENTS = {
    "Begin": ["addon", "tutorials/falcon", "tutorials/two_computers", "tutorials/depth_camera", "troubleshooting"],
    "Research": ["tutorials/own_experiment", "experiments", "studies", "bundles", "teleoperation"],
    "Extend": ["tutorials/own_force_effect", "tutorials/own_driver", "wire_format"],
    "Reference": ["classes/index"],
    "How it works": ["architecture", "proxy", "proxy_steps", "tool", "soft", "physics", "devices", "sensing", "discovery", "tolerances", "stress", "proof"],
    "Changes": ["changes"],
}


def main(arguments: list[str]) -> int:
    if "--figures" in arguments:
        from doc_tables import make as tables

        changed = tables.all_tables()
        print(f"{len(changed)} tables are others than they were{': ' if changed else ''}{', '.join(changed)}")
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
    (folder / "index.md").write_text(from_above((cache.clone() / "README.md").read_text()) + contents())
    shutil.copy(cache.clone() / "CHANGELOG.md", folder / "changes.md")
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


def contents() -> str:
    return "".join(f"\n```{{toctree}}\n:hidden:\n:caption: {title}\n\n" + "\n".join(pages) + "\n```\n" for title, pages in CONTENTS.items())


if __name__ == "__main__":
    entry.leave(main)
