"""Where a table stands in a page: after a line <!-- table NAME: `COMMAND` -->, and above one that says what it was made by."""

import re
from dataclasses import dataclass
from pathlib import Path

from doc_tables.tables import TABLES, Rows, Table
from setup import cache

_BLOCK = re.compile(r"<!-- table (?P<name>\w+): `(?P<command>[^`\n]*)` -->\n(?P<table>(?:\|[^\n]*\n)*)(?:\n?\*Made by (?P<by>[^\n]*)\*\n)?")


@dataclass(frozen=True)
class Block:
    name: str
    command: str
    table: str  # its lines
    by: str
    start: int
    end: int


def blocks(text: str) -> list[Block]:
    return [Block(one["name"], one["command"], one["table"], one["by"] or "", one.start(), one.end()) for one in _BLOCK.finditer(text)]


def document(table: Table) -> Path:
    return cache.clone() / "docs" / table.document


def lines(table: Table, rows: Rows) -> str:
    every = [table.head, ["---"] * len(table.head), *rows]
    return "".join(f"| {' | '.join(cells)} |\n".replace("|  |", "| |").replace("| --- ", "|---").replace("---| ", "---|") for cells in every)


def put(text: str, name: str, rows: Rows, by: str) -> str:
    """The page with these rows; who made them is told anew only where they are others."""
    table = TABLES[name]
    for block in blocks(text):
        if block.name == name:
            made = lines(table, rows)
            says = block.by if made == block.table and block.by else by
            return f"{text[: block.start]}<!-- table {name}: `{table.command}` -->\n{made}\n*Made by {says}*\n{text[block.end :]}"
    raise RuntimeError(f"{table.document} has no line <!-- table {name}: … -->")
