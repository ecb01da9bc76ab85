#include "world/scene_facts.hpp"

#include <algorithm>
#include <cstdio>
#include <glm/geometric.hpp>

#include "core/geometry/surface_query.hpp"

namespace tactus {

namespace {

constexpr double endless = 1e6;  // (unit: meters)

// Of the largest and the smallest body: beyond these no touch is meant.
constexpr double too_large = 1.0;
constexpr double too_small = 1e-4;

std::string meters(double length) {
    char text[32];
    std::snprintf(text, sizeof(text), "%.4g m", length);
    return text;
}

}  // namespace

void SceneFacts::add(std::uint32_t layers_of_body, double reach) {
    ++bodies;
    layers |= layers_of_body;
    if (reach > 0.0 && reach < endless) {
        smallest = largest > 0.0 ? std::min(smallest, reach) : reach;
        largest = std::max(largest, reach);
    }
}

std::string problem_of_fingertip(double radius, std::uint32_t mask, const SceneFacts& facts) {
    if (mask == 0) {
        return "its 'collision_mask' is empty, so it touches nothing: set a layer in it";
    }
    if (facts.bodies == 0) {
        return {};
    }
    if ((mask & facts.layers) == 0) {
        return "its 'collision_mask' has no layer that a body of its world is in, so it touches nothing: set "
               "one of theirs";
    }
    const bool has_sizes = facts.largest > 0.0;
    if (has_sizes && (radius > too_large * facts.largest || radius < too_small * facts.smallest)) {
        return "the proxy's radius of " + meters(radius) + " does not fit bodies that reach from " +
               meters(facts.smallest) + " to " + meters(facts.largest) +
               ": set 'radius' to about a tenth of what is touched";
    }
    return {};
}

double reach_of(const BodyForm& form) {
    double reach = 0.0;
    if (!form.shapes.empty()) {
        const TouchShapeResult made = make_touch_shape(form.shapes);
        reach = made.shape != nullptr ? made.shape->reach : 0.0;
    }
    for (const MeshDraft& draft : form.touched.empty() ? form.meshes : form.touched) {
        const std::shared_ptr<const TriangleMesh> mesh = draft.source->triangles().mesh;
        for (std::size_t i = 0; mesh != nullptr && i < mesh->vertices.size(); ++i) {
            reach = std::max(reach, glm::length(to_parent(draft.pose, draft.scaling * mesh->vertices[i])));
        }
    }
    return reach;
}

bool is_inside(const BodyForm& form, const Pose& body, const Vec3& center, double radius) {
    if (form.shapes.empty() || !form.touched.empty()) {
        return false;
    }
    constexpr double in_contact = 0.9;
    const TouchShapeResult made = make_touch_shape(form.shapes);
    if (made.shape == nullptr) {
        return false;
    }
    const SurfaceHit found = nearest_surface(*made.shape, body, center, radius);
    return found.hit && found.distance < in_contact * radius;
}

}  // namespace tactus
