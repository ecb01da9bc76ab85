#include "core/haptics/surface_way.hpp"

#include "core/tree/deform_sweep.hpp"

namespace tactus {

Vec3 way_of_surface(const TouchScene& scene, const Touch& touch) {
    const TouchBody& body = scene.body(touch.body);
    if (body.former && touch.feature.triangle != Hit::no_triangle) {
        const ScenePart& part = scene.parts()[touch.feature.part];
        const std::size_t index = touch.feature.part - body.first_part;
        const TriangleTree* const from = body.former->parts[index].tree();
        const TriangleTree* const to = part.part->tree();
        if (from && to && to->is_refit_of(*from)) {
            const Vec3 weights =
                weights_of(to_local(part.pose, touch.point), to->corners(touch.feature.triangle));
            const TriangleCorners was = from->corners(touch.feature.triangle);
            const Vec3 before = was.a * weights.x + was.b * weights.y + was.c * weights.z;
            return touch.point - to_parent(part.previous, before);
        }
    }
    return touch.point - previous_place(body, touch.point);
}

}  // namespace tactus
