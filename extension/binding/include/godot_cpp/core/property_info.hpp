#pragma once

#include <gdextension_interface.h>

#include <godot_cpp/classes/global_constants.hpp>
#include <godot_cpp/variant/string.hpp>
#include <godot_cpp/variant/string_name.hpp>
#include <godot_cpp/variant/variant.hpp>

namespace godot {

struct PropertyInfo {
    Variant::Type type = Variant::NIL;
    StringName name;
    StringName class_name;
    uint32_t hint = PROPERTY_HINT_NONE;
    String hint_string;
    uint32_t usage = PROPERTY_USAGE_DEFAULT;

    PropertyInfo() = default;

    PropertyInfo(Variant::Type p_type, const StringName& p_name, PropertyHint p_hint = PROPERTY_HINT_NONE,
                 const String& p_hint_string = "", uint32_t p_usage = PROPERTY_USAGE_DEFAULT,
                 const StringName& p_class_name = "")
        : type(p_type),
          name(p_name),
          class_name(p_class_name),
          hint(p_hint),
          hint_string(p_hint_string),
          usage(p_usage) {
        if (hint == PROPERTY_HINT_RESOURCE_TYPE) {
            class_name = hint_string;
        }
    }

    PropertyInfo(GDExtensionVariantType p_type, const StringName& p_name,
                 PropertyHint p_hint = PROPERTY_HINT_NONE, const String& p_hint_string = "",
                 uint32_t p_usage = PROPERTY_USAGE_DEFAULT, const StringName& p_class_name = "")
        : PropertyInfo(static_cast<Variant::Type>(p_type), p_name, p_hint, p_hint_string, p_usage,
                       p_class_name) {}

    explicit PropertyInfo(const GDExtensionPropertyInfo* info);

    // The engine's view of the same memory: valid as long as this object is not moved.
    GDExtensionPropertyInfo view();
};

}  // namespace godot
