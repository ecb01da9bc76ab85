#include "nodes/ghost_view.hpp"

#include <algorithm>
#include <godot_cpp/classes/sphere_mesh.hpp>

#include "nodes/conversions.hpp"
#include "nodes/mesh_drawing.hpp"
#include "nodes/tree_walk.hpp"

namespace tactus {

using namespace godot;

namespace {

const Color ghost_color(0.55f, 0.75f, 0.55f, 0.6f);

MeshInstance3D* make_picture(Node& parent) {
    Ref<SphereMesh> ball;
    ball.instantiate();
    ball->set_radius(1.0f);
    ball->set_height(2.0f);
    return add_picture(parent, Ref<Mesh>(ball), see_through_material(ghost_color));
}

}  // namespace

void GhostView::show(Node& parent, const SeenGhosts& ghosts) {
    pictures_.resize(std::max(pictures_.size(), ghosts.count));
    for (std::size_t i = 0; i < pictures_.size(); ++i) {
        const bool is_there = i < ghosts.count;
        auto* picture = node_of_id<MeshInstance3D>(pictures_[i]);
        if (picture == nullptr && is_there) {
            picture = make_picture(parent);
            pictures_[i] = picture->get_instance_id();
        }
        if (picture == nullptr) {
            continue;
        }
        if (is_there) {
            const auto size = static_cast<real_t>(ghosts.ghosts[i].radius);
            picture->set_global_transform(Transform3D(Basis::from_scale(Vector3(size, size, size)),
                                                      to_godot(ghosts.ghosts[i].position)));
        }
        picture->set_visible(is_there);  // last: whoever is told may free it
    }
}

}  // namespace tactus
