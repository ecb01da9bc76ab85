#pragma once

#include <godot_cpp/classes/mesh.hpp>
#include <godot_cpp/classes/node3d.hpp>
#include <godot_cpp/variant/node_path.hpp>
#include <memory>
#include <optional>
#include <string>

#include "nodes/body_parts.hpp"
#include "nodes/haptic_material.hpp"
#include "nodes/haptic_volume.hpp"
#include "nodes/mesh_library.hpp"
#include "nodes/properties.hpp"
#include "nodes/shape_reading.hpp"
#include "world/skinned_mesh.hpp"
#include "world/surface_feels.hpp"

namespace tactus {

// As a child of a body: touch this mesh instead of the body's collision shapes. The body keeps colliding with
// other bodies by its own shapes; where it has none, the mesh serves for that, too.
class HapticMesh : public godot::Node3D {
    GDCLASS(HapticMesh, godot::Node3D)

public:
    TACTUS_PROPERTIES(HapticMesh)

    double get_library_mass() const { return entry().mass; }
    godot::String get_library_source() const { return entry().source; }
    static godot::PackedStringArray get_library_names();
    static godot::Ref<godot::Mesh> create_library_mesh(const godot::String& name);

    godot::PackedStringArray _get_configuration_warnings() const override;

    // Why nobody touches it, whatever its triangles are; empty where somebody can.
    godot::String problem() const;
    // The surface in the frame of the body it belongs to; `body_scale` is what the body's own frame leaves
    // out. Whether its triangles are sound shows when they are built.
    // With texture coordinates where the body's material asks for them, or one of its own does.
    ShapeReading read(const SceneFrame& body_scale, bool by_uv = false) const;

    // Takes over how `mesh_instance` is drawn now.
    void follow_instance();

    // What its surfaces feel like where they are not as the body; none: all are.
    SurfaceFeels surface_feels() const;
    std::vector<godot::Ref<HapticMaterial>> surface_materials() const;  // null: as the body

    // Whether a rigid body takes its mass from here, and how much at this scale of the body (unit:
    // kilograms).
    bool is_giving_mass() const {
        return use_library_mass_ && mesh_.is_null() && field_.is_null() && entry().mass > 0.0;
    }
    double library_mass(const Mat3& body_scale) const;

protected:
    static void _bind_methods();
    void _notification(int what);
    void _validate_property(godot::PropertyInfo& property) const;

private:
    // Null where nothing is named; a source with an error where it cannot be read.
    std::shared_ptr<TriangleSource> source() const;
    bool is_following() const { return mesh_.is_null() && field_.is_null() && !mesh_instance_.is_empty(); }
    void instance_changed();
    void followed_changed();
    std::shared_ptr<const SurfaceMap> surfaces(const SurfaceFeels& feels, bool by_uv) const;
    const LibraryEntry& entry() const;
    godot::String problem_of_surfaces() const;
    void mesh_changed();
    void library_changed();
    void form_changed() { note_part_changed(); }
    void forget_triangles();

    godot::Ref<godot::Mesh> mesh_;
    godot::Ref<HapticVolume> field_;
    godot::NodePath mesh_instance_;
    godot::String library_mesh_;
    double smoothing_angle_ = 0.0;  // (unit: radians)
    bool one_sided_ = false;
    godot::Array surface_materials_;
    bool use_library_mass_ = false;
    mutable std::optional<LibraryEntry> entry_;  // of the library's mesh, looked up once
    mutable OwnSource source_;                   // read once, when somebody asks
    // What it follows, as it was when it was looked at last.
    godot::Ref<godot::Mesh> followed_;
    std::shared_ptr<const SkinnedMesh> skin_;
    SkinPose pose_;
    mutable std::shared_ptr<const SurfaceMap> surfaces_;  // likewise, with what was asked for last
};

}  // namespace tactus
