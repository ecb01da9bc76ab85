#include "nodes/addon_folder.hpp"

#include <godot_cpp/classes/gd_extension_manager.hpp>
#include <godot_cpp/variant/packed_string_array.hpp>

namespace tactus {

godot::String addon_folder() {
    const godot::PackedStringArray loaded =
        godot::GDExtensionManager::get_singleton()->get_loaded_extensions();
    for (std::int64_t i = 0; i < loaded.size(); ++i) {
        const godot::String path = loaded[i];
        if (path.get_file() == "tactus.gdextension") {
            return path.get_base_dir();
        }
    }
    return "res://addons/tactus";
}

}  // namespace tactus
