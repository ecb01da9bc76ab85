"""Bytes that nobody has thought of, thrown at what takes bytes from others: tests/fuzz/TARGET.cpp.

libFuzzer leads the search by the code that an input reaches, with address and undefined-behaviour sanitizers watching.
It is chosen before AFL++ because it plays a million inputs in one process where AFL++ starts or forks one for each, and
comes with the clang that builds them. Where there is no clang, or with --driver=plain, the driver that every compiler
makes plays the same targets with changes made blindly (tests/fuzz/driver/plain.cpp).

Every input that ends a program, or takes it longer than --longest seconds of a processor, is kept in found/TARGET/.
"""

import re
import resource
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from os import cpu_count
from pathlib import Path
from typing import Literal

import build
from measuring import options
from setup import cache, jolt

sys.path.insert(0, str(cache.clone() / "site_scons"))
import toolchain  # noqa: E402

WATCHED_BY = "fuzzer,address,undefined"
LONGEST = 10.0  # that an input may take (unit: seconds of a processor)
# By the clock, which may show any time on a busy machine: what takes longer is played again alone.
LIMIT = 120  # (unit: seconds)
MOST_MEMORY = 2048  # (unit: MB)
MOST_FOUND = 20  # in one worker: then the search has told enough


@dataclass(frozen=True)
class Target:
    runs: int
    max_len: int  # of an input (unit: bytes)


TARGETS = {
    "packets": Target(10_000_000, 4096),
    "meshes": Target(1_000_000, 2048),
    "recordings": Target(100_000, 16384),
    "images": Target(100_000, 4096),
    "scene_properties": Target(100_000, 8192),
}
CASES = list(TARGETS)
WORDS = {
    "packets": "packets, descriptions, greetings, sealed packets on their way, whole conversations",
    "meshes": "triangles, texts of .obj files, fields, point sets; what gives, tools, deforming under a hand",
    "recordings": "recordings of a session's inputs, as files and as pieces with right hashes; of a device",
    "images": "recordings of a depth camera, their headers and images",
    "scene_properties": "all that an owner may ask of a session, of any value and in any order, while it ticks",
}


@dataclass(frozen=True)
class Settings:
    runs: int = options.option(0, "count", 0, 10**12)  # of each target; 0: as TARGETS says
    driver: Literal["best", "plain"] = "best"
    workers: int = options.option(0, "count", 0, 1024)  # processes; 0: one a processor
    seed: int = options.option(1, "count", 0, 2**31 - 1)
    longest: float = options.option(LONGEST, "s", 0.001, 3600)  # that an input may take, of a processor


@dataclass
class Found:
    input: Path
    kind: Literal["crash", "hang"]
    words: str  # what the program said of it


@dataclass
class Search:
    """What one target, or one worker on it, has come to."""

    runs: int = 0
    found: list[Found] = field(default_factory=list)
    reached: int = 0  # places of the code and how often, as libFuzzer counts them ("ft")

    def add(self, other: "Search") -> None:
        self.runs += other.runs
        self.found += other.found
        self.reached = max(self.reached, other.reached)

    def count(self, kind: str) -> int:
        return sum(one.kind == kind for one in self.found)


def run(cases: list[str], settings: Settings, output: Path) -> dict[str, object]:
    compiler = toolchain.fuzzing_compiler() if settings.driver == "best" else ""
    led = bool(compiler)
    build.build("template_debug", "fuzzers")
    if led:
        jolt.ready(compiler=compiler) or jolt.fetch_and_build(compiler=compiler)
        build.build("template_debug", "fuzzers", f"sanitize={WATCHED_BY}")
    figures: dict[str, object] = {}
    for name in cases:
        target = TARGETS[name]
        runs = settings.runs or target.runs
        print(f"{name}: {runs:,} inputs", flush=True)
        began = time.monotonic()
        search = play(name, Target(runs, target.max_len), settings, output, led)
        for one in search.found:
            print(f"  {one.kind}: {one.input}\n    {one.words}", flush=True)
        figures |= {
            f"fuzz.{name}_runs": search.runs,
            f"fuzz.{name}_crashes": search.count("crash"),
            f"fuzz.{name}_hangs": search.count("hang"),
            f"fuzz.{name}_reached": search.reached,
            f"fuzz.{name}_seconds": time.monotonic() - began,
            f"fuzz.{name}_driver": "libFuzzer" if led else "plain",
        }
        print(f"  {search.runs:,} played, {search.count('crash')} crashes, {search.count('hang')} hangs", flush=True)
    return figures


