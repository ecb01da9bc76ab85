#include "nodes/haptic_soft_body.hpp"

#include <algorithm>
#include <glm/matrix.hpp>
#include <godot_cpp/classes/rigid_body3d.hpp>
#include <utility>

#include "core/soft/soft_model.hpp"
#include "nodes/body_parts.hpp"
#include "nodes/body_reading.hpp"
#include "nodes/conversions.hpp"
#include "nodes/haptic_world.hpp"
#include "nodes/mesh_drawing.hpp"
#include "nodes/mesh_source.hpp"
#include "nodes/messages.hpp"

namespace tactus {

using namespace godot;

namespace {

const Color flesh(0.86f, 0.52f, 0.46f);

std::vector<std::uint32_t> as_indices(const PackedInt32Array& from) {
    std::vector<std::uint32_t> to(static_cast<std::size_t>(from.size()));
    std::transform(from.ptr(), from.ptr() + from.size(), to.begin(),
                   [](std::int32_t index) { return static_cast<std::uint32_t>(index); });
    return to;
}

}  // namespace

void HapticSoftBody::form_changed() {
    plan_.reset();
    note_part_changed();
    update_configuration_warnings();
}

void HapticSoftBody::look_changed() {
    if (picture_ != nullptr) {
        Ref<StandardMaterial3D> plain = lit_material(flesh);
        plain->set_cull_mode(form_ == SoftDescription::Form::sheet ? BaseMaterial3D::CULL_DISABLED
                                                                   : BaseMaterial3D::CULL_BACK);
        picture_->set_material_override(look_.is_valid() ? look_ : Ref<Material>(plain));
    }
}

SoftDescription HapticSoftBody::described() const {
    SoftDescription description;
    description.form = form_;
    if (tetrahedra_.is_empty() && mesh_.is_valid()) {
        description.source = source_of(mesh_);
    }
    description.points = from_godot(points_);
    const std::vector<std::uint32_t> corners = as_indices(tetrahedra_);
    for (std::size_t i = 0; i + 3 < corners.size(); i += 4) {
        description.tetrahedra.push_back({corners[i], corners[i + 1], corners[i + 2], corners[i + 3]});
    }
    description.cells = cells_;
    description.material = material_;
    if (held_.size != Vector3()) {
        description.held.low = from_godot(held_.position);
        description.held.high = from_godot(held_.position + held_.size);
    }
    description.held.vertices = as_indices(held_vertices_);
    const HapticWorld* world = HapticWorld::above(this);
    description.seconds = world != nullptr ? world->tick_seconds() : description.seconds;
    return description;
}

std::shared_ptr<SoftPlan> HapticSoftBody::plan(const SceneFrame& body_scale) const {
    const SceneFrame frame = compose(body_scale, frame_of(get_transform()));
    const HapticWorld* world = HapticWorld::above(this);
    const double seconds = world != nullptr ? world->tick_seconds() : SoftDescription{}.seconds;
    if (plan_ == nullptr || !plan_->is_for(frame, seconds)) {
        SoftDescription description = described();
        description.frame = frame;
        if (glm::determinant(body_scale.axes) < 0.0) {
            // The body's pose is that of the mirrored frame turned about its origin by what mirrors it.
            description.held.low = -std::exchange(description.held.high, -description.held.low);
        }
        plan_ = std::make_shared<SoftPlan>(std::move(description));
    }
    return plan_;
}

SceneFrame HapticSoftBody::scale_of_body() const {
    const auto* body = Object::cast_to<Node3D>(get_parent());
    const bool is_placed = body != nullptr && body->is_inside_tree();
    return {is_placed ? scaling_of(frame_of(body->get_global_transform())) : Mat3(1.0)};
}

String HapticSoftBody::problem() const {
    if (!is_solid_body(get_parent()) || Object::cast_to<RigidBody3D>(get_parent()) != nullptr) {
        return "it belongs to no body that stays where it is put: make it a child of a StaticBody3D or an "
               "AnimatableBody3D";
    }
    return problem_of_part(*this);
}

String HapticSoftBody::get_problem() const {
    const String unfelt = problem();
    return unfelt.is_empty() ? to_godot(plan(scale_of_body())->built().error) : unfelt;
}

int HapticSoftBody::get_element_count() const {
    const SoftPlan::Built built = plan(scale_of_body())->built();
    return built.model != nullptr ? static_cast<int>(built.model->element_count) : 0;
}

PackedVector3Array HapticSoftBody::get_surface() const {
    const SoftPlan::Built built = plan(scale_of_body())->built_so_far();
    if (built.view == nullptr) {
        return PackedVector3Array();
    }
    built.view->refresh();
    return packed(built.view->places());
}

PackedStringArray HapticSoftBody::_get_configuration_warnings() const {
    PackedStringArray warnings;
    warn(warnings, "This HapticSoftBody is not felt", problem());
    warn(warnings, "This HapticSoftBody cannot give", to_godot(plan(scale_of_body())->built().error));
    return warnings;
}

// What is felt is what is drawn: the surface of the last tick, in the frame of the body.
void HapticSoftBody::show() {
    const SoftPlan::Built built = plan(scale_of_body())->built_so_far();
    const auto* body = Object::cast_to<Node3D>(get_parent());
    if (built.view == nullptr || body == nullptr) {
        return;
    }
    if (picture_ == nullptr) {
        picture_ = add_picture(*this, Ref<Mesh>(), Ref<Material>());
        picture_->set_cast_shadows_setting(GeometryInstance3D::SHADOW_CASTING_SETTING_ON);
        picture_->set_as_top_level(true);
        look_changed();
    }
    picture_->set_global_transform(to_godot(pose_of(body->get_global_transform())));
    const bool is_other = shown_ != built.view;
    if (built.view->refresh() || is_other) {
        shown_ = built.view;
        picture_->set_mesh(
            drawn_mesh({{built.view->places(), built.model->surface.triangles}, round_crease}));
    }
}

void HapticSoftBody::_notification(int what) {
    keep_part(*this, what);
    if (what == NOTIFICATION_ENTER_TREE) {
        set_process_internal(true);
        form_changed();
    } else if (what == NOTIFICATION_INTERNAL_PROCESS) {
        show();
    }
}

}  // namespace tactus
