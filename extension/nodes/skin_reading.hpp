// Godot's skinned meshes as numbers (world/skinned_mesh.hpp). Main thread only.
#pragma once

#include <godot_cpp/classes/mesh_instance3d.hpp>
#include <memory>

#include "world/skinned_mesh.hpp"

namespace tactus {

// Its corners, what they follow and how its blend shapes move them: all that stays. Null where it has no
// triangles.
std::shared_ptr<const SkinnedMesh> skinned_mesh_of(const godot::Ref<godot::Mesh>& mesh);

// As it is drawn now, in the frame of `seen_from`.
SkinPose skin_pose_of(godot::MeshInstance3D& instance, const godot::Node3D& seen_from);

}  // namespace tactus
