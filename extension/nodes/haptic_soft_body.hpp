#pragma once

#include <godot_cpp/classes/material.hpp>
#include <godot_cpp/classes/mesh.hpp>
#include <godot_cpp/classes/mesh_instance3d.hpp>
#include <godot_cpp/classes/node3d.hpp>
#include <godot_cpp/core/binder_common.hpp>
#include <godot_cpp/variant/aabb.hpp>
#include <godot_cpp/variant/packed_int32_array.hpp>
#include <godot_cpp/variant/packed_vector3_array.hpp>
#include <memory>
#include <string>

#include "nodes/properties.hpp"
#include "world/soft_plan.hpp"

namespace tactus {

// As a child of a body: its mesh gives under what touches it, as a volume or as a sheet, and is drawn so.
class HapticSoftBody : public godot::Node3D {
    GDCLASS(HapticSoftBody, godot::Node3D)

public:
    TACTUS_PROPERTIES(HapticSoftBody)

    godot::String get_problem() const;
    godot::PackedVector3Array get_surface() const;
    int get_element_count() const;

    godot::PackedStringArray _get_configuration_warnings() const override;

    // Why nobody touches it, whatever it is made of; empty where somebody can.
    godot::String problem() const;
    // The body's own scale is what `body_scale` says. Whether it can be built shows when it is.
    std::shared_ptr<SoftPlan> plan(const SceneFrame& body_scale) const;

protected:
    static void _bind_methods();
    void _notification(int what);

private:
    SoftDescription described() const;
    SceneFrame scale_of_body() const;
    void form_changed();
    void look_changed();
    void show();

    godot::Ref<godot::Mesh> mesh_;
    godot::PackedVector3Array points_;
    godot::PackedInt32Array tetrahedra_;
    SoftDescription::Form form_ = SoftDescription::Form::volume;
    int cells_ = 8;
    SoftMaterial material_;
    godot::AABB held_;
    godot::PackedInt32Array held_vertices_;
    godot::Ref<godot::Material> look_;
    mutable std::shared_ptr<SoftPlan> plan_;  // null: another one is to be made when somebody asks
    std::shared_ptr<SoftView> shown_;         // that is drawn
    godot::MeshInstance3D* picture_ = nullptr;
};

}  // namespace tactus
