"""One row a run: its number, its factors, its seed, and every figure of its summary."""

import csv
import io
from collections.abc import Iterable, Sequence

from sweeps.description import Run, Sweep
from sweeps.results import Summary

Rows = list[dict[str, object]]


def rows(sweep: Sweep, runs: list[Run], summaries: dict[str, Summary]) -> Rows:
    """Of those runs that there are, in the order of the sweep."""
    found: Rows = []
    for number, run in enumerate(runs, 1):
        if run.identity in summaries:
            factors = {sweep.column(name): value for name, value in sweep.values(run).items()}
            found.append({"run": number, **factors, **summaries[run.identity]})
    return found


def text(table: Rows) -> str:
    columns = list(dict.fromkeys(name for row in table for name in row))
    return lines(columns, ([row.get(name, "") for name in columns] for row in table))


def lines(head: Sequence[str], found: Iterable[Sequence[object]]) -> str:
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(head)
    writer.writerows(map(_cell, row) for row in found)
    return out.getvalue()


def _cell(value: object) -> object:
    return int(value) if isinstance(value, bool) else "" if value != value else value
