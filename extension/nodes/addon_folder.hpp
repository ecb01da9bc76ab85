// Where the addon lies in the project: wherever its folder was copied to.
//
// Main thread only.
#pragma once

#include <godot_cpp/variant/string.hpp>

namespace tactus {

// The folder of tactus.gdextension, as a path that Godot's FileAccess understands; without a slash at its
// end.
godot::String addon_folder();

}  // namespace tactus
