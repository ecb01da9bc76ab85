// What a depth sensor sees and does not know, as one body that can be touched. Main thread only.
#pragma once

#include <godot_cpp/classes/array_mesh.hpp>
#include <godot_cpp/classes/node3d.hpp>
#include <godot_cpp/classes/shape3d.hpp>
#include <godot_cpp/classes/static_body3d.hpp>
#include <godot_cpp/variant/color.hpp>

#include "core/ports/depth_sensing.hpp"

namespace tactus {

// Of what is seen and not known, as points and as a surface.
inline const godot::Color cloud_color(0.2f, 0.75f, 0.9f, 1.0f);

// One that stays where it is put in the world: with this shape at that place of it, and below nobody yet.
godot::StaticBody3D* new_still_body(const char* name, const godot::Ref<godot::Shape3D>& shape,
                                    const godot::Vector3& at = {});

class TouchedCloud {
public:
    // Below `sensor`. From surface to surface only corners move: who touches it is swept along.
    void update(godot::Node3D& sensor, const MeshView& surface, bool is_shown);
    // Takes it away.
    void clear();

private:
    void make(godot::Node3D& sensor, bool is_shown);

    std::uint64_t body_ = 0;
    bool is_shown_ = false;
    godot::Ref<godot::ArrayMesh> mesh_;
};

}  // namespace tactus
