"""Who may open a haptic device on USB: a rule for udev, which gives it to whoever sits at the machine."""

import os
import shlex
import shutil
import subprocess
from pathlib import Path

# Before 73-seat-late.rules, which looks at the tag.
RULE_FILE = Path("/etc/udev/rules.d/60-tactus-devices.rules")
# Vendor and product; every product of Force Dimension. 3D Systems and Haply bring drivers and rules of their own.
DEVICES = {"Novint Falcon": ("0403", "cb48"), "Force Dimension": ("1451", "*")}
RELOAD = ["udevadm control --reload", "udevadm trigger --subsystem-match=usb"]


def rules() -> str:
    lines = ["# Haptic devices of Tactus (./run setup --device-access)."]
    for name, (vendor, product) in DEVICES.items():
        lines.append(f"# {name}")
        lines.append(f'SUBSYSTEM=="usb", ATTR{{idVendor}}=="{vendor}", ATTR{{idProduct}}=="{product}", TAG+="uaccess"')
    return "\n".join(lines) + "\n"


def install(file: Path = RULE_FILE) -> int:
    """Writes the rule where this user may, else says how."""
    if file.is_file() and file.read_text() == rules():
        print(f"{file} is there already. Plug the device in again if it may still not be opened.")
        return 0
    if not os.access(file.parent, os.W_OK):
        print("Only the system's administrator may do this. Type:")
        print(f"  printf %s {shlex.quote(rules())} | sudo tee {file} >/dev/null")
        print(f"  sudo sh -c {shlex.quote(' && '.join(RELOAD))}")
        return 2
    file.write_text(rules())
    if shutil.which("udevadm"):
        for command in RELOAD:
            # Where no udev runs, as in a container, the rule waits for one.
            subprocess.run(command.split(), check=False, capture_output=True)
    print(f"{file} is written. Plug the device in again.")
    return 0
