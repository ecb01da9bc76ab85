// Upstream godot-cpp's signatures of the names that nodes/ uses, one line each, as the headers of godot-cpp
// and what its binding_generator.py writes declare them (4.5-stable and master of September 2026). It
// compiles where the binding, or the godot-cpp in GODOT_CPP, declares each of them exactly so;
// tests/tools/test_godot_cpp.py compares the list with what nodes/ calls. A missing line is copied from
// upstream's header, not from the binding.
#pragma once

#include <cstddef>
#include <new>
#include <utility>

namespace probe {

// So that the object file names what the list names.
void keep(const void* function, std::size_t size);

// A function of exactly this type: static_cast finds no other overload.
template <class Signature>
void same(Signature function) {
    keep(&function, sizeof(function));
}

// A constructor with exactly these arguments.
template <class T, class... A>
void construct(void* at, A... arguments) {
    ::new (at) T(static_cast<A>(arguments)...);
}

template <class T, class... A>
void constructor() {
    same<void (*)(void*, A...)>(&construct<T, A...>);
}

void list_values();
void list_classes();

}  // namespace probe
