#pragma once

#include <godot_cpp/classes/project_settings.hpp>
#include <string>

#include "nodes/conversions.hpp"

namespace tactus {

// A path as Godot has it, user:// and res:// included, for the system; empty stays empty.
inline std::string whole_path(const godot::String& path) {
    return from_godot(path.is_empty() ? path : godot::ProjectSettings::get_singleton()->globalize_path(path));
}

}  // namespace tactus
