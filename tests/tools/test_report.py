"""The one-file report."""

import json
import struct
import zlib
from html.parser import HTMLParser

import report
import report_page

SUMMARY = {
    "machine.processor": "A & B <fast>", "machine.processors": 2,
    "static.ticks": 11000, "static.mean_period_us": 1000.0, "static.tick_period_p90_us": 1060.0,
    "static.tick_period_p99_us": 1020.0, "static.baseline_period_p99_us": 1010.0, "static.tick_compute_p99_us": 13.0,
    "static.contact_time_share": 0.3342, "static.realtime": "Scheduling: ordinary.",
}  # fmt: skip


def tiny_picture() -> bytes:
    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", 1, 1, 8, 0, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(b"\0\0")) + chunk(b"IEND", b"")


class Page(HTMLParser):
    VOID = {"meta", "img"}

    def __init__(self, text: str):
        super().__init__()
        self.open: list[str] = []
        self.sources: list[str] = []
        self.words: list[str] = []
        self.feed(text)
        assert self.open == []

    def handle_starttag(self, tag, attributes):
        if tag not in self.VOID:
            self.open.append(tag)
        self.sources += [value for name, value in attributes if name in ("src", "href")]

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        self.words.append(data)


def page(tmp_path, pictures: tuple[str, ...] = ()) -> Page:
    (tmp_path / "scenario1").mkdir()
    (tmp_path / "scenario1/summary.json").write_text(json.dumps(SUMMARY))
    for name in pictures:
        (tmp_path / "scenario1" / name).write_bytes(tiny_picture())
    return Page(report.page(tmp_path))


def test_an_experiment_of_ones_own_has_its_entry(tmp_path):
    assert "how_far" not in page(tmp_path).words
    for name in ("how_far", "how_far.partial"):
        (tmp_path / name).mkdir()
        figures = {"about.version": "Tactus 9", "far.force_error_mean_N": 0.1234567, "runs": 3, "never_s": None, "way": "default"}
        (tmp_path / name / "summary.json").write_text(json.dumps(figures))
    (tmp_path / "how_far/way.png").write_bytes(tiny_picture())
    found = Page(report.page(tmp_path))
    assert found.words.count("how_far") == 1 and len(found.sources) == 1
    for word in ("Tactus 9", "far.force_error_mean_N", "0.1235", "force error mean, newtons", "3", "–", "default"):
        assert word in found.words
    assert "how_far.partial" not in found.words


def test_of_many_figures_the_first_are_shown(tmp_path):
    words = Page(report.page_of("many", {f"figure_{number}_m": 1.0 for number in range(100)}, tmp_path)).words
    assert "figure_59_m" in words and "figure_60_m" not in words and "40 more figures are in summary.json." in words


def test_what_a_local_model_gives_is_told_where_it_was_measured(tmp_path):
    (tmp_path / "scenario4").mkdir()
    keys = ("force_error_mean_N", "force_error_p95_N", "contact_delay_ms", "phantom_force_share", "round_trip_ms")
    figures = {f"{scene}.{one}.{key}": 0.5 for scene in ("static", "dynamic") for one in ("traditional", "mmt") for key in keys}
    figures |= {"static.mmt.force_error_mean_N": 0.0, "dynamic.mmt.force_error_mean_N": 0.05}
    (tmp_path / "scenario4/summary.json").write_text(json.dumps(figures))
    words = page(tmp_path).words
    assert "no error left" in words
    assert "10.0 × less" in words


def test_periods_of_both_sides_are_told_where_they_were_measured(tmp_path):
    folder = tmp_path / "timing_networked"
    folder.mkdir()
    figures = {f"scenario{number}.{side}.period_p90_us": 1000.0 + number for number in (2, 4) for side in ("operator", "teleoperator")}
    (folder / "summary.json").write_text(json.dumps(figures))
    (folder / "both_sides_periods.png").write_bytes(tiny_picture())
    found = page(tmp_path)
    assert found.words.count("1004.0 µs") == 2 and "scenario2, teleoperator" in found.words
    assert len(found.sources) == 1


def test_what_a_camera_saw_is_shown_where_it_was_measured(tmp_path):
    folder = tmp_path / "scenario5"
    folder.mkdir()
    figures = {f"{scene}.{key}": 0.125 for scene in ("static", "dynamic") for key in report.SEEN}
    (folder / "summary.json").write_text(json.dumps(figures))
    (folder / "static_seen.png").write_bytes(tiny_picture())
    found = page(tmp_path)
    assert "Static" in found.words
    assert found.words.count("0.125 mm") == 4
    assert len(found.sources) == 1


def test_it_needs_nothing_but_itself(tmp_path):
    found = page(tmp_path, ("periods.png", "static_force.png"))
    assert len(found.sources) == 2
    assert all(source.startswith("data:image/png;base64,") for source in found.sources)


def test_missing_pictures_are_left_out(tmp_path):
    assert page(tmp_path).sources == []


def test_each_target_says_whether_it_is_met(tmp_path):
    words = page(tmp_path).words
    assert words.count("met") == 3
    assert words.count("missed") == 1


def test_figures_carry_their_units(tmp_path):
    words = page(tmp_path).words
    assert "1060.0 µs" in words
    assert "33.42%" in words


def test_text_is_escaped():
    assert report_page.paragraph("a < b & c") == "<p>a &lt; b &amp; c</p>"
    assert "A &amp; B" in report_page.table(("",), [("A & B",)])
