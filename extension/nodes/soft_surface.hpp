// The surface of a SoftBody3D as Godot's own physics has it in a frame, and what hands give it. Main thread,
// in a physics frame.
//
// Godot moves the vertices once a frame, and tells neither of the forces between them nor of those of a
// contact. So a hand feels the surface where it is, by a spring of its own, and gives what it feels to the
// vertices around the contact. This spring acts on a light mass, late by a frame of T seconds: it is stable
// up to about m / (4 T^2), and never stiffer than that.
#pragma once

#include <cstdint>
#include <godot_cpp/classes/mesh_instance3d.hpp>
#include <godot_cpp/variant/rid.hpp>
#include <memory>
#include <string>
#include <vector>

#include "world/body_form.hpp"

namespace tactus {

class SoftSurface {
public:
    // `body` is a SoftBody3D.
    explicit SoftSurface(godot::MeshInstance3D& body);

    // Whether that has the same mesh as when it was read. Godot puts a copy in the place of the one that was
    // set, which is the same.
    bool is_of(const godot::MeshInstance3D& body);
    // It is not felt any more, and says why.
    void refuse(std::string why) { problem_ = std::move(why); }
    // Within `radius` of a hand (unit: meters), or not to be felt at all, which is said.
    bool is_close(std::span<const Vec3> hands, double radius) const;
    // It comes close, and is read for the first time since.
    void come_close();
    // Reads where the vertices are now; whether any has moved since the last time.
    bool read();
    // As of the last time, in a frame that stands at place().
    BodyForm form() const;
    const Vec3& place() const { return place_; }

    std::uint32_t layer() const;
    std::uint32_t mask() const;
    // The spring and damper of a hand on it, where a frame takes so long.
    void soften(TouchMaterial& touch, double frame_seconds) const;

    // Godot's physics is to push it about `point` in its next step (units: meters and newton seconds, in the
    // world).
    void push(const Vec3& point, const Vec3& impulse);

private:
    bool is_in_physics() const;
    void read_mesh(const godot::MeshInstance3D& body);
    void place_triangles();
    std::size_t patch_size() const;
    double vertex_mass() const;  // (unit: kilograms)

    std::uint64_t owner_, mesh_;
    godot::RID rid_;
    Vec3 place_{0.0};
    std::string problem_;                      // why it cannot be felt; empty: it can
    std::int64_t corner_count_ = 0;            // of Godot's mesh
    std::vector<std::int32_t> corners_;        // by vertex: its first corner there
    std::shared_ptr<const TriangleMesh> now_;  // in the world
    OwnSource source_;
};

// Whether the node is a SoftBody3D.
bool is_soft_body(const godot::Node& node);

}  // namespace tactus
