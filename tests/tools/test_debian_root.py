"""The address of the machine's own archive, in both syntaxes of apt sources."""

from setup.debian_root import archive_addresses


def test_deb822_stanza():
    text = "# old: http://other/debian\nTypes: deb\nURIs: http://mirror/debian\nSuites: bookworm\n"
    assert archive_addresses(".sources", text) == ["http://mirror/debian"]


def test_disabled_stanza_is_skipped():
    text = "Types: deb\nEnabled: no\nURIs: http://a/debian\n\nTypes: deb\nURIs: http://b/debian/\n"
    assert archive_addresses(".sources", text) == ["http://b/debian/"]


def test_other_archives_are_skipped():
    text = "Types: deb\nURIs: http://mirror/debian-security\n"
    assert archive_addresses(".sources", text) == []


def test_one_line_with_options():
    text = "# deb http://no/debian x main\ndeb [arch=amd64 signed-by=/k] https://mirror/debian bookworm main\n"
    assert archive_addresses(".list", text) == ["https://mirror/debian"]


def test_source_line_is_skipped():
    assert archive_addresses(".list", "deb-src http://mirror/debian bookworm main\n") == []
