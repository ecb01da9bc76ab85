"""What a library must find where it is loaded, read from what objdump says of it."""

import subprocess

import pytest
import shipped_library
from setup import platforms

FOR_WINDOWS = """
	DLL Name: KERNEL32.dll
	vma:  Hint/Ord Member-Name Bound-To
	2f7e  	  283  DeleteCriticalSection

	DLL Name: libstdc++-6.dll

[Ordinal/Name Pointer] Table
	[   0] tactus_library_init
"""
FOR_LINUX = """
Dynamic Section:
  NEEDED               libm.so.6
  NEEDED               libc.so.6

Version References:
  required from libc.so.6:
    0x06969189 0x00 07 GLIBC_2.29
    0x09691a75 0x00 09 GLIBC_2.2.5
    0x09691972 0x00 12 GLIBC_2.4

DYNAMIC SYMBOL TABLE:
0000000000000000      DF *UND*	0000000000000000 (GLIBC_2.2.5) free
000000000004c860 g    DF .text	000000000000009b  Base        tactus_library_init
"""
FOR_MACOS = """/here/libtactus.macos.template_debug.universal.dylib:
	libtactus.macos.template_debug.arm64.dylib (compatibility version 1.0.0, current version 1.0.0)
	/usr/lib/libSystem.B.dylib (compatibility version 1.0.0, current version 1351.0.0)

Exports trie:
0x000007C0  _tactus_library_init
0x00019CF0  __ZdlPvm [weak_def]
"""


def test_what_would_have_to_lie_beside_it_is_named():
    library = shipped_library.described(FOR_WINDOWS)
    assert library.libraries == {"kernel32.dll", "libstdc++-6.dll"}
    assert library.complaint("windows") == "needs libstdc++-6.dll, which would have to lie beside it"


def test_the_oldest_c_library_is_the_newest_version_asked_for():
    library = shipped_library.described(FOR_LINUX)
    assert library.glibc == "2.29"
    assert library.complaint("linux") == ""


def test_a_library_without_the_door_is_not_given_away(tmp_path):
    source, library = tmp_path / "other.cpp", tmp_path / "libother.so"
    source.write_text('extern "C" int another_door() { return 0; }\n')
    subprocess.run(["g++", "-shared", "-fPIC", source, "-o", library], check=True)
    host = platforms.host()
    assert shipped_library.read(library, host).complaint(host.system) == "does not show tactus_library_init"


def test_a_door_that_is_asked_for_is_none():
    asked_for = FOR_LINUX.replace("g    DF .text", "     DF *UND*")
    assert not shipped_library.described(asked_for).has_entry


def test_a_library_of_macos_may_ask_for_the_system_alone():
    assert shipped_library.described(FOR_MACOS).complaint("macos") == ""
    other = FOR_MACOS.replace("\n\nExports", "\n\t@rpath/libother.dylib (compatibility version 1.0.0, current version 1.0.0)\n\nExports")
    assert shipped_library.described(other).complaint("macos") == "needs @rpath/libother.dylib, which would have to lie beside it"


def test_each_slice_shows_the_door():
    slices = [shipped_library.described(text) for text in (FOR_MACOS, FOR_MACOS.replace("_tactus_library_init", "_other"))]
    assert shipped_library.together(slices[:1]).has_entry
    assert shipped_library.together(slices).complaint("macos") == "does not show tactus_library_init"


def test_what_is_no_library_is_refused_whatever_its_reader_ends_with(tmp_path):
    for ending in (0, 1):
        reader = tmp_path / f"reader_{ending}"
        reader.write_text(f"#!/bin/sh\necho $1: is not an object file\nexit {ending}\n")
        reader.chmod(0o755)
        with pytest.raises(RuntimeError, match="is no library"):
            shipped_library._output([reader, "words.txt"])
