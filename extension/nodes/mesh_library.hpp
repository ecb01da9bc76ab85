// The .obj files that travel inside the addon, in its folder meshes/, found wherever the addon was copied to.
//
// library.json beside them gives each a mass and says where it comes from. Main thread only.
#pragma once

#include <godot_cpp/variant/packed_string_array.hpp>
#include <godot_cpp/variant/string.hpp>
#include <memory>

#include "world/triangle_source.hpp"

namespace tactus {

// The folder as a path that Godot's FileAccess understands; without a slash at its end.
godot::String mesh_library_folder();

// Names without ".obj", sorted.
godot::PackedStringArray mesh_library_names();

// Its triangles are read, or the error says what is wrong and what to do.
std::shared_ptr<TriangleSource> load_library_mesh(const godot::String& name);

struct LibraryEntry {
    double mass = 0.0;     // (unit: kilograms)
    godot::String source;  // where the mesh comes from
};

// Empty where library.json says nothing of it.
LibraryEntry mesh_library_entry(const godot::String& name);

}  // namespace tactus
