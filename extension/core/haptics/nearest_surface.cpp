#include "core/haptics/nearest_surface.hpp"

#include <glm/geometric.hpp>
#include <limits>

namespace tactus {

namespace {

// Direction from the triangle of the pack that is nearest to the point.
Vec3 normal_of_nearest(const TrianglePack& pack, const Vec3& point) {
    const PackOffset offset = offset_from_triangles(pack, splat(point));
    int best = 0;
    for (int i = 1; i < lane_count; ++i) {
        best = offset.squared[i] < offset.squared[best] ? i : best;
    }
    const Vec3 away = lane(offset.offset, best);
    const double length = glm::length(away);
    return length > 0.0 ? away / length : Vec3(0.0, 1.0, 0.0);
}

}  // namespace

NearestSurface nearest_surface(const TouchScene& scene, int index, const Vec3& point, double far,
                               WorkBudget& work) {
    NearestSurface nearest{far, {0.0, 1.0, 0.0}};
    const TouchBody& body = scene.body(index);
    for (std::size_t i = 0; i < body.shape->parts.size(); ++i) {
        const ScenePart& placed = scene.parts()[body.first_part + i];
        const Vec3 local = to_local(placed.pose, point);
        if (glm::length(local - placed.part->center) - placed.part->radius >= nearest.distance) {
            continue;
        }
        if (const TriangleTree* const tree = placed.part->tree()) {
            const NearestTriangle found = tree->nearest(local, nearest.distance, work);
            nearest.complete = nearest.complete && found.complete;
            if (found.distance < nearest.distance) {
                const Vec3 normal = normal_of_nearest(tree->pack(found.pack), local);
                nearest.distance = found.distance;
                nearest.normal = direction_to_parent(placed.pose, normal);
            }
        } else if (const SolidDistance at = distance_to_solid(placed.part->solid(), local);
                   at.distance < nearest.distance) {
            nearest.distance = at.distance;
            nearest.normal = direction_to_parent(placed.pose, at.normal);
        }
    }
    return nearest;
}

NearestSurface nearest_surface(const TouchScene& scene, int index, const Vec3& point, double far) {
    WorkBudget unlimited(std::numeric_limits<std::int64_t>::max());
    return nearest_surface(scene, index, point, far, unlimited);
}

}  // namespace tactus
