#include "nodes/haptic_material.hpp"

#include <algorithm>
#include <godot_cpp/core/class_db.hpp>

#include "nodes/messages.hpp"

namespace tactus {

using namespace godot;

void HapticMaterial::set(double& property, double value, const char* name) {
    if (!is_at_least_zero(value)) {
        refuse(*this, name, value, "a finite number, 0 or more");
        return;
    }
    if (property != value) {
        property = value;
        emit_changed();
    }
}

void HapticMaterial::set_stiffness(double stiffness) { set(touch_.stiffness, stiffness, "stiffness"); }
void HapticMaterial::set_damping(double damping) { set(touch_.damping, damping, "damping"); }
void HapticMaterial::set_static_friction(double friction) {
    set(touch_.static_friction, friction, "static_friction");
}
void HapticMaterial::set_dynamic_friction(double friction) {
    set(touch_.dynamic_friction, friction, "dynamic_friction");
}

TouchMaterial HapticMaterial::touch() const {
    TouchMaterial touch = touch_;
    touch.static_friction = std::max(touch.static_friction, touch.dynamic_friction);
    return touch;
}

void HapticMaterial::_bind_methods() {
    ClassDB::bind_method(D_METHOD("set_stiffness", "stiffness"), &HapticMaterial::set_stiffness);
    ClassDB::bind_method(D_METHOD("get_stiffness"), &HapticMaterial::get_stiffness);
    ClassDB::bind_method(D_METHOD("set_damping", "damping"), &HapticMaterial::set_damping);
    ClassDB::bind_method(D_METHOD("get_damping"), &HapticMaterial::get_damping);
    ClassDB::bind_method(D_METHOD("set_static_friction", "friction"), &HapticMaterial::set_static_friction);
    ClassDB::bind_method(D_METHOD("get_static_friction"), &HapticMaterial::get_static_friction);
    ClassDB::bind_method(D_METHOD("set_dynamic_friction", "friction"), &HapticMaterial::set_dynamic_friction);
    ClassDB::bind_method(D_METHOD("get_dynamic_friction"), &HapticMaterial::get_dynamic_friction);

    ADD_GROUP("Touch", "");
    ADD_PROPERTY(PropertyInfo(Variant::FLOAT, "stiffness", PROPERTY_HINT_RANGE, "0,5000,1,or_greater,suffix:N/m"),
                 "set_stiffness", "get_stiffness");
    ADD_PROPERTY(PropertyInfo(Variant::FLOAT, "damping", PROPERTY_HINT_RANGE, "0,20,0.01,or_greater,suffix:N·s/m"),
                 "set_damping", "get_damping");
    ADD_PROPERTY(PropertyInfo(Variant::FLOAT, "static_friction", PROPERTY_HINT_RANGE, "0,2,0.01,or_greater"),
                 "set_static_friction", "get_static_friction");
    ADD_PROPERTY(PropertyInfo(Variant::FLOAT, "dynamic_friction", PROPERTY_HINT_RANGE, "0,2,0.01,or_greater"),
                 "set_dynamic_friction", "get_dynamic_friction");
}

}  // namespace tactus
