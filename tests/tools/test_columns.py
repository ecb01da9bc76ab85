"""The data dictionary beside an experiment's tables."""

import json
import re
import xml.etree.ElementTree as ElementTree

from measuring import columns
from setup import cache


def test_every_column_of_rows_has_a_meaning():
    texts = [(cache.clone() / path).read_text() for path in ("extension/session/record_csv.cpp", "tests/shared/teleop_figures.cpp")]
    for text in texts:
        header = re.search(r'"time_us,.*?\\n"', text, re.DOTALL)[0]
        names = "".join(re.findall(r'"([^"]*)"', header)).replace("\\n", "").split(",")
        assert len(names) > 15
        for name in names:
            assert columns.meaning(name), name


def test_so_has_every_number_of_a_loop():
    """As rounds.csv of scenario1 and timing_networked has them, beside the rows of the recorder."""
    reference = ElementTree.parse(cache.clone() / "extension/doc_classes/HapticWorld.xml")
    names = [one.attrib["key"] for one in reference.iter("statistic")]
    assert len(names) > 30
    for name in [*names, "recorded_rows", "lost_rows", "steal_share", "share", "seed"]:
        assert columns.meaning(name), name


def test_units_are_those_at_the_end_of_the_name():
    assert columns.meaning("force_error_mean_N").endswith("newtons")
    assert columns.meaning("felt_excess_100ms_jnd_max").endswith("just-noticeable differences")
    assert columns.meaning("restless_mm_s").endswith("millimeters per second")
    assert columns.meaning("colour") == ""


def test_a_table_gets_a_dictionary(tmp_path):
    columns.write(tmp_path)
    assert not list(tmp_path.iterdir())
    (tmp_path / "rows.csv").write_text("time_us,force_x\n0,1\n")
    columns.write(tmp_path)
    assert json.loads((tmp_path / "columns.json").read_text())["rows.csv"]["force_x"].endswith("newtons")
