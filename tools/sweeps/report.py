"""The page of a sweep: what was asked, its figures, its means, and how to run it again."""

from collections.abc import Mapping
from pathlib import Path

import report_page as html
from measuring import host
from plots.sweep import levels, word
from sweeps import effects, statistics
from sweeps.description import Sweep
from sweeps.table import Rows

# A table that is read; all rows are in the CSV.
MOST_ROWS = 200


def page(sweep: Sweep, table: Rows, asked: int, sources: str, pictures: Mapping[str, list[Path]], told: list[str]) -> str:
    """`pictures`: the files of each measure, the PNG first. `told`: what went wrong."""
    repeats = f", {len(sweep.seeds)} seeds each" if len(sweep.seeds) > 1 else ""
    factors = " × ".join(f"{len(values)} levels of {name}" for name, values in sweep.factors.items())
    return html.page(
        sweep.title,
        f"{len(table)} of {asked} runs of the experiment {sweep.experiment}: {factors or 'nothing varied'}{repeats}.",
        [
            *([html.section("What is missing", *(html.paragraph(line) for line in told))] if told else []),
            *(_measure(sweep, table, measure, paths) for measure, paths in pictures.items()),
            *_effects(effects.rows(sweep, table)),
            _how(sweep, sources),
        ],
    )


def _measure(sweep: Sweep, table: Rows, measure: str, paths: list[Path]) -> str:
    averaged = [name for name in sweep.factors if name not in sweep.drawn and len(sweep.factors[name]) > 1]
    caption = (
        f"{measure}: means with their {statistics.CONFIDENCE:.0%} confidence intervals (Student's t, over the independent runs of a point), "
        f"and every run as a dot.{' Averaged over ' + ', '.join(averaged) + '.' if averaged else ''}"
    )
    return html.section(measure, html.picture(paths[0], caption), html.files(paths), _means(sweep, table, measure))


def _means(sweep: Sweep, table: Rows, measure: str) -> str:
    columns = [sweep.column(name) for name in sweep.drawn]
    found: dict[tuple, Rows] = {}
    for row in table:
        if measure in row:
            found.setdefault(tuple(row[name] for name in columns), []).append(row)
    rows = []
    for key, of_key in found.items():
        alone = statistics.independent(of_key, ["run", *map(sweep.column, sweep.varied)])
        rows.append((*map(word, key), str(len(of_key)), str(len(alone)), *_in_words([float(row[measure]) for row in alone])))
    head = (*columns, "runs", "independent", "mean", "± 95 %", "least", "most")
    more = [html.paragraph(f"{MOST_ROWS} of {len(rows)} rows; all runs are in sweep.csv.")] if len(rows) > MOST_ROWS else []
    return "\n".join([html.table(head, rows[:MOST_ROWS], numbers_from=len(columns)), *more])


def _effects(found: list[tuple]) -> list[str]:
    if not found:
        return []
    rows = [
        (f"{factor}: {word(level)} against {word(first)}", measure, str(pairs), *(_between(*three) for three in (figures[:3], figures[3:])))
        for factor, level, first, measure, pairs, *figures in found[:MOST_ROWS]
    ]
    words = (
        "Pairs of runs that differ in that factor alone, with the same seed. The difference has its 95 % interval by Student's t; Hedges' g is the "
        "difference over the pooled standard deviation, with its 95 % interval by the noncentral t distribution. All are in effects.csv."
    )
    return [html.section("What a factor changes", html.paragraph(words), html.table(("", "measure", "pairs", "difference", "Hedges' g"), rows, numbers_from=2))]


def _between(value: float, low: float, high: float) -> str:
    return f"{value:.3g} ({low:.3g} … {high:.3g})" if low == low else f"{value:.3g}" if value == value else "–"


def _in_words(values: list[float]) -> tuple[str, ...]:
    mean, half = statistics.mean_and_interval(values)
    return f"{mean:.4g}", "–" if len(values) < 2 else f"{half:.2g}", f"{min(values):.4g}", f"{max(values):.4g}"


def _how(sweep: Sweep, sources: str) -> str:
    rows = [("Experiment", sweep.experiment)]
    rows += [(f"--{name}", value) for name, value in sweep.options.items()]
    rows += [(f"--{name}", ", ".join(values)) for name, values in sweep.factors.items()]
    rows += [("--seed", ", ".join(sweep.seeds))] if sweep.seeds else []
    rows += [("Sources", sources)]
    rows += [(f"machine.{name}", str(value)) for name, value in host.description().items()]
    return html.section(
        "How it was run",
        html.paragraph("One run alone: ./run experiment with these options, one value of each. What it depends on besides is the word of the sources."),
        html.table(("", ""), rows, numbers_from=9),
        html.files([Path("sweep.csv"), Path("sweep.json")]),
    )
