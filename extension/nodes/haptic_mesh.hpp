#pragma once

#include <godot_cpp/classes/mesh.hpp>
#include <godot_cpp/classes/node3d.hpp>
#include <memory>
#include <optional>
#include <string>

#include "nodes/shape_reading.hpp"

namespace tactus {

// As a child of a body: touch this mesh instead of the body's collision shapes. The body keeps colliding with
// other bodies by its own shapes; where it has none, the mesh serves for that, too.
class HapticMesh : public godot::Node3D {
    GDCLASS(HapticMesh, godot::Node3D)

public:
    ~HapticMesh() override;

    void set_mesh(const godot::Ref<godot::Mesh>& mesh);
    godot::Ref<godot::Mesh> get_mesh() const { return mesh_; }
    void set_library_mesh(const godot::String& name);
    godot::String get_library_mesh() const { return library_mesh_; }

    // (unit: radians, 0 to pi)
    void set_smoothing_angle(double angle);
    double get_smoothing_angle() const { return smoothing_angle_; }

    void set_one_sided(bool one_sided);
    bool is_one_sided() const { return one_sided_; }

    void set_use_library_mass(bool use);
    bool is_using_library_mass() const { return use_library_mass_; }

    double get_library_mass() const;
    godot::String get_library_source() const;
    static godot::PackedStringArray get_library_names();
    static godot::Ref<godot::Mesh> create_library_mesh(const godot::String& name);

    godot::PackedStringArray _get_configuration_warnings() const override;

    // The surface in the frame of the body it belongs to; `body_scale` is what the body's own frame leaves
    // out. Whether its triangles are sound shows when they are built.
    ShapeReading read(const godot::Basis& body_scale) const;

    // Whether a rigid body takes its mass from here, and how much at this scale of the body (unit:
    // kilograms).
    bool is_giving_mass() const { return use_library_mass_ && mesh_.is_null() && known_mass() > 0.0; }
    double library_mass(const godot::Basis& body_scale) const;

    // Rises whenever any HapticMesh comes, goes, moves in its body or changes its triangles.
    static std::uint64_t changes();

protected:
    static void _bind_methods();
    void _notification(int what);
    void _validate_property(godot::PropertyInfo& property) const;

private:
    // Null where nothing is named; a source with an error where it cannot be read.
    std::shared_ptr<MeshSource> source() const;
    double known_mass() const;
    void resource_changed();
    void forget_triangles();

    godot::Ref<godot::Mesh> mesh_;
    godot::String library_mesh_;
    double smoothing_angle_ = 0.0;
    bool one_sided_ = false;
    bool use_library_mass_ = false;
    mutable std::optional<double> known_mass_;    // of the library's mesh, looked up once
    mutable std::shared_ptr<MeshSource> source_;  // read once, when somebody asks
    mutable std::shared_ptr<MeshSource> former_;  // until then: the one before the mesh changed
};

}  // namespace tactus
