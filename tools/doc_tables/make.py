"""./run docs --figures: makes every table anew that a command makes in virtual time, and the pages that have them."""

import importlib
import tempfile
from datetime import date
from pathlib import Path

from doc_tables import pages
from doc_tables.tables import TABLES, Rows, Summary, Table
from measuring import host
from measuring import made_by as made
from sweeps.results import write_whole


def all_tables() -> list[str]:
    """Names of those that are others than they were."""
    summaries: dict[str, Summary] = {}
    changed = []
    by = made_by()
    for name, table in TABLES.items():
        if table.command not in summaries:
            print(table.command, flush=True)
            summaries[table.command] = play(table)
        path = pages.document(table)
        text = path.read_text()
        new = pages.put(text, name, table.rows(summaries[table.command]), by)
        if new != text:
            write_whole(path, new)
            changed.append(name)
            print(f"  {name} is another one", flush=True)
    return changed


def play(table: Table) -> Summary:
    with tempfile.TemporaryDirectory(prefix="tactus-") as folder:
        return importlib.import_module(f"experiments.{table.experiment}").run(dict(table.options), Path(folder))


def rows_of(name: str) -> Rows:
    """As they stand in the page."""
    table = TABLES[name]
    for block in pages.blocks(pages.document(table).read_text()):
        if block.name == name:
            return [[cell.strip() for cell in line.strip().strip("|").split("|")] for line in block.table.splitlines()[2:]]
    raise RuntimeError(f"{table.document} has no table {name}")


def made_by() -> str:
    """Version, commit, date and machine."""
    machine = host.description()
    today = date.today()
    return f"Tactus {made.version()} ({made.commit()}), {today.day} {today:%B %Y}, {machine['processor']}, {machine['system']}"
