// What a body of a scene is made of, as it was read, and from that to one that the loop can take: triangle
// trees and the rigid body.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "session/session.hpp"
#include "world/body_values.hpp"
#include "world/soft_plan.hpp"
#include "world/triangle_source.hpp"

namespace tactus {

// A mesh whose tree is still to be built, or to be shared with who has built it.
struct MeshDraft {
    std::shared_ptr<TriangleSource> source;
    Mat3 scaling{1.0};          // applied to the triangles
    Pose pose;                  // of the scaled mesh in the body's frame
    double smooth_below = 0.0;  // see MeshShape
    bool one_sided = false;     // likewise
    std::string owner;          // who it is, for what there is to say of the triangles
    std::shared_ptr<const SurfaceMap> surfaces = nullptr;  // of the triangles as they are read
};

struct BodyForm {
    std::vector<PlacedShape> shapes;    // that collide; touched, too, where nothing else is
    std::vector<MeshDraft> meshes;      // likewise
    std::vector<MeshDraft> touched;     // instead of these
    std::shared_ptr<SoftPlan> soft;     // instead of all; null: it does not give
    std::vector<std::string> problems;  // of single shapes; the rest of the body can still be touched
    bool only_touched = false;          // nothing collides with it
    bool touchable = false;             // false: nothing is left to touch, the problems say why
};

bool same_form(const BodyForm& a, const BodyForm& b);
std::string problem_of(const MeshDraft& draft);  // empty where the triangles are sound
// All there are, those of the triangles, too.
std::vector<std::string> problems_of(const BodyForm& form);
// Why a free body of this mass gets another impulse than its hand feels, and what to do; empty where it gets
// the same within 1 %.
// What is said of an inertia that no body has, in place of which possible_inertia() counts; else empty.
std::string problem_of_inertia(const Vec3& inertia);

std::string problem_of_mass(double mass, const TouchMaterial& touch, double tick_seconds);
// Triangles to build trees over, about.
std::size_t triangle_count(const BodyForm& form);

// What a body is made from besides: a change makes it anew.
struct BodyMakings {
    double mass = 1.0;           // (unit: kilograms)
    bool solid_of_mesh = false;  // what is not given below is that of the touched mesh, filled evenly
    Vec3 inertia{0.0};           // zero: that of the shapes (unit: kilogram square meters)
    std::optional<Vec3> center_of_mass;
    bool continuous = false;
    bool can_sleep = true;
    bool textured_by_uv = false;  // its mesh is read with texture coordinates
    std::uint32_t locks = 0;      // bit i: axis i of x, y, z, and of the turns about x, y, z
    bool operator==(const BodyMakings&) const = default;
};

// Where a body is and how it moves.
struct BodyPlace {
    Pose pose;
    Vec3 linear_velocity{0.0};   // (unit: meters per second)
    Vec3 angular_velocity{0.0};  // (unit: radians per second)
};

struct BodyPlan {
    BodyForm form;
    BodyValues values;
    BodyMakings makings;
    BodyPlace place;
    bool may_move = false;
};

struct BuiltBody {
    BodyAddition addition;              // what it was made from
    ReadyBody body;                     // body.error may be empty and the body still none: see `buildable`
    std::vector<std::string> problems;  // of single shapes; the rest of the body can still be touched
    bool buildable = false;
};

// Any thread but the haptic one. Bodies of the same mesh and scale share one tree.
BuiltBody build_body(const BodyPlan& plan, const ParallelRunner& run);

}  // namespace tactus
