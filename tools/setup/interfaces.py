"""Published interfaces of Godots that are older than this machine's: extension_api.json and gdextension_interface.h.

A library that was built against one loads in that Godot and in each newer 4.x.
"""

import re
from pathlib import Path

from . import cache, crates

CRATE = "gdextension-api"
CRATE_SHA256 = "2ec0a03c8f9c91e3d8eb7ca56dea81c7248c03826dd3f545f33cd22ef275d4d1"
VERSIONS = ("4.4",)
KEY = f"{CRATE_SHA256} 1"  # raised when what is done to the files changes


def folder(version: str) -> Path:
    return _crate_folder() / "versions" / version / "res"


def is_ready() -> bool:
    return cache.is_done(_crate_folder(), KEY)


def fetch() -> None:
    crates.fetch(CRATE, CRATE_SHA256, "tools/interfaces/Cargo.toml", _crate_folder())
    for version in VERSIONS:
        header = folder(version) / "gdextension_interface.h"
        header.write_text(as_published(header.read_text()))
    cache.mark_done(_crate_folder(), KEY)


def as_published(header: str) -> str:
    """For Rust the crate gives each kind of pointer a type of its own; Godot's are to void."""
    return re.sub(r"\bstruct __Gdext\w+ \*", "void *", header)


def _crate_folder() -> Path:
    return cache.root() / "godot-interfaces"