def program(name: str, led: bool) -> Path:
    return cache.clone() / "build" / cache.variant("template_debug", WATCHED_BY if led else "") / "fuzz" / name


def play(name: str, target: Target, settings: Settings, output: Path, led: bool) -> Search:
    """All runs of a target, by as many processes as there is room for."""
    corpus, found = output / "corpus" / name, cache.emptied(output / "found" / name)
    corpus.mkdir(parents=True, exist_ok=True)
    subprocess.run([program(name, False), f"-seeds={corpus}"], check=True)
    kept = cache.clone() / "tests/fuzz/found" / name
    workers = settings.workers or cpu_count() or 1
    workers = min(workers, target.runs)
    share = [target.runs // workers + (number < target.runs % workers) for number in range(workers)]
    command = [program(name, led), f"-max_len={target.max_len}", f"-timeout={LIMIT if led else round(settings.longest)}"]
    if led:
        command += [f"-rss_limit_mb={MOST_MEMORY}", "-print_final_stats=1", "-verbosity=1"]
    folders = [corpus, *([kept] if kept.is_dir() else [])]

    def work(number: int) -> Search:
        own = found / str(number)
        own.mkdir()
        return _search(command, folders, share[number], settings.seed * workers + number, own, settings.longest)

    with ThreadPoolExecutor(workers) as pool:
        searches = list(pool.map(work, range(workers)))
    total = Search()
    for one in searches:
        total.add(one)
    return total


def _search(command: list, folders: list[Path], runs: int, seed: int, found: Path, longest: float) -> Search:
    """One process after the other: each ends with the first input that ends it."""
    search = Search()
    while search.runs < runs and len(search.found) < MOST_FOUND:
        before = set(found.iterdir())
        words = [f"-runs={runs - search.runs}", f"-seed={seed + 1000 * len(search.found)}", f"-artifact_prefix={found}/"]
        done = subprocess.run([*command, *words, *folders], text=True, errors="replace", capture_output=True)
        said = done.stdout + done.stderr
        (found / "log").write_text(said[-100_000:])
        new = [path for path in sorted(set(found.iterdir()) - before) if re.match("(crash|timeout|oom|leak)-", path.name)]
        played = re.findall(r"stat::number_of_executed_units:\s*(\d+)", said)
        search.runs += int(played[-1]) if played else _number(new)
        search.reached = max([search.reached, *map(int, re.findall(r"\bft: (\d+)", said))])
        search.found += [one for path in new if (one := judge(command[0], path, longest))]
        if done.returncode != 0 and not new:
            raise RuntimeError(f"{command[0].name} ended with {done.returncode} and no input to show for it:\n{said[-3000:]}")
    (found / "log").unlink(missing_ok=True)
    return search


def _number(found: list[Path]) -> int:
    """Of the run that the plain driver has kept."""
    return max((int(path.name.rpartition("-")[2]) for path in found), default=0)


def judge(program: Path, kept: Path, longest: float) -> Found | None:
    """What the input does when it is played alone, by its own processor time; nothing where it only was the machine that took long."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    try:
        done = subprocess.run([program, f"-timeout={round(2 * longest)}", f"-artifact_prefix={kept.parent}/again-", kept], text=True, errors="replace", capture_output=True, timeout=600)
        said, code = done.stdout + done.stderr, done.returncode
    except subprocess.TimeoutExpired:
        said, code = "it has not come to its end", 1
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    used = after.ru_utime - before.ru_utime
    if kept.name.startswith("timeout-"):
        return Found(kept, "hang", f"{used:.0f} s") if used > longest or code != 0 else None
    lines = [line for line in said.splitlines() if re.search(r"ERROR: |runtime error|does not hold|SUMMARY|Assertion", line)]
    return Found(kept, "crash", " | ".join(lines[:3]) or f"it ended with {code}")


