"""The small part of the Point Cloud Library that the bench of sensing is held beside. Its headers belong to packages that
bring hundreds of others along: they are unpacked into the cache, not installed."""

import shutil
import subprocess
from pathlib import Path

from . import cache

PARTS = ["common", "kdtree", "octree", "search", "sample_consensus", "filters", "features", "segmentation", "registration"]
HEADERS = ["libpcl-dev", "libflann-dev"]


def ready() -> tuple[list[Path], list[Path]]:
    """Folders of headers, and libraries; none where not all of it is there."""
    libraries, headers = _libraries(), []
    version = libraries[0].name.partition(".so.")[2] if libraries else ""
    for base in (Path("/usr/include"), _folder() / "usr/include"):
        if (base / f"pcl-{version}/pcl/registration/icp.h").is_file() and (base / "flann/flann.hpp").is_file():
            headers = [base / f"pcl-{version}", *([base] if base != Path("/usr/include") else []), Path("/usr/include/eigen3")]
            break
    return (headers, libraries) if headers and libraries else ([], [])


def is_ready() -> bool:
    return bool(ready()[0])


def can_fetch() -> bool:
    """The libraries are installed, and the system's packages can be asked for the headers."""
    return bool(_libraries()) and shutil.which("apt-get") is not None


def fetch_headers() -> None:
    folder = cache.emptied(_folder())
    _run("apt-get", "download", *HEADERS, folder=folder)
    for package in folder.glob("*.deb"):
        _run("dpkg", "-x", package.name, ".", folder=folder)
        package.unlink()
    if not is_ready():
        raise RuntimeError(f"the headers in {', '.join(HEADERS)} are not those of the installed libpcl-*")


def _folder() -> Path:
    return cache.root() / "pcl"


def _libraries() -> list[Path]:
    """By path: there is no link without a version where no -dev package is."""
    found = [sorted(Path("/usr/lib").glob(f"*/libpcl_{part}.so.*.*"), key=lambda path: (len(path.name), path)) for part in PARTS]
    return [versions[0] for versions in found] if all(found) else []


def _run(*command: str, folder: Path) -> None:
    done = subprocess.run(command, cwd=folder, text=True, capture_output=True)
    if done.returncode != 0:
        raise RuntimeError(f"{' '.join(command)} failed:\n{done.stderr[-2000:]}")
