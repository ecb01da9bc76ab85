// A scene that the editor has started sends its figures to the editor's Tactus panel by overlay/probe.gd of
// the addon. The first HapticWorld adds it, so that the project's settings need no autoload.
//
// Main thread only.
#pragma once

#include <godot_cpp/classes/node.hpp>

namespace tactus {

// `world` is in the tree of a running program. Does nothing where no editor watches, or where the probe is
// there already.
void show_to_editor(const godot::Node& world);

}  // namespace tactus
