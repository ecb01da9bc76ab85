"""What a sweep has already: one file for each run, whole or not there, and checked when it is read."""

import hashlib
import json
import os
from dataclasses import dataclass, field
from pathlib import Path

from sweeps.description import Run

Summary = dict[str, object]


@dataclass
class Found:
    summaries: dict[str, Summary] = field(default_factory=dict)  # by the run's identity
    damaged: list[str] = field(default_factory=list)  # names of files
    outdated: int = 0  # of other sources


def write(folder: Path, run: Run, sources: str, summary: Summary) -> None:
    body = {"run": str(run), "sources": sources, "summary": summary}
    write_whole(folder / f"{run.identity}.json", json.dumps({"check": _check(body), **body}, indent=1) + "\n")


def write_whole(path: Path, text: str) -> None:
    """Whoever is stopped meanwhile leaves what was there before."""
    partial = path.with_suffix(".partial")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        partial.write_text(text)
        os.replace(partial, path)
    except OSError as error:
        partial.unlink(missing_ok=True)
        raise RuntimeError(f"{path} could not be written: {error.strerror}") from None


def read(folder: Path, runs: list[Run], sources: str) -> Found:
    found = Found()
    for partial in folder.glob("*.partial"):
        found.damaged.append(partial.name)
        partial.unlink()
    for run in runs:
        path = folder / f"{run.identity}.json"
        if not path.is_file():
            continue
        body = _read(path)
        if body is None or body["run"] != str(run):
            found.damaged.append(path.name)
        elif body["sources"] != sources:
            found.outdated += 1
        else:
            found.summaries[run.identity] = body["summary"]
    return found


def _read(path: Path) -> dict | None:
    """None where it is not what was written."""
    try:
        body = json.loads(path.read_text())
        check = body.pop("check")
        return body if check == _check(body) else None
    except (OSError, ValueError, KeyError, AttributeError, TypeError):
        return None


def _check(body: dict) -> str:
    return hashlib.sha256(json.dumps(body, sort_keys=True).encode()).hexdigest()
