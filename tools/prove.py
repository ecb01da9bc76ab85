"""./run proof: what ./run test has no time for, and docs/proof.md of it.

    ./run proof                                     all of it: hours
    ./run proof --only=PART[.CASE] [--key=value …]  one part of it, or one case of that, perhaps shorter
    ./run proof --page                              docs/proof.md of what has been run

Each part leaves its figures in build/proof/PART.json, with other cases of earlier runs as they were, and all of them
together are build/proof/summary.json. --output=FOLDER leaves them elsewhere, and the page as it is.
"""

import json
import sys
from pathlib import Path

import entry
from measuring import options
from proof import faults, fuzz, loop, page, soak
from setup import cache
from sweeps.results import write_whole

PARTS = {"fuzz": fuzz, "faults": faults, "soak": soak, "loop": loop}

OUTPUT = cache.clone() / "build/proof"


def main(arguments: list[str]) -> int:
    given = options.of_words(word for word in arguments if word != "--page")
    output = Path(given.pop("output", OUTPUT))
    part, _, case = given.pop("only", "").partition(".")
    if not part and given:
        raise options.Refused("say with --only=PART whose options these are")
    if "--page" not in arguments:
        for name in [part] if part else PARTS:
            play(name, case, given, output)
    figures = summarise(output)
    if not part and output == OUTPUT:
        page.write(figures, output)
    return 0


def play(part: str, case: str, given: dict[str, str], output: Path) -> None:
    """One part, or one case of it; its figures join those of its other cases."""
    if part not in PARTS:
        raise options.Refused(f"--only={part}: choose from {', '.join(PARTS)}")
    module = PARTS[part]
    if case and case not in module.CASES:
        raise options.Refused(f"--only={part}.{case}: choose from {', '.join(module.CASES)}")
    settings = options.parse(module.Settings, given)
    folder = output / part
    folder.mkdir(parents=True, exist_ok=True)
    figures = module.run([case] if case else module.CASES, settings, folder)
    kept = output / f"{part}.json"
    before = json.loads(kept.read_text()) if kept.is_file() else {}
    write_whole(kept, json.dumps(before | figures, indent=2, sort_keys=True) + "\n")


def summarise(output: Path) -> dict[str, object]:
    """The figures of all parts, and what is counted over the cases of one."""
    summary: dict[str, object] = {}
    for name, module in PARTS.items():
        kept = output / f"{name}.json"
        if kept.is_file():
            figures = json.loads(kept.read_text())
            summary |= figures | (module.totals(figures) if hasattr(module, "totals") else {})
    write_whole(output / "summary.json", json.dumps(summary, indent=2, sort_keys=True) + "\n")
    return summary


if __name__ == "__main__":
    entry.leave(main)
