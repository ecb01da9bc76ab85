#pragma once

#include <godot_cpp/classes/physics_material.hpp>

#include "core/haptics/touch_material.hpp"

namespace tactus {

// What a surface feels like. Goes into the ordinary physics_material_override of a body, and keeps what a
// PhysicsMaterial says about contacts between bodies.
class HapticMaterial : public godot::PhysicsMaterial {
    GDCLASS(HapticMaterial, godot::PhysicsMaterial)

public:
    void set_stiffness(double stiffness);
    double get_stiffness() const { return touch_.stiffness; }
    void set_damping(double damping);
    double get_damping() const { return touch_.damping; }
    void set_static_friction(double friction);
    double get_static_friction() const { return touch_.static_friction; }
    void set_dynamic_friction(double friction);
    double get_dynamic_friction() const { return touch_.dynamic_friction; }

    // Ready for use: static friction is never below dynamic friction.
    TouchMaterial touch() const;

protected:
    static void _bind_methods();

private:
    void set(double& property, double value, const char* name);

    TouchMaterial touch_;
};

}  // namespace tactus
