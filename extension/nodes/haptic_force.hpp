#pragma once

#include <godot_cpp/classes/resource.hpp>
#include <godot_cpp/core/binder_common.hpp>
#include <godot_cpp/variant/transform3d.hpp>

#include "core/haptics/hand_effect.hpp"
#include "nodes/messages.hpp"
#include "nodes/properties.hpp"

namespace tactus {

// A force on the hand in closed form.
class HapticForce : public godot::Resource {
    GDCLASS(HapticForce, godot::Resource)

public:
    TACTUS_PROPERTIES(HapticForce)

    godot::String get_problem() const { return to_godot(check_effect(effect(godot::Transform3D()))); }
    godot::PackedStringArray get_problems() const { return list_of(get_problem()); }

    // `frame`: whose origin is its place, and whose axes its direction is in.
    HandEffect effect(const godot::Transform3D& frame) const;

protected:
    static void _bind_methods();
    void _validate_property(godot::PropertyInfo& property) const;

private:
    using Form = HandEffect::Form;

    void form_changed();

    Form form_ = Form::constant;
    Vec3 direction_{0.0, 1.0, 0.0};
    double force_ = 1.0;
    double first_force_ = 0.0;
    double stiffness_ = 200.0;
    double damping_ = 2.0;
    double period_ = 0.02;
    double phase_ = 0.0;
    double duration_ = 1.0;
    double pitch_ = 0.01;
};

}  // namespace tactus
