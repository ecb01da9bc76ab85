"""How long a newcomer and a developer wait: a fresh clone of what is committed here, with a cache of its own.

Writes build.json: seconds of each command below, and of processor time for the first. It takes about an hour where nothing else
runs. What the system's own packages take is not in it: they are there.
"""

import json
import os
import resource
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

CLONE = Path(__file__).resolve().parents[2]
SOURCE = "extension/core/haptics/force_law.cpp"  # one of core/, and the tests that are its own
ITS_TESTS = "cpp.core.ForceLaw"
HEADER = "extension/core/math/lanes.hpp"  # 53 of the 103 sources of core/ include it
WIDEST_HEADER = "extension/core/math/types.hpp"  # nearly every source of every layer includes it


def main() -> None:
    folder = Path(tempfile.mkdtemp(prefix="tactus_build_"))
    figures: dict[str, float] = {}
    try:
        clone = folder / "clone"
        subprocess.run(["git", "clone", "--quiet", CLONE, clone], check=True)
        measure(clone, own_homes(folder), figures)
    finally:
        write(figures)
        shutil.rmtree(folder, ignore_errors=True)


def own_homes(folder: Path) -> dict[str, str]:
    """Where the cache and the export templates go."""
    homes = {f"XDG_{kind}_HOME": str(folder / kind.lower()) for kind in ("CACHE", "DATA", "CONFIG")}
    for home in homes.values():
        Path(home).mkdir()
    return os.environ | homes


def measure(clone: Path, environment: dict[str, str], figures: dict[str, float]) -> None:
    def timed(*words: str) -> tuple[float, float]:
        print(f"   ./run {' '.join(words)} …", flush=True)
        before, started = processor_seconds(), time.monotonic()
        done = subprocess.run([clone / "run", *words], env=environment, text=True, capture_output=True)
        seconds, processor = time.monotonic() - started, processor_seconds() - before
        print(f"      {seconds:.0f} s, {processor:.0f} s of processor time", flush=True)
        if done.returncode != 0:
            raise SystemExit(f"./run {' '.join(words)} ended with {done.returncode}:\n{done.stdout[-2000:]}{done.stderr[-2000:]}")
        return seconds, processor

    figures["cold_demo_s"], figures["cold_demo_cpu_s"] = timed("demo")
    figures["cold_addon_after_demo_s"], _ = timed("addon")
    empty_again(clone, environment)
    figures["cold_test_s"], figures["cold_test_cpu_s"] = timed("test")
    figures["warm_test_s"], figures["warm_test_cpu_s"] = timed("test")
    change(clone / SOURCE)
    figures["edit_source_s"], _ = timed("test", ITS_TESTS)
    figures["edit_header_s"] = extension_after_change(clone, environment, HEADER)
    figures["edit_widest_header_s"] = extension_after_change(clone, environment, WIDEST_HEADER)


def extension_after_change(clone: Path, environment: dict[str, str], header: str) -> float:
    change(clone / header)
    started = time.monotonic()
    scons = Path(environment["XDG_CACHE_HOME"]) / "tactus/venv/bin/scons"
    subprocess.run([scons, "-s", f"-j{os.cpu_count()}", "extension"], cwd=clone, env=environment, check=True)
    return time.monotonic() - started


def empty_again(clone: Path, environment: dict[str, str]) -> None:
    subprocess.run(["git", "clean", "-fdxq"], cwd=clone, check=True)
    for kind in ("CACHE", "DATA", "CONFIG"):
        shutil.rmtree(environment[f"XDG_{kind}_HOME"])
        Path(environment[f"XDG_{kind}_HOME"]).mkdir()


def change(path: Path) -> None:
    """One line more, which the compiler has to read and the linker to see."""
    with path.open("a") as file:
        file.write(f"namespace tactus {{ [[maybe_unused]] inline int changed_at_{time.time_ns()}() {{ return 1; }} }}\n")


def processor_seconds() -> float:
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def write(figures: dict[str, float]) -> None:
    result = Path(os.environ.get("TACTUS_BENCH_JSON", "build.json"))
    result.write_text(json.dumps({key: round(value, 1) for key, value in figures.items()}, indent=2) + "\n")
    print("\n".join(f"   {key:28} {value:8.1f}" for key, value in figures.items()))


if __name__ == "__main__":
    sys.exit(main())
