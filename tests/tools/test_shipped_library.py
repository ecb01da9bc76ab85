"""What a library must find where it is loaded, read from what objdump says of it."""

import subprocess

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
