#include "core/proxy/proxy_sphere.hpp"

#include <algorithm>
#include <glm/geometric.hpp>

namespace tactus {

void ProxySphere::put(const Vec3& place) {
    surroundings.jumped(glm::distance(place, position));
    position = place;
    contacts_hold = false;
}

// A long way over a rough surface mostly ends early, and the bounds of a short one leave out far more: it is
// gone in strides, each as long as the last ones let it be.
Hit ProxySphere::advance(const Vec3& motion, FeatureId& stopped_by, int except) {
    const Vec3 origin = position;
    const double length = glm::length(motion);
    Hit hit;
    double stride = surroundings.first_stride();
    for (double gone = 0.0; gone < 1.0 && hit.is_free();) {
        const double share = stride / std::max(length, 1e-300);
        const double end = gone + share > 0.99 ? 1.0 : gone + share;
        hit = surroundings.sweep(position, motion * (end - gone), stopped_by, except);
        const double free_share = (end - gone) * (hit.is_free() ? 1.0 : hit.t);
        gone = hit.is_free() ? end : gone + free_share;
        stride = surroundings.next_stride(free_share * length, hit.is_free());
        position = origin + motion * gone;
        surroundings.travelled(free_share * length);
    }
    return hit;
}

}  // namespace tactus
