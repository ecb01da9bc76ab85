#pragma once

#include <cstddef>
#include <cstdint>

namespace godot {

// Godot's official builds use single precision for everything that stands in a Vector3 or a Transform3D.
using real_t = float;

// An object as the engine knows it: opaque to extensions.
using GodotObject = void;

}  // namespace godot

#ifndef GDE_EXPORT
#if defined(_WIN32)
#define GDE_EXPORT __declspec(dllexport)
#else
#define GDE_EXPORT __attribute__((visibility("default")))
#endif
#endif

#ifndef _FORCE_INLINE_
#define _FORCE_INLINE_ inline
#endif

#ifndef likely
#define likely(condition) __builtin_expect(!!(condition), 1)
#define unlikely(condition) __builtin_expect(!!(condition), 0)
#endif

#ifndef SNAME
#define SNAME(text) (::godot::StringName(text))
#endif
