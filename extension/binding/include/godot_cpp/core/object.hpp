#pragma once

#include <godot_cpp/classes/object.hpp>
#include <godot_cpp/core/object_id.hpp>
#include <godot_cpp/core/property_info.hpp>
#include <godot_cpp/variant/variant.hpp>
#include <utility>
#include <vector>

namespace godot {

// A signature: of a signal, or of a method with variable arguments.
struct MethodInfo {
    StringName name;
    PropertyInfo return_val;
    uint32_t flags = GDEXTENSION_METHOD_FLAGS_DEFAULT;
    int id = 0;
    std::vector<PropertyInfo> arguments;
    std::vector<Variant> default_arguments;

    MethodInfo() = default;

    template <class... A>
    explicit MethodInfo(const StringName& p_name, const A&... p_arguments)
        : name(p_name), arguments{p_arguments...} {}

    template <class... A>
    MethodInfo(const PropertyInfo& p_return, const StringName& p_name, const A&... p_arguments)
        : name(p_name), return_val(p_return), arguments{p_arguments...} {}

    template <class... A>
    MethodInfo(Variant::Type p_return, const StringName& p_name, const A&... p_arguments)
        : name(p_name), return_val(p_return, StringName()), arguments{p_arguments...} {}
};

class ObjectDB {
public:
    // Null when the object is gone.
    static Object* get_instance(uint64_t object_id);
};

}  // namespace godot
