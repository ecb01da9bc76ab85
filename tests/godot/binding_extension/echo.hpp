#pragma once

#include <godot_cpp/classes/node.hpp>
#include <godot_cpp/classes/ref_counted.hpp>
#include <godot_cpp/classes/resource.hpp>
#include <godot_cpp/core/class_db.hpp>

namespace probe {

// Gives back what it gets: one method for each type that may cross the border.
class BindingEcho : public godot::RefCounted {
    GDCLASS(BindingEcho, godot::RefCounted)

public:
    enum Flavour { FLAVOUR_SWEET, FLAVOUR_SOUR, FLAVOUR_BITTER = 7 };

    template <class T>
    T echo(const T& value) {
        return value;
    }
    Flavour echo_enum(Flavour value) const { return value; }
    godot::Object* echo_object(godot::Object* value) { return value; }
    godot::Node* echo_node(godot::Node* value) { return value; }
    godot::Ref<godot::Resource> echo_resource(const godot::Ref<godot::Resource>& value) { return value; }

    // Makes a value of each type here, sends it through `echo`, and says which came back changed.
    godot::PackedStringArray send_through(const godot::Callable& echo) const;

    static godot::String join(const godot::String& left, int32_t right, bool upper);
    godot::PackedVector3Array moved(const godot::PackedVector3Array& points, const godot::Vector3& by) const;
    double sum(const godot::PackedFloat32Array& values) const;

protected:
    static void _bind_methods();
};

}  // namespace probe

VARIANT_ENUM_CAST(probe::BindingEcho::Flavour)
