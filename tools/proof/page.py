"""docs/proof.md: one page of what has been tried to break it, from the figures of build/proof/."""

import shutil
from pathlib import Path

from proof import faults, fuzz
from setup import cache
from sweeps.results import write_whole

PAGE = cache.clone() / "docs/proof.md"
PICTURES = {"soak/memory.png": "proof_memory.png", "loop/lateness.png": "proof_lateness.png"}
NOT_RUN = "not run"


def write(figures: dict, output: Path, page: Path = PAGE) -> None:
    for made, name in PICTURES.items():
        if (output / made).is_file():
            shutil.copy(output / made, page.parent / name)
    write_whole(page, text(figures))
    print(f"{page}")


def text(figures: dict) -> str:
    sections = [_summary, _fuzz, _soak, _loop, _faults]
    threats = (Path(__file__).parent / "threats.md").read_text()
    return "\n".join([*(section(figures) for section in sections), threats])


def _picture(name: str, words: str) -> str:
    return f"![{words}]({name})\n" if (PAGE.parent / name).is_file() else ""


def _said(figures: dict, key: str, form: str = "{:,}") -> str:
    return form.format(figures[key]) if key in figures else NOT_RUN


def _table(head: list[str], rows: list[list[str]]) -> str:
    lines = [head, ["---"] * len(head), *rows]
    return "".join(f"| {' | '.join(row)} |\n" for row in lines)


def _summary(figures: dict) -> str:
    crashes = [f"fuzz.{name}_crashes" for name in fuzz.CASES]
    found = sum(figures[key] for key in crashes) if all(key in figures for key in crashes) else None
    rows = [
        ["inputs of others that end the program or hang it", "0", NOT_RUN if found is None else str(found)],
        ["memory, after hours of coming and going", "≤ 5 MB more", _said(figures, "soak.growth_mb", "{:+.2f} MB")],
        ["start of a tick, p99.9, over cyclictest's", "≤ 1.2", _said(figures, "loop.p999_over_cyclictest", "{:.2f}")],
        ["faults survived", "all", f"{figures.get('faults_survived', 0)} of {figures.get('faults', 0)}"],
    ]
    head = ["What", "wanted", "found"]
    return f"""# What has been done to break it

`./run proof` runs what `./run test` has no time for, and writes this page. It tries random bytes, hours of everything coming and going, deadlines
beside cyclictest, and faults around a scene while a hand touches it. Every part also runs by itself (`./run proof --only=fuzz`,
`./run proof --only=faults`, …), and `./run test` plays a short form of each.

{_table(head, rows)}"""


def _fuzz(figures: dict) -> str:
    rows = []
    for name, target in fuzz.TARGETS.items():
        key = f"fuzz.{name}"
        rows.append(
            [
                f"`{name}`", fuzz.WORDS[name], f"{target.runs:,}", _said(figures, f"{key}_runs"), figures.get(f"{key}_driver", NOT_RUN), _said(figures, f"{key}_crashes"),
                _said(figures, f"{key}_hangs"), _said(figures, f"{key}_reached"), _said(figures, f"{key}_seconds", "{:.0f} s"),
            ]  # fmt: skip
        )
    head = ["Target", "What is thrown", "wanted", "runs", "by", "crashes", "hangs", "reached", "took"]
    return f"""## Bytes of others

    ./run proof --only=fuzz.packets

A target is a function of bytes (`tests/fuzz/`). The tool libFuzzer changes them and keeps those that reach other code (*reached* counts places and
how often). The address and undefined-behavior sanitizers check each run, and so do assertions of the target itself. Examples are that an accepted
packet is the same when it is sent again, that a hull is closed, and that a scene shows finite numbers. The clang that builds the targets brings
libFuzzer, which plays them in one process, where AFL++ begins or forks one for each input. A crash is an input that ends the program; a hang one that
takes more than {fuzz.LONGEST:.0f} s of a processor. Both are kept, and what has been found once is played by every later run (`tests/fuzz/found/`). Where there is no
clang, another driver plays the same targets blindly; that is what `./run test` does.

{_table(head, rows)}"""


