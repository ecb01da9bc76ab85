#pragma once

#include <godot_cpp/variant/string_name.hpp>

namespace godot {

// Editor plugins of the extension: switched on when the editor level starts, off when it ends.
class EditorPlugins {
public:
    template <class T>
    static void add_by_type() {
        add_plugin_class(T::get_class_static());
    }
    template <class T>
    static void remove_by_type() {
        remove_plugin_class(T::get_class_static());
    }

    static void add_plugin_class(const StringName& class_name);
    static void remove_plugin_class(const StringName& class_name);
};

}  // namespace godot
