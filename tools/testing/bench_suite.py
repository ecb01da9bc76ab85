"""The benches for another platform, each played shortly to its end in an emulator: bench.NAME. What they measure there
says nothing; that they are built, end well and report figures does.
"""

import json
import subprocess
import tempfile
from pathlib import Path

from setup import cache
from setup.platforms import Platform
from testing import cpp_suite
from testing.results import Result, matching

TIME_LIMIT = 600  # (unit: seconds) a bench
SHORTLY = {
    "device": ["--places=10000", "--inputs=20000", "--rounds=0"],
    "kick": ["--seeds=1", "--deformations=200"],
    "network": ["--seconds=0.5"],
    "physics": ["--quick", "--only=checks"],
    "proxy": ["--only=still", "--most=2000", "--rounds=1", "--ticks=100", "--checks=10"],
}


def run(wanted: str, _: str, platform: Platform) -> list[Result]:
    folder = cache.clone() / "build" / cache.variant("template_debug", foreign=platform.name) / "bench"
    chosen = matching([f"bench.{name}" for name in SHORTLY], wanted)
    return [Result(name, _play(folder, name.removeprefix("bench."), platform)) for name in chosen]


def _play(folder: Path, name: str, platform: Platform) -> str:
    """Why it did not end as it should; empty where it did."""
    program = folder / (name + (".exe" if platform.system == "windows" else ""))
    with tempfile.TemporaryDirectory() as place:
        report = Path(place) / "report.json"
        environment = cpp_suite.environment(platform) | {"TACTUS_BENCH_JSON": cpp_suite.seen_by_program(report, platform)}
        try:
            done = subprocess.run(
                [*platform.emulator, program, *SHORTLY[name]], cwd=cache.clone(), env=environment, timeout=TIME_LIMIT,
                text=True, errors="replace", capture_output=True,
            )  # fmt: skip
        except subprocess.TimeoutExpired:
            return f"not done after {TIME_LIMIT} s"
        if done.returncode != 0:
            return f"ended with {done.returncode}:\n{done.stdout[-1000:]}{done.stderr[:3000]}"
        if not report.is_file() or not json.loads(report.read_text()):
            return f"it reported nothing:\n{done.stdout[-1000:]}"
    return ""
