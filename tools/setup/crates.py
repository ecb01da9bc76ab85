"""Sources that lie in a crate of Rust's registry, brought by cargo and checked by their SHA-256."""

import json
import os
import re
import shutil
import subprocess
from pathlib import Path

from . import cache, fetching


def fetch(crate: str, sha256: str, description: str, target: Path) -> None:
    """The crate's folder becomes `target`. `description`: a Cargo.toml of this clone that names the exact version."""
    work = cache.emptied(cache.root() / "downloads" / crate)
    shutil.copy(cache.clone() / description, work / "Cargo.toml")
    (work / "lib.rs").touch()
    _vendor(work)
    folder = work / "vendor" / crate
    found = json.loads((folder / ".cargo-checksum.json").read_text())["package"]
    if found != sha256:
        raise RuntimeError(f"{crate} has the checksum {found} instead of {sha256}")
    shutil.rmtree(target, ignore_errors=True)
    folder.rename(target)
    shutil.rmtree(work)
    cache.mark_done(target, sha256)


def _vendor(work: Path) -> None:
    cargo, environment = ["cargo"], dict(os.environ)
    text = subprocess.run(["cargo", "--version"], check=True, text=True, capture_output=True).stdout
    found = re.search(r"cargo (\d+)\.(\d+)", text)
    if found and (int(found[1]), int(found[2])) < (1, 70):
        # Before 1.70 cargo clones the whole index unless it is asked not to, and only lets a nightly ask.
        cargo += ["-Z", "sparse-registry"]
        environment["RUSTC_BOOTSTRAP"] = "1"
    done = subprocess.run([*cargo, "vendor", "vendor"], cwd=work, env=environment, text=True, capture_output=True)
    if done.returncode != 0:
        raise fetching.trouble("cargo vendor", done.stderr)
