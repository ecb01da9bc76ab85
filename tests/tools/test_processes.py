"""What has been started ends; what must not be ended in the middle is waited for."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from setup import cache
from stand_in_clone import Clone

# Who does not listen, and what it has started, in a session of its own.
DEAF = """
import sys
sys.path.insert(0, {tools!r})
from setup import processes
import subprocess
processes.PATIENCE = 0.3
def work():
    subprocess.Popen(["sh", "-c", "trap '' TERM; echo $$; setsid sh -c 'trap \\"\\" TERM; echo $$; while :; do sleep 1; done' & while :; do sleep 1; done"])
    import time
    time.sleep({seconds})
    return 7
sys.exit(processes.kept(work))
"""
# Root's installer of packages: fetching may be ended, installing not.
APT = """#!/bin/bash
case "$*" in
update) exit 0 ;;
*--download-only*) step=fetching ;;
*) step=installing ;;
esac
echo $step >>"$STAND_INS/started"
sleep ${SECONDS_OF_APT:-0.5}
echo "$step done" >>"$STAND_INS/apt"
"""


def _is_there(pid: int) -> bool:
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] not in "ZX"
    except OSError:
        return False


def test_who_does_not_listen_is_ended_and_the_code_is_that_of_the_work():
    code = DEAF.format(tools=str(cache.clone() / "tools"), seconds=1)
    done = subprocess.run([sys.executable, "-c", code], text=True, capture_output=True, timeout=60)
    pids = [int(word) for word in done.stdout.split()]
    assert done.returncode == 7 and len(pids) == 2, done.stderr
    assert not any(_is_there(pid) for pid in pids)


SAVING = """
import os, signal, sys, threading
sys.path.insert(0, {tools!r})
import entry
from setup import processes
def work():
    threading.Timer(0.5, lambda: os.kill(os.getpid(), signal.SIGTERM)).start()
    return processes.run(["sh", "-c", "trap : TERM; sleep 30; echo saved >{file}"])
sys.exit(processes.kept(lambda: entry.ended(work)))
"""


def test_who_waits_for_what_it_has_started_can_save_what_it_has(tmp_path):
    """As SCons does: it waits for the compilers, and then writes down what is built."""
    code = SAVING.format(tools=str(cache.clone() / "tools"), file=tmp_path / "file")
    begun = time.monotonic()
    done = subprocess.run([sys.executable, "-c", code], text=True, capture_output=True, timeout=60)
    assert done.returncode == 128 + signal.SIGTERM, done.stderr
    assert (tmp_path / "file").read_text() == "saved\n"
    assert time.monotonic() - begun < 25.0  # not the 30 s of what it has started


LATE = """
import os, signal, sys
sys.path.insert(0, {tools!r})
from setup import processes
wait = os.waitpid
def waited(*which):
    found = wait(*which)
    os.kill(os.getpid(), signal.SIGHUP)
    return found
os.waitpid = waited
sys.exit(processes.kept(lambda: 3))
"""


def test_a_signal_may_come_when_the_work_has_just_ended():
    done = subprocess.run([sys.executable, "-c", LATE.format(tools=str(cache.clone() / "tools"))], text=True, capture_output=True, timeout=60)
    assert done.returncode == 3, done.stderr


@pytest.fixture
def clone(tmp_path):
    """With the clone's own script for packages, and an apt-get beside it that takes its time."""
    clone = Clone(tmp_path)
    (clone.folder / "tools/debian_packages.sh").write_text((cache.clone() / "tools/debian_packages.sh").read_text())
    (clone.programs / "apt-get").write_text(APT)
    (clone.programs / "id").write_text("#!/bin/sh\necho ${USER_ID:-0}\n")
    for name in ("apt-get", "id"):
        (clone.programs / name).chmod(0o755)
    # What is missing, wherever this runs: the package of a compiler that only its stand-in could have.
    script = clone.folder / "tools/debian_packages.sh"
    script.write_text(script.read_text().replace("needs cargo command -v cargo", "needs cargo false"))
    yield clone
    clone.end_all()


def _wait_for(path: Path, word: str) -> None:
    until = time.monotonic() + 30.0
    while not (path.is_file() and word in path.read_text()):
        assert time.monotonic() < until, f"never {word}"
        time.sleep(0.01)


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP], ids=lambda one: one.name)
@pytest.mark.parametrize(("step", "expected"), [("fetching", ""), ("installing", "fetching done\ninstalling done\n")])
def test_packages_are_not_left_half_installed(step, expected, number, clone):
    command = [clone.folder / "run", "setup"]
    process = subprocess.Popen(
        command, cwd=clone.folder, env=clone.environment, text=True, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, start_new_session=True
    )
    _wait_for(clone.stand_ins / "started", step)
    os.killpg(process.pid, number)
    stderr = process.communicate(timeout=30)[1]
    assert process.returncode == 128 + number, stderr
    log = clone.stand_ins / "apt"
    assert (log.read_text() if log.is_file() else "") == expected
    assert clone.left_running() == []


def test_the_documentation_asks_for_no_compiler(clone):
    refused = clone.ask("setup", env={"USER_ID": "1000"})
    assert refused.returncode == 2 and "sudo apt-get install" in refused.stderr and "cargo" in refused.stderr
    script = clone.folder / "tools/debian_packages.sh"
    pages = subprocess.run([script, "pages"], env=clone.environment | {"USER_ID": "1000"}, text=True, capture_output=True)
    assert pages.returncode == 0 and "cargo" not in pages.stderr
    assert not (clone.stand_ins / "apt").exists()
