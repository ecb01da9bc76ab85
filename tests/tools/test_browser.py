"""What is written as pages, in a real browser: nothing in its console, and no wider than the window, be it wide or a phone's."""

import json
from pathlib import Path

import docs
import pytest
import report
from test_report import SUMMARY, tiny_picture
from test_sweeps import SMALL, described

from sweeps import command
from sweeps.command import Settings
from testing import browser

WIDTHS = (1300, 400)

pytestmark = pytest.mark.skipif(browser.program() is None, reason="there is no Chromium: apt-get install chromium")


@pytest.fixture(scope="module")
def chromium():
    with browser.opened() as running:
        yield running


def troubles(chromium: browser.Browser, page: Path) -> list[str]:
    found = []
    for width in WIDTHS:
        seen = chromium.look(page, width)
        found += [f"{page.name} at {width}: {line}" for line in seen.said]
        found += [f"{page.name} at {width} is {seen.width} wide"] if seen.width > width else []
        found += [f"{page.name} at {width} is empty"] if len(seen.text) < 20 else []
    return found


def test_every_page_of_the_documents(chromium, tmp_path):
    docs.write(tmp_path / "source")
    assert docs.make(tmp_path / "source", tmp_path / "out") == ""
    pages = sorted((tmp_path / "out").rglob("*.html"))
    assert len(pages) > 40
    assert [line for page in pages for line in troubles(chromium, page)] == []


def test_the_report_of_the_experiments(chromium, tmp_path):
    for name in ("scenario1", "how_far"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "summary.json").write_text(json.dumps(SUMMARY))
        (tmp_path / name / "static_force.png").write_bytes(tiny_picture())
    page = tmp_path / "report.html"
    page.write_text(report.page(tmp_path))
    assert troubles(chromium, page) == []


def test_the_report_of_a_sweep(chromium, tmp_path):
    sweep = described(SMALL | {"seeds": [1], "factors": {"delay": [0, 50], "loss": [0, 0.2]}}, tmp_path)
    assert command.play(sweep, tmp_path / "out", Settings(workers=1)) == 0
    assert troubles(chromium, tmp_path / "out/report.html") == []


def test_what_is_wrong_is_found(chromium, tmp_path):
    page = tmp_path / "wrong.html"
    page.write_text('<body style="width: 900px">Some words that are long enough.<script>console.error("no", 5); nowhere()</script>')
    found = " ".join(troubles(chromium, page))
    assert "error: no 5" in found and "nowhere is not defined" in found and "at 400 is 9" in found and "at 1300 is 1" not in found
    (tmp_path / "missing.html").write_text('Some words that are long enough. <img src="none.png">')
    assert "ERR_FILE_NOT_FOUND" in " ".join(troubles(chromium, tmp_path / "missing.html"))
