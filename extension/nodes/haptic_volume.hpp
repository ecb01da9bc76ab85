#pragma once

#include <array>
#include <cstdint>
#include <godot_cpp/classes/array_mesh.hpp>
#include <godot_cpp/classes/resource.hpp>
#include <godot_cpp/variant/array.hpp>
#include <godot_cpp/variant/packed_float32_array.hpp>
#include <godot_cpp/variant/vector3i.hpp>
#include <memory>

#include "nodes/messages.hpp"
#include "nodes/properties.hpp"
#include "world/triangle_source.hpp"

namespace tactus {

// A volume of samples that is touched where it has one value.
class HapticVolume : public godot::Resource {
    GDCLASS(HapticVolume, godot::Resource)

public:
    TACTUS_PROPERTIES(HapticVolume)

    godot::String get_problem() const;
    godot::PackedStringArray get_problems() const { return list_of(get_problem()); }
    godot::Ref<godot::ArrayMesh> create_mesh() const;

    // Its triangles, made by the first who asks for them.
    std::shared_ptr<TriangleSource> surface() const;

protected:
    static void _bind_methods();

private:
    struct Samples {
        godot::PackedFloat32Array values;
        std::array<std::uint32_t, 3> size{};
    };

    void samples_changed();
    Samples samples() const;

    godot::PackedFloat32Array values_;
    godot::Array slices_;
    godot::Vector3i size_;
    Vec3 voxel_size_{0.001};  // (unit: meters)
    double iso_value_ = 0.0;
    bool solid_above_ = false;
    mutable OwnSource surface_;  // made when somebody asks
};

}  // namespace tactus
