#include "nodes/haptic_tool.hpp"

#include <glm/gtc/quaternion.hpp>

#include "nodes/conversions.hpp"
#include "nodes/haptic_world.hpp"
#include "nodes/mesh_source.hpp"
#include "nodes/messages.hpp"
#include "nodes/roll.hpp"
#include "nodes/scene_warnings.hpp"
#include "nodes/tree_walk.hpp"
#include "realtime/workers.hpp"
#include "world/scene_hand.hpp"

namespace tactus {

using namespace godot;

namespace {

// As Node3D.rotation turns in its default order: about z, then x, then y.
Quat turned_by(const Vec3& angles) {
    return glm::angleAxis(angles.y, Vec3(0.0, 1.0, 0.0)) * glm::angleAxis(angles.x, Vec3(1.0, 0.0, 0.0)) *
           glm::angleAxis(angles.z, Vec3(0.0, 0.0, 1.0));
}

}  // namespace

void HapticTool::mesh_changed() {
    sampling_.reset();
    show_mesh();
    update_configuration_warnings();
}

// The job owns what it works on: the node, its mesh and its world may be gone when it ends.
void HapticTool::make_shape(bool waits) {
    if (sampling_ != nullptr || mesh_.is_null()) {
        return;
    }
    sampling_ = std::make_shared<Sampling>();
    const auto make = [sampling = sampling_, source = source_of(mesh_), settings = sampling_settings_] {
        const TriangleSource::Checked& triangles = source->triangles();
        sampling->result = triangles.mesh != nullptr ? make_tool_shape(triangles.mesh, settings)
                                                     : ToolShapeResult{nullptr, triangles.error};
        sampling->is_done.store(true, std::memory_order_release);
    };
    if (waits) {
        make();
    } else {
        Workers::shared().add(make);
    }
}

std::shared_ptr<const ToolShape> HapticTool::shape() const {
    const bool is_done = sampling_ != nullptr && sampling_->is_done.load(std::memory_order_acquire);
    return is_done ? sampling_->result.shape : nullptr;
}

String HapticTool::problem_of_shape() const {
    const bool is_done = sampling_ != nullptr && sampling_->is_done.load(std::memory_order_acquire);
    return is_done ? to_godot(sampling_->result.error) : String();
}

int64_t HapticTool::get_sphere_count() const {
    const auto made = shape();
    return made != nullptr ? static_cast<int64_t>(made->spheres.size()) : 0;
}

double HapticTool::get_sampling_error() const {
    const auto made = shape();
    return made != nullptr ? made->tolerance : 0.0;
}

String HapticTool::problem() const {
    if (const String wrong = device_.problem(*this); !wrong.is_empty()) {
        return wrong;
    }
    if (mesh_.is_null()) {
        return "it has no mesh: set 'mesh' to a closed one";
    }
    return settings_.mask == 0
               ? String("its 'collision_mask' is empty, so it touches nothing: set a layer in it")
               : String();
}

String HapticTool::hindrance() const {
    return state_.handle != no_handle && has(tool_wrist_loose)
               ? String(
                     "its robot turns and has no motors that hold it, so it does not move: use one that "
                     "gives a torque, or one that does not turn")
               : String();
}

HapticTool::State HapticTool::get_state() const {
    return state_of<State>(!problem().is_empty() || !problem_of_shape().is_empty(), is_present(),
                           HapticWorld::of(this) != nullptr);
}

String HapticTool::get_state_text() const {
    for (const String& wrong : {problem(), problem_of_shape()}) {
        if (!wrong.is_empty()) {
            return wrong;
        }
    }
    if (is_edited()) {
        return String();
    }
    if (HapticWorld::of(this) == nullptr) {
        return "no HapticWorld is running: put one into the scene, best above this node";
    }
    return shape() == nullptr ? String("its spheres are being made") : to_godot(state_of_tool(state_));
}

PackedStringArray HapticTool::_get_configuration_warnings() const {
    PackedStringArray warnings;
    if (is_inside_tree()) {
        for (const String& wrong : {problem(), problem_without_world(*this), problem_of_shape()}) {
            warn(warnings, "This HapticTool cannot touch", wrong);
        }
    }
    if (const HapticWorld* world = HapticWorld::above(this)) {
        warn(warnings, "This HapticTool feels a surface in part",
             problem_of_tool_surfaces(*world, settings_.mask));
    }
    if (guide_.is_valid()) {
        warn(warnings, "This guide has no effect", guide_->get_problem());
    }
    return warnings;
}

ToolUse HapticTool::use(SessionHandle device) const {
    ToolUse use;
    use.device = device;
    use.settings = settings_;
    use.grasp = {grasp_position_, turned_by(grasp_rotation_)};
    use.enabled = enabled_;
    if (guide_.is_valid()) {
        use.aids.add(guide_->guide(Transform3D()));
    }
    return use;
}

void HapticTool::take_state(const ToolState& state, const Touched::Ids& bodies) {
    state_ = state;
    touched_.take(*this, bodies);
    if (is_present() && has_places(get_parent_node_3d())) {
        set_global_transform(to_godot(state.pose));
    }
    told_.tell(*this);
}

void HapticTool::clear_state() {
    if (state_.handle == no_handle) {
        return;
    }
    state_ = {};
    touched_.take(*this, {});
    told_.tell(*this);
}

void HapticTool::clear_force() {
    state_.force = Vec3(0.0);
    state_.torque = Vec3(0.0);
}

void HapticTool::show_mesh() {
    if (!is_inside_tree()) {
        return;
    }
    if (picture_ == nullptr) {
        picture_ = memnew(MeshInstance3D);
        add_child(picture_, false, INTERNAL_MODE_FRONT);
    }
    picture_->set_mesh(mesh_);
    picture_->set_visible(show_tool_);
}

void HapticTool::_notification(int what) {
    keep_roll(*this, what);
    if (what == NOTIFICATION_ENTER_TREE) {
        show_mesh();
        if (is_edited()) {
            make_shape(false);
        }
    } else if (what == NOTIFICATION_EXIT_TREE) {
        clear_state();
    }
}

}  // namespace tactus