def _soak(figures: dict) -> str:
    changes = {key.rpartition("_")[2]: value for key, value in figures.items() if key.startswith("soak.changes_of_")}
    said = ", ".join(f"{count:,} {SOAK_WORDS.get(name, name)}" for name, count in sorted(changes.items(), key=lambda one: -one[1]))
    return f"""## Hours of coming and going

    ./run proof --only=soak

Two worlds in one program, each a side of the other's link, in virtual time: {_said(figures, "soak.hours", "{:.2f}")} hours, {_said(figures, "soak.ticks")} ticks,
of whose frames (60 a second) a pointer pressed on something in {_said(figures, "soak.pointer_pressed_frames")} and a tool in {_said(figures, "soak.tool_pressed_frames")}.
Twice a second something comes, goes or is exchanged: {said or NOT_RUN}. Growth is the median of the last quarter above that of the second:
**{_said(figures, "soak.growth_mb", "{:+.2f} MB")}** of {_said(figures, "soak.memory_mb", "{:.0f} MB")}, {_said(figures, "soak.objects_growth", "{:+.0f}")} objects,
{_said(figures, "soak.files_growth", "{:+.0f}")} open files, {_said(figures, "soak.threads_growth", "{:+.0f}")} threads.

{_picture("proof_memory.png", "Memory over virtual time")}"""


SOAK_WORDS = {
    "body": "bodies come", "gone": "bodies go", "joint": "joints come", "gives": "bodies that give come", "tool": "tools come", "hand": "times a device and its pointer are others",
    "record": "recordings begin", "link": "links are others",
}  # fmt: skip


def _loop(figures: dict) -> str:
    rows = []
    for case in ("idle", "loaded"):
        for loop, name in (("loop", "haptic loop"), ("cyclictest", "cyclictest")):
            key = f"loop.{case}.{loop}"
            ratio = _said(figures, f"loop.{case}.p999_over_cyclictest", "{:.2f}") if loop == "loop" else ""
            rows.append([case, name, *(_said(figures, f"{key}_{what}") for what in ("ticks", "p50_us", "p99_us", "p999_us", "p9999_us", "most_us")), ratio])
    head = ["Processors", "", "ticks", "p50 (µs)", "p99", "p99.9", "p99.99", "longest", "p99.9 over cyclictest"]
    machine = {key.removeprefix("loop.machine."): value for key, value in figures.items() if key.startswith("loop.machine.")}
    where = "{processors} processors ({processor}), {system}, kernel {kernel}{v}".format(
        **machine, v=", a virtual machine" if machine["virtual"] else ""
    ) if machine else NOT_RUN  # fmt: skip
    return f"""## Deadlines

    ./run proof --only=loop

The table shows how late ticks begin while a hand pushes boxes about. In turns of ten seconds, cyclictest runs at the same period, priority and
processor. *Loaded* is with an ordinary process that never rests on each processor. On {where}.

{_table(head, rows)}
A virtual machine's host takes a processor away now and then, and a few such pauses in the turns of one of the two decide the ratio. Repeated runs on
the machine of 23 November 2026 had 0.93 and 0.20 idle, and 2.16, 0.17 and 0.05 loaded. Below 1 is no merit of the loop's, and 1.2 is not shown there.
{_picture("proof_lateness.png", "How late ticks begin")}"""


def _faults(figures: dict) -> str:
    rows = []
    for name, fault in faults.FAULTS.items():
        key = f"faults.{name}"
        if f"{key}.survived" in figures:
            rows.append([fault.what, "yes" if figures[f"{key}.survived"] else "**no**", figures[f"{key}.seen"]])
        else:
            rows.append([fault.what, "left out", figures.get(f"{key}.left_out", NOT_RUN)])
    return f"""## Faults

    ./run proof --only=faults

Each is done to a real run while a hand touches. Survived: it goes on, or ends in order, says what is wrong, and the hand is never kicked.

{_table(["What is done", "survived", "seen"], rows)}"""

