#!/usr/bin/env bash
# Makes sure of what must come from the system, by the words given: python (before all else), pages (the documentation alone),
# build (everything that compiles and plays), and what platforms, emulators and single commands need besides.
# Root: installs what is missing. Otherwise: says how, and stops with 2.
set -euo pipefail

missing=()
needs() { # needs PACKAGE COMMAND…: the package is missing when the command fails
    local package="$1"
    shift
    "$@" >/dev/null 2>&1 || missing+=("$package")
}

played=()
wants() { # wants PACKAGE COMMAND…: without the package some tests are left out
    local package="$1"
    shift
    "$@" >/dev/null 2>&1 || played+=("$package")
}

# OpenNI2, by which depth cameras are read.
sensing=()
[ -e /usr/include/openni2/Driver/OniDriverAPI.h ] || sensing=(libopenni2-dev)
# The part of PCL that its bench is held beside: tools/setup/pcl.py.
rival=()
if ! compgen -G "/usr/lib/*/libpcl_registration.so.*" >/dev/null || [ ! -e /usr/include/eigen3/Eigen/Core ] || [ ! -e /usr/include/boost/version.hpp ]; then
    version="$(apt-cache pkgnames libpcl-registration 2>/dev/null | sed -n 's/^libpcl-registration//p' | sort -V | tail -n 1)"
    rival=(libeigen3-dev libboost-dev)
    for part in common kdtree octree search sample-consensus filters features segmentation registration; do
        rival+=("libpcl-$part$version")
    done
fi
# What ./run proof plays with: libFuzzer beside the newest clang there is, and a loop to hold its own beside.
proof=()
if ! compgen -G "/usr/lib/llvm-*/lib/clang/*/lib/linux/libclang_rt.fuzzer-*.a" >/dev/null; then
    version="$(apt-cache pkgnames libclang-rt- 2>/dev/null | sed -n 's/^libclang-rt-\([0-9]*\)-dev$/\1/p' | sort -n | tail -n 1)"
    proof+=("clang${version:+-$version}" "libclang-rt-${version:-19}-dev")
fi
command -v cyclictest >/dev/null || proof+=(rt-tests)

needs python3 test -x /usr/bin/python3
if [ "$*" != python ]; then
    needs python3-venv /usr/bin/python3 -c 'import ensurepip, venv'
    needs ca-certificates test -e /etc/ssl/certs/ca-certificates.crt
fi
if [[ " $* " == *" build "* ]]; then
    needs g++ command -v g++
    needs cargo command -v cargo
    needs libglm-dev test -e /usr/include/glm/glm.hpp
    needs libsodium-dev test -e /usr/include/sodium.h
    needs libgtest-dev test -e /usr/include/gtest/gtest.h
    needs libbullet-dev test -e /usr/include/bullet/btBulletCollisionCommon.h
    [ -n "${DISPLAY:-}${WAYLAND_DISPLAY:-}" ] || needs xvfb command -v Xvfb
    # Plays devices for the tests, on USB and behind a service.
    wants pkg-config command -v pkg-config
    wants libumockdev-dev pkg-config --exists umockdev-1.0
    wants umockdev command -v umockdev-run  # what is loaded before the C library comes with it
    wants libwslay1 python3 -c 'import ctypes; ctypes.CDLL("libwslay.so.1")'
    wants libjansson4 python3 -c 'import ctypes; ctypes.CDLL("libjansson.so.4")'
    wants libusb-1.0-0 python3 -c 'import ctypes; ctypes.CDLL("libusb-1.0.so.0")'
fi
seeing=no
compared=no
proven=no
for extra in "$@"; do
    case "$extra" in
    python | pages | build) continue ;;
    sensing) seeing=wanted && continue ;;
    rival) compared=wanted && continue ;;
    proof) proven=wanted && continue ;;
    with_sensing) missing+=("${sensing[@]}" "${rival[@]}") && continue ;;
    esac
    needs make command -v make
    case "$extra" in
    windows) needs g++-mingw-w64-x86-64-posix command -v x86_64-w64-mingw32-g++-posix ;;
    linux_arm64) needs g++-aarch64-linux-gnu command -v aarch64-linux-gnu-g++ ;;
    wine) needs wine64 test -x /usr/lib/wine/wine64 ;;
    macos_*) needs llvm compgen -G '/usr/lib/llvm-*/bin/llvm-lipo' ;;
    qemu) needs qemu-user command -v qemu-aarch64 ;;
    esac
done

goes_without() { # goes_without WHAT PACKAGE…: root installs the packages, others are told how
    local what="$1"
    shift
    [ $# -gt 0 ] && command -v apt-get >/dev/null || return 0
    if [ "$(id -u)" -eq 0 ]; then
        missing+=("$@")
    else
        echo "Left out: $what. For that:" >&2
        echo "  sudo apt-get install --yes --no-install-recommends $*" >&2
    fi
}
goes_without "tests with devices that are played" "${played[@]}"
[ "$seeing" = no ] || goes_without "depth cameras and their tests" "${sensing[@]}"
[ "$compared" = no ] || goes_without "the comparison with PCL" "${rival[@]}"
[ "$proven" = no ] || goes_without "fuzzing led by libFuzzer, and the loop beside cyclictest" "${proof[@]}"
[ ${#missing[@]} -gt 0 ] || exit 0
# What the same is called elsewhere. Godot itself is fetched on Debian only: there, one of version 4.4 or later must be on
# the PATH or in GODOT.
if ! command -v apt-get >/dev/null; then
    echo "Missing on this system (names of Debian's packages): ${missing[*]}." >&2
    if command -v dnf >/dev/null; then
        echo "  sudo dnf install gcc-c++ libstdc++-static cargo python3 glm-devel libsodium-devel libsodium-static gtest-devel bullet-devel xorg-x11-server-Xvfb" >&2
    elif command -v zypper >/dev/null; then
        echo "  sudo zypper install gcc-c++ cargo python3 glm-devel libsodium-devel gtest libbullet-devel xorg-x11-server-Xvfb" >&2
    elif command -v pacman >/dev/null; then
        echo "  sudo pacman -S --needed gcc rust python glm libsodium gtest bullet xorg-server-xvfb" >&2
    fi
    echo "and a Godot of version 4.4 or later on the PATH or named in GODOT." >&2
    exit 2
fi
install="apt-get install --yes --no-install-recommends ${missing[*]}"
if [ "$(id -u)" -ne 0 ]; then
    echo "Missing on this system: ${missing[*]}" >&2
    echo "  sudo $install" >&2
    exit 2
fi

started=$SECONDS
printf '[system] Debian packages %s … ' "${missing[*]}"
log="$(mktemp)"
export DEBIAN_FRONTEND=noninteractive
# Fetching may be interrupted. What dpkg unpacks and sets up may not: half of it would keep the system from installing more.
if ! { apt-get update && $install --download-only && trap '' INT TERM HUP && $install; } >"$log" 2>&1; then
    echo failed
    tail -n 20 "$log" >&2
    exit 1
fi
rm -f "$log"
echo "$((SECONDS - started)) s"
