"""Debian packages of another suite in a private folder: fetched and verified by apt, unpacked, never installed."""

import os
import re
import shutil
import subprocess
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from . import fetching

KEYRING = "/usr/share/keyrings/debian-archive-keyring.gpg"
LIBRARY_FOLDER = "usr/lib/x86_64-linux-gnu"


class AptError(RuntimeError):
    pass


def mirrors() -> list[str]:
    """The addresses of the machine's own Debian archives, from its apt sources, each once."""
    etc = Path("/etc/apt")
    paths = [path for path in [etc / "sources.list", *sorted(etc.glob("sources.list.d/*"))] if path.is_file()]
    found = [address for path in paths for address in archive_addresses(path.suffix, path.read_text())]
    if not found:
        raise AptError("no Debian archive in /etc/apt/sources.list or /etc/apt/sources.list.d")
    return list(dict.fromkeys(found))


def archive_addresses(suffix: str, text: str) -> list[str]:
    """The Debian archives named: stanzas in .sources files, lines in .list files."""
    addresses = _of_stanzas(text) if suffix == ".sources" else _of_lines(text)
    return [address for address in addresses if re.search(r"/debian/?$", address)]


def _of_stanzas(text: str) -> list[str]:
    found = []
    for stanza in text.split("\n\n"):
        fields = dict(re.findall(r"^(\w[\w-]*):[ \t]*(.*)$", stanza, re.M))
        if "deb" in fields.get("Types", "").split() and fields.get("Enabled", "yes") != "no":
            found += fields.get("URIs", "").split()
    return found


def _of_lines(text: str) -> list[str]:
    return re.findall(r"^deb\s+(?:\[[^\]]*\]\s+)?(\S+)\s", text, re.M)


class DebianRoot:
    def __init__(self, folder: Path, suite: str, address: str):
        self.apt = folder
        self.suite = suite
        self.address = address

    def candidate(self, package: str) -> str:
        """The version the suite has, e.g. 4.6.3+ds-2."""
        text = self._run("apt-cache", "policy", package)
        found = re.search(r"Candidate: (\S+)", text)
        if not found or found[1] == "(none)":
            raise AptError(f"the suite {self.suite} has no package {package}")
        return found[1]

    def update(self) -> None:
        for folder in ("state/lists/partial", "cache/archives/partial", "empty"):
            (self.apt / folder).mkdir(parents=True, exist_ok=True)
        (self.apt / "status").write_text("")
        (self.apt / "sources.list").write_text(f"deb [signed-by={KEYRING}] {self.address} {self.suite} main\n")
        (self.apt / "apt.conf").write_text(self._configuration())
        # Else a server that does not answer leaves an empty list, and no error.
        self._run("apt-get", "update", "--option=APT::Update::Error-Mode=any")

    def fetch(self, packages: list[str]) -> list[Path]:
        """Downloads the packages and all they depend on; apt resumes what is partly there and checks every hash."""
        options = ["--download-only", "--yes", "--no-install-recommends"]
        self._run("apt-get", "install", *options, *packages)
        return sorted((self.apt / "cache/archives").glob("*.deb"))

    def fetched(self) -> str:
        """How much of it is there."""
        files = [path for path in (self.apt / "cache/archives").rglob("*") if path.is_file()]
        return f"{sum(path.stat().st_size for path in files) / 1e6:.0f} MB"

    def unpack(self, archives: list[Path], target: Path) -> None:
        with ThreadPoolExecutor(os.cpu_count() or 1) as pool:
            list(pool.map(lambda deb: subprocess.run(["dpkg", "-x", deb, target], check=True), archives))

    def forget_downloads(self) -> None:
        shutil.rmtree(self.apt, ignore_errors=True)

    def _configuration(self) -> str:
        # The private status file is empty, so that every dependency down to libc comes along.
        # The hooks that container images set would clean the machine's cache, not this one.
        return f"""
Dir::State "{self.apt}/state";
Dir::State::status "{self.apt}/status";
Dir::Cache "{self.apt}/cache";
Dir::Etc::SourceList "{self.apt}/sources.list";
Dir::Etc::SourceParts "{self.apt}/empty";
Dir::Etc::Preferences "{self.apt}/empty/preferences";
Dir::Etc::PreferencesParts "{self.apt}/empty";
Acquire::Languages "none";
Acquire::Retries "3";
Acquire::IndexTargets::deb::DEP-11::DefaultEnabled "false";
APT::Architecture "amd64";
APT::Architectures {{ "amd64"; }};
APT::Sandbox::User "";
#clear APT::Update::Post-Invoke;
#clear APT::Update::Post-Invoke-Success;
#clear DPkg::Post-Invoke;
"""

    def _run(self, *command: str) -> str:
        environment = os.environ | {"APT_CONFIG": str(self.apt / "apt.conf"), "LC_ALL": "C"}
        done = subprocess.run(command, env=environment, text=True, capture_output=True)
        if done.returncode != 0:
            raise fetching.trouble(" ".join(command[:2]), done.stdout[-2000:] + done.stderr[-2000:])
        return done.stdout
