"""./run setup --device-access: the rule is written where one may, and typed out where not."""

import re

from setup import device_access


def test_every_device_that_is_opened_on_usb_has_a_rule():
    """Those that the scan finds: extension/devices/scan.cpp."""
    rules = device_access.rules()
    for vendor, product in [("0403", "cb48"), ("1451", "*")]:
        assert f'ATTR{{idVendor}}=="{vendor}", ATTR{{idProduct}}=="{product}", TAG+="uaccess"' in rules


def test_the_rule_is_written_once(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(device_access, "RELOAD", [])
    file = tmp_path / "60-tactus-devices.rules"
    assert device_access.install(file) == 0
    assert 'ATTR{idVendor}=="0403", ATTR{idProduct}=="cb48"' in file.read_text()
    assert device_access.install(file) == 0
    assert "already" in capsys.readouterr().out


def test_who_may_not_write_it_is_told_what_to_type(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(device_access.os, "access", lambda *_: False)
    file = tmp_path / "60-tactus-devices.rules"
    assert device_access.install(file) == 2
    assert not file.exists()
    said = capsys.readouterr().out
    assert re.search(rf"sudo tee {file}", said) and "udevadm" in said
