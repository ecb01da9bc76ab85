#include "session/hand_mapping.hpp"

#include <algorithm>
#include <glm/geometric.hpp>

namespace tactus {

namespace {

constexpr double edge_begins = 0.875;

}  // namespace

Vec3 drift_at_edge(const Workspace& workspace, double radius, const Vec3& position) {
    const double out = glm::length(position);
    const double begin = edge_begins * radius;
    if (workspace.edge_speed == 0.0 || !(radius > 0.0) || !(out > begin)) {
        return Vec3(0.0);
    }
    const double share = std::min(1.0, (out - begin) / (radius - begin));
    return direction_to_parent(workspace.pose, position / out) * (share * workspace.edge_speed);
}

}  // namespace tactus
