#include "nodes/synthetic_view.hpp"

#include <algorithm>
#include <godot_cpp/core/object.hpp>

#include "nodes/conversions.hpp"
#include "nodes/mesh_source.hpp"
#include "nodes/tree_walk.hpp"
#include "platform/clock.hpp"

namespace tactus {

using namespace godot;

namespace {

// A walk through the scene is not for every frame.
constexpr int looks_for_others = 30;

// Of the mesh as it is drawn, in a frame that neither scales nor shears.
TriangleMesh drawn_triangles(MeshInstance3D& drawn) {
    const std::shared_ptr<const TriangleMesh> mesh = source_of(drawn.get_mesh())->triangles().mesh;
    return mesh != nullptr ? scaled(*mesh, scaling_of(frame_of(drawn.get_global_transform())))
                           : TriangleMesh{};
}

}  // namespace

// With `root` itself, as far as there is room.
void SyntheticView::collect(Node& root, const Node* without, std::vector<MeshInstance3D*>& found) {
    const auto visit = [&](Node& node) {
        if (&node == without) {
            return Walk::past;
        }
        auto* const drawn = Object::cast_to<MeshInstance3D>(&node);
        if (drawn != nullptr && drawn->get_mesh().is_valid() && drawn->is_visible_in_tree() &&
            found.size() < max_shown_bodies) {
            found.push_back(drawn);
        }
        return Walk::on;
    };
    if (visit(root) == Walk::on) {
        walk_below(root, visit);
    }
}

std::string SyntheticView::begin(const DepthSensing& sensing, const SyntheticCamera& camera, Node& root,
                                 const Node& without) {
    end();
    std::vector<MeshInstance3D*> drawn;
    collect(root, &without, drawn);
    root_ = root.get_instance_id();
    without_ = without.get_instance_id();
    std::vector<TriangleMesh> meshes;
    for (MeshInstance3D* const one : drawn) {
        meshes.push_back(drawn_triangles(*one));
        shown_.push_back({one->get_instance_id(), one->get_mesh()->get_instance_id()});
    }
    std::vector<MeshView> views;
    for (const TriangleMesh& mesh : meshes) {
        views.push_back({mesh.vertices, mesh.triangles});
    }
    scene_.reset(sensing.make_scene(camera, views));
    if (scene_ == nullptr || scene_->uri()[0] == '\0') {
        const std::string why = scene_ != nullptr ? scene_->error() : "there is no memory for its scene";
        end();
        return why;
    }
    return meshes.empty() ? "nothing is drawn that the synthetic camera could see: add a MeshInstance3D" : "";
}

void SyntheticView::end() {
    scene_.reset();
    shown_.clear();
}

bool SyntheticView::has_others() const {
    auto* const root = node_of_id<Node>(root_);
    std::vector<MeshInstance3D*> drawn;
    if (root != nullptr && root->is_inside_tree()) {
        collect(*root, node_of_id<Node>(without_), drawn);
    }
    return std::ranges::any_of(drawn, [this](const MeshInstance3D* one) {
        return std::ranges::find(shown_, one->get_instance_id(), &Shown::node) == shown_.end();
    });
}

bool SyntheticView::show(const Pose& camera) {
    if (scene_ == nullptr) {
        return false;
    }
    bodies_.clear();
    bool is_another = ++shows_ % looks_for_others == 0 && has_others();
    for (std::size_t i = 0; i < shown_.size(); ++i) {
        auto* const drawn = node_of_id<MeshInstance3D>(shown_[i].node);
        if (drawn == nullptr || !drawn->is_inside_tree() || drawn->get_mesh().is_null() ||
            drawn->get_mesh()->get_instance_id() != shown_[i].mesh) {
            is_another = true;
        } else if (drawn->is_visible_in_tree()) {
            bodies_.push_back({static_cast<std::uint32_t>(i), pose_of(drawn->get_global_transform())});
        }
    }
    scene_->show(camera, bodies_, static_cast<std::uint64_t>(monotonic_now() / 1000));
    return is_another;
}

void SyntheticView::set_plugged(bool is_plugged) {
    if (scene_ != nullptr) {
        scene_->set_plugged(is_plugged);
    }
}

}  // namespace tactus
