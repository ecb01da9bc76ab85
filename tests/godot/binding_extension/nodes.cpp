#include "nodes.hpp"

#include <godot_cpp/variant/callable_method_pointer.hpp>
#include <godot_cpp/variant/utility_functions.hpp>

using namespace godot;

namespace probe {

void BindingNode::_process(double delta) {
    process_delta_ = delta;
}

void BindingNode::_physics_process(double delta) {
    physics_delta_ = delta;
}

void BindingNode::_input(const Ref<InputEvent>& event) {
    note(("input " + event->get_class()).utf8().get_data());
}

PackedStringArray BindingNode::_get_configuration_warnings() const {
    PackedStringArray warnings = Node3D::_get_configuration_warnings();
    if (stiffness_ < 0.0) {
        warnings.push_back("The stiffness is negative: set it to 0 or more.");
    }
    return warnings;
}

void BindingNode::set_stiffness(double value) {
    const double before = stiffness_;
    stiffness_ = value;
    emit_signal("stiffness_changed", before, value);
}

void BindingNode::watch(Object* object) {
    watched_ = object;
}

bool BindingNode::is_watched_alive() const {
    return watched_.get_validated_object() != nullptr;
}

void BindingNode::on_signal(int64_t count, const String& what) {
    note((itos(count) + " " + what).utf8().get_data());
}

void BindingNode::connect_to(Object* source, const StringName& signal) {
    source->connect(signal, callable_mp(this, &BindingNode::on_signal));
}

void BindingNode::disconnect_from(Object* source, const StringName& signal) {
    source->disconnect(signal, callable_mp(this, &BindingNode::on_signal));
}

bool BindingNode::is_connected_to(Object* source, const StringName& signal) const {
    return source->is_connected(signal, callable_mp(const_cast<BindingNode*>(this), &BindingNode::on_signal));
}

void BindingNode::_notification(int what) {
    if (what == NOTIFICATION_POSTINITIALIZE) {
        note("postinitialize");
    } else if (what == NOTIFICATION_PARENTED) {
        note("parented");
    }
}

bool BindingNode::_set(const StringName& name, const Variant& value) {
    if (name == StringName("extra")) {
        extra_ = value;
        return true;
    }
    return false;
}

bool BindingNode::_get(const StringName& name, Variant& value) const {
    if (name == StringName("extra")) {
        value = extra_;
        return true;
    }
    return false;
}

void BindingNode::_get_property_list(List<PropertyInfo>* properties) const {
    properties->push_back(PropertyInfo(Variant::INT, "extra", PROPERTY_HINT_RANGE, "0,10"));
}

bool BindingNode::_property_can_revert(const StringName& name) const {
    return name == StringName("extra");
}

bool BindingNode::_property_get_revert(const StringName& name, Variant& value) const {
    value = 3;
    return name == StringName("extra");
}

void BindingNode::_validate_property(PropertyInfo& property) const {
    if (property.name == StringName("material") && mode_ == MODE_OFF) {
        property.usage = PROPERTY_USAGE_NO_EDITOR;
    }
}

void BindingNode::_bind_methods() {
    ClassDB::bind_method(D_METHOD("set_stiffness", "stiffness"), &BindingNode::set_stiffness);
    ClassDB::bind_method(D_METHOD("get_stiffness"), &BindingNode::get_stiffness);
    ClassDB::bind_method(D_METHOD("set_mode", "mode"), &BindingNode::set_mode);
    ClassDB::bind_method(D_METHOD("get_mode"), &BindingNode::get_mode);
    ClassDB::bind_method(D_METHOD("set_material", "material"), &BindingNode::set_material);
    ClassDB::bind_method(D_METHOD("get_material"), &BindingNode::get_material);
    ClassDB::bind_method(D_METHOD("set_part", "index", "value"), &BindingNode::set_part);
    ClassDB::bind_method(D_METHOD("get_part", "index"), &BindingNode::get_part);
    ClassDB::bind_method(D_METHOD("get_notes"), &BindingNode::get_notes);
    ClassDB::bind_method(D_METHOD("get_seen_delta"), &BindingNode::get_seen_delta);
    ClassDB::bind_method(D_METHOD("watch", "object"), &BindingNode::watch);
    ClassDB::bind_method(D_METHOD("is_watched_alive"), &BindingNode::is_watched_alive);
    ClassDB::bind_method(D_METHOD("get_watched"), &BindingNode::get_watched);
    ClassDB::bind_method(D_METHOD("connect_to", "source", "signal"), &BindingNode::connect_to);
    ClassDB::bind_method(D_METHOD("disconnect_from", "source", "signal"), &BindingNode::disconnect_from);
    ClassDB::bind_method(D_METHOD("is_connected_to", "source", "signal"), &BindingNode::is_connected_to);
    ClassDB::bind_static_method("BindingNode", D_METHOD("count_alive"), &BindingNode::count_alive);

    ADD_PROPERTY(PropertyInfo(Variant::FLOAT, "stiffness", PROPERTY_HINT_RANGE, "0,5000,1,suffix:N/m"),
                 "set_stiffness", "get_stiffness");
    ADD_GROUP("Look", "look_");
    ADD_SUBGROUP("Fine", "look_fine_");
    ADD_PROPERTY(PropertyInfo(Variant::INT, "look_fine_mode", PROPERTY_HINT_ENUM, "Off,On"), "set_mode",
                 "get_mode");
    ADD_GROUP("", "");
    ADD_PROPERTY(PropertyInfo(Variant::OBJECT, "material", PROPERTY_HINT_RESOURCE_TYPE, "PhysicsMaterial"),
                 "set_material", "get_material");
    ADD_PROPERTYI(PropertyInfo(Variant::FLOAT, "first_part"), "set_part", "get_part", 0);
    ADD_PROPERTYI(PropertyInfo(Variant::FLOAT, "second_part"), "set_part", "get_part", 1);
    ADD_SIGNAL(MethodInfo("stiffness_changed", PropertyInfo(Variant::FLOAT, "before"),
                          PropertyInfo(Variant::FLOAT, "after")));
    BIND_ENUM_CONSTANT(MODE_OFF);
    BIND_ENUM_CONSTANT(MODE_ON);
    BIND_CONSTANT(NOTIFICATION_READY);
}

void BindingDerived::_ready() {
    BindingNode::_ready();
    note("derived ready");
}

void BindingDerived::_notification(int what) {
    if (what == NOTIFICATION_PARENTED) {
        note("derived parented");
    }
}

void BindingDerived::_bind_methods() {
    ClassDB::bind_method(D_METHOD("own"), &BindingDerived::own);
}

Ref<BindingMaterial> BindingMaterial::make(double softness) {
    Ref<BindingMaterial> material;
    material.instantiate();
    material->set_softness(softness);
    return material;
}

int64_t BindingMaterial::references_gained(const Ref<BindingMaterial>& material) {
    const int64_t before = material->get_reference_count();
    for (int round = 0; round < 100; ++round) {
        const Ref<Resource> base = material;
        const Variant variant = base;
        const Ref<BindingMaterial> back = variant;
        Array array;
        array.push_back(back);
        Ref<BindingMaterial> moved = std::move(array[0]);
        Ref<BindingMaterial> assigned;
        assigned = moved;
        assigned = assigned;
        moved.unref();
    }
    return material->get_reference_count() - before;
}

Array BindingMesh::_create_mesh_array() const {
    Array surface;
    surface.resize(ARRAY_MAX);
    surface[ARRAY_VERTEX] = PackedVector3Array{Vector3(0, 0, 0), Vector3(1, 0, 0), Vector3(0, 2, 0)};
    return surface;
}

void BindingMaterial::_bind_methods() {
    ClassDB::bind_method(D_METHOD("set_softness", "softness"), &BindingMaterial::set_softness);
    ClassDB::bind_method(D_METHOD("get_softness"), &BindingMaterial::get_softness);
    ClassDB::bind_method(D_METHOD("set_curve", "curve"), &BindingMaterial::set_curve);
    ClassDB::bind_method(D_METHOD("get_curve"), &BindingMaterial::get_curve);
    ClassDB::bind_static_method("BindingMaterial", D_METHOD("count_alive"), &BindingMaterial::count_alive);
    ClassDB::bind_static_method("BindingMaterial", D_METHOD("make", "softness"), &BindingMaterial::make);
    ClassDB::bind_static_method("BindingMaterial", D_METHOD("references_gained", "material"),
                                &BindingMaterial::references_gained);
    ADD_PROPERTY(PropertyInfo(Variant::FLOAT, "softness", PROPERTY_HINT_RANGE, "0,1"), "set_softness",
                 "get_softness");
    ADD_PROPERTY(PropertyInfo(Variant::PACKED_VECTOR2_ARRAY, "curve"), "set_curve", "get_curve");
}

}  // namespace probe
