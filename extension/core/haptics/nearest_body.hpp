// Which body of a scene a point is nearest to, with bounded work: who is not asked in this tick comes first
// in the next. The body `first`, which was the nearest lately, is asked before all others.
#pragma once

#include "core/geometry/surface_query.hpp"
#include "core/haptics/touch_scene.hpp"

namespace tactus {

class NearestBody {
public:
    struct Found {
        int body = -1;  // its slot; -1: of those that were asked none is as near as that
        SurfaceHit surface;
        bool asked_all = false;
    };

    // Of those nearer than `within` (unit: meters). `first`: a slot, or -1.
    Found look(const TouchScene& scene, const Vec3& point, double within, int first, WorkBudget& work);

private:
    std::size_t next_ = 0;  // slot to go on with
};

}  // namespace tactus
