"""Which sources are for which platform, and that no other file asks for one."""

import re
import subprocess
import sys

import front_door
import pytest
from setup import cache, platforms

sys.path.insert(0, str(cache.clone() / "site_scons"))
import layers  # noqa: E402
import manifest  # noqa: E402
import toolchain  # noqa: E402

SYSTEM_HEADERS = re.compile(
    r"#\s*include <(sys/|arpa/|netinet/|linux/|mach/|unistd|pthread|sched|poll|fcntl|dlfcn|signal|windows|winsock)"
)
ASKS_FOR_A_SYSTEM = re.compile(r"#\s*(if|elif|ifdef|ifndef).*(_WIN32|__linux__|__APPLE__|__unix__|__MINGW)")


@pytest.mark.parametrize(
    ("name", "system", "architecture", "expected"),
    [
        ("clock.cpp", "linux", "x86_64", True),
        ("clock_posix.cpp", "linux", "arm64", True),
        ("clock_posix.cpp", "macos", "arm64", True),
        ("clock_posix.cpp", "windows", "x86_64", False),
        ("clock_windows.cpp", "windows", "x86_64", True),
        ("clock_windows.cpp", "linux", "x86_64", False),
        ("packet_filter_other.cpp", "linux", "x86_64", False),
        ("packet_filter_other.cpp", "macos", "arm64", True),
        ("packet_filter_other.cpp", "windows", "x86_64", True),
        ("clock_linux_test.cpp", "linux", "x86_64", True),
        ("clock_linux_test.cpp", "windows", "x86_64", False),
        ("processor_arm64.cpp", "linux", "x86_64", False),
        ("processor_arm64.cpp", "linux", "arm64", True),
    ],
)
def test_the_end_of_its_name_says_what_a_source_is_for(name, system, architecture, expected):
    assert layers.is_for(name, system, architecture) == expected


def test_every_question_has_an_answer_on_every_system():
    folder = cache.clone() / "extension/platform"
    headers = {path.stem for path in folder.glob("*.hpp")}
    for one in [platforms.host(), *platforms.FOREIGN]:
        for header in (path for path in folder.glob("*.hpp") if layers.is_for(path, one.system, one.architecture)):
            sources = [path for path in folder.glob(f"{header.stem}*.cpp")]
            if sources:
                chosen = [path for path in sources if layers.is_for(path, one.system, one.architecture)]
                assert chosen, f"{header.name} has no source for {one.name}"
    assert "clock" in headers


def test_only_one_folder_speaks_to_the_system():
    extension = cache.clone() / "extension"
    allowed = [extension / "platform", extension / "binding"]
    offenders = [
        str(path)
        for path in extension.rglob("*.[hc]pp")
        if not any(folder in path.parents for folder in allowed)
        and (SYSTEM_HEADERS.search(path.read_text()) or ASKS_FOR_A_SYSTEM.search(path.read_text()))
    ]
    assert offenders == []


def test_a_platform_that_is_not_known_is_told_which_are():
    with pytest.raises(RuntimeError, match="platform=amiga: choose from linux, windows, linux_arm64, macos_x86_64, macos_arm64"):
        platforms.named("amiga")


def test_the_words_of_the_command_line_are_understood():
    assert platforms.tested_by("windows").name == "windows"
    assert platforms.tested_by("arm64").name == "linux_arm64"
    assert platforms.tested_by("cpp.core") is None
    assert platforms.tested_by("macos") is None
    assert [one.name for one in platforms.named_in(["--platform=windows,linux_arm64"])] == ["windows", "linux_arm64"]
    assert [one.name for one in platforms.named_in(["--platform=macos"])] == ["macos_x86_64", "macos_arm64"]
    assert [one.name for one in platforms.named_in(["--platform=macos,macos_arm64"])] == ["macos_x86_64", "macos_arm64"]
    assert platforms.named_in(["--platform=linux"]) == []
    assert platforms.named_in(["--all"]) == platforms.FOREIGN


@pytest.mark.parametrize(
    ("command", "arguments", "asked_for"),
    [
        ("demo", [], []),
        ("test", [], []),
        ("test", ["cpp.core"], []),
        ("addon", [], []),
        ("test", ["windows"], ["windows"]),
        ("test", ["arm64", "cpp.core"], ["linux_arm64"]),
        ("addon", ["--platform=windows,linux_arm64"], ["windows", "linux_arm64"]),
        ("addon", ["--platform=macos"], ["macos_x86_64", "macos_arm64"]),
    ],
)
def test_only_who_asks_for_a_platform_sets_it_up(command, arguments, asked_for):
    names = [step.name for step in front_door.needed(*front_door.read([command, *arguments]))]
    foreign = [one.name for one in platforms.FOREIGN if any(name.endswith(f" for {one.name}") for name in names)]
    assert foreign == asked_for
    assert len(set(names)) == len(names)


def test_icons_are_named_from_any_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert 'HapticWorld = "icons/HapticWorld.svg"' in manifest.text("4.6", "single", [platforms.host()]).splitlines()


@pytest.mark.parametrize("target", toolchain.BY_TARGET)
def test_an_object_names_no_folder_of_the_machine_that_built_it(target, tmp_path):
    source = cache.clone() / "extension/platform/clock_posix.cpp"
    # As scons calls it: from the clone, without the marks that are its own.
    flags = [flag for flag in toolchain.compile_flags(platforms.host(), target) if flag not in ("$(", "$)")]
    command = ["g++", *flags, "-I", cache.clone() / "extension", "-c", source, "-o", tmp_path / "one.o"]
    subprocess.run(command, cwd=cache.clone(), check=True)
    assert str(cache.clone()).encode() not in (tmp_path / "one.o").read_bytes()


def test_godot_finds_each_platforms_library_by_its_tags():
    text = manifest.text("4.6", "single", platforms.given_away([platforms.host(), *platforms.FOREIGN]))
    for line in (
        'windows.debug.single.x86_64 = "bin/libtactus.windows.template_debug.x86_64.dll"',
        'windows.release.single.x86_64 = "bin/libtactus.windows.template_release.x86_64.dll"',
        'linux.release.single.arm64 = "bin/libtactus.linux.template_release.arm64.so"',
        'macos.release.single = "bin/libtactus.macos.template_release.universal.dylib"',
    ):
        assert line in text.splitlines()


def test_one_slice_of_macos_is_given_away_as_it_is():
    (arm,) = [one for one in platforms.FOREIGN if one.name == "macos_arm64"]
    assert platforms.given_away([platforms.host(), arm]) == [platforms.host(), arm]
    assert 'macos.debug.single.arm64 = "bin/libtactus.macos.template_debug.arm64.dylib"' in manifest.text("4.6", "single", [arm])
