#include "nodes/skin_reading.hpp"

#include <godot_cpp/classes/array_mesh.hpp>
#include <godot_cpp/classes/skeleton3d.hpp>
#include <godot_cpp/classes/skin.hpp>
#include <godot_cpp/classes/skin_reference.hpp>

#include "nodes/conversions.hpp"
#include "nodes/mesh_source.hpp"

namespace tactus {

using namespace godot;

namespace {

template <class Value, class Packed>
std::vector<Value> values_of(const Packed& packed) {
    return {packed.ptr(), packed.ptr() + packed.size()};
}

SkinCollector::Surface surface_of(const Ref<Mesh>& mesh, int32_t index, const SurfaceCorners& corners,
                                  bool are_relative) {
    const Array arrays = mesh->surface_get_arrays(index);
    SkinCollector::Surface surface;
    surface.corners = from_godot(corners.corners);
    surface.indices = values_of<std::int32_t>(corners.indices);
    surface.bones = values_of<std::int32_t>(PackedInt32Array(arrays[Mesh::ARRAY_BONES]));
    surface.weights = values_of<float>(PackedFloat32Array(arrays[Mesh::ARRAY_WEIGHTS]));
    const Array shapes = mesh->surface_get_blend_shape_arrays(index);
    for (int64_t i = 0; i < shapes.size(); ++i) {
        const Array shape = shapes[i];
        std::vector<Vec3> ways = from_godot(PackedVector3Array(shape[Mesh::ARRAY_VERTEX]));
        ways.resize(surface.corners.size(), Vec3(0.0));
        for (std::size_t corner = 0; !are_relative && corner < ways.size(); ++corner) {
            ways[corner] -= surface.corners[corner];
        }
        surface.shapes.push_back(std::move(ways));
    }
    return surface;
}

// Between two nodes through what stands above both, where there is something: what is moved about above them
// leaves no rounding in it.
Transform3D seen_from(Node3D& node, const Node3D& from) {
    const auto up_to = [](const Node3D& start, const Node* end) {
        Transform3D place = start.get_transform();
        for (const Node* above = start.get_parent(); above != end && above != nullptr;
             above = above->get_parent()) {
            if (const auto* frame = Object::cast_to<Node3D>(above)) {
                place = frame->get_transform() * place;
            }
        }
        return place;
    };
    const Node* const common = from.get_parent();
    return common != nullptr && common->is_ancestor_of(&node)
               ? from.get_transform().affine_inverse() * up_to(node, common)
               : from.get_global_transform().affine_inverse() * node.get_global_transform();
}

}  // namespace

std::shared_ptr<const SkinnedMesh> skinned_mesh_of(const Ref<Mesh>& mesh) {
    SkinCollector collector;
    const auto* arrays = Object::cast_to<ArrayMesh>(mesh.ptr());
    const bool are_relative =
        arrays != nullptr && arrays->get_blend_shape_mode() == Mesh::BLEND_SHAPE_MODE_RELATIVE;
    for (int32_t i = 0; i < mesh->get_surface_count(); ++i) {
        if (const std::optional<SurfaceCorners> corners = corners_of(mesh, i)) {
            collector.add(surface_of(mesh, i, *corners, are_relative));
        }
    }
    auto skinned = std::make_shared<SkinnedMesh>(collector.take());
    return skinned->rest.triangles.empty() ? nullptr : skinned;
}

SkinPose skin_pose_of(MeshInstance3D& instance, const Node3D& from) {
    SkinPose pose;
    pose.place = frame_of(seen_from(instance, from));
    for (int32_t i = 0; i < instance.get_blend_shape_count(); ++i) {
        pose.shapes.push_back(instance.get_blend_shape_value(i));
    }
    const auto* skeleton =
        Object::cast_to<Skeleton3D>(instance.get_node_or_null(instance.get_skeleton_path()));
    const Ref<SkinReference> reference = instance.get_skin_reference();
    const Ref<Skin> skin = reference.is_valid() ? reference->get_skin() : Ref<Skin>();
    if (skeleton == nullptr || skin.is_null()) {
        return pose;
    }
    for (int32_t i = 0; i < skin->get_bind_count(); ++i) {
        const int32_t named = skin->get_bind_bone(i);
        const int32_t bone = named >= 0 ? named : skeleton->find_bone(skin->get_bind_name(i));
        pose.bones.push_back(bone >= 0 && bone < skeleton->get_bone_count()
                                 ? frame_of(skeleton->get_bone_global_pose(bone) * skin->get_bind_pose(i))
                                 : SceneFrame());
    }
    return pose;
}

}  // namespace tactus
