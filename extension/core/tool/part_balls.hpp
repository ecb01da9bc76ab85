// The balls around the parts of a scene that are near a tool, eight side by side: hundreds of spheres ask
// them in every step.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <glm/geometric.hpp>
#include <span>
#include <vector>

#include "core/tree/box_node.hpp"
#include "core/tree/work.hpp"

namespace tactus {

class PartBalls {
public:
    explicit PartBalls(std::size_t max_parts) {
        parts_.reserve(max_parts);
        groups_.reserve(max_parts / node_width + 1);
    }

    // `origin`: where they will be asked from, about (in the world, unit: meters).
    void clear(const Vec3& origin) {
        origin_ = origin;
        parts_.clear();
        groups_.clear();
    }
    // In the order of their numbers. `center` in the world (unit: meters); the radius may be infinite.
    void add(std::uint32_t part, const Vec3& center, double radius) {
        const std::size_t lane = parts_.size() % node_width;
        if (lane == 0) {
            const FloatLanes nowhere = splat_float(__builtin_inff());
            groups_.push_back({{nowhere, nowhere, nowhere}, splat_float(0.0f)});
        }
        const Vec3 apart = center - origin_;
        Group& group = groups_.back();
        group.center.x[lane] = static_cast<float>(apart.x);
        group.center.y[lane] = static_cast<float>(apart.y);
        group.center.z[lane] = static_cast<float>(apart.z);
        group.radius[lane] = static_cast<float>(widened(radius, apart));
        parts_.push_back(part);
    }

    bool is_empty() const { return parts_.empty(); }
    std::span<const std::uint32_t> all() const { return parts_; }

    // Calls visit(part), in the order in which they were added, for each whose ball is within `reach` of the
    // point, and for some that are not by a millionth.
    template <class Visit>
    void visit_within(const Vec3& point, double reach, WorkBudget& work, Visit&& visit) const {
        constexpr std::size_t groups_a_unit = 8;
        work.spend(static_cast<std::int64_t>((groups_.size() + groups_a_unit - 1) / groups_a_unit));
        const Vec3 apart = point - origin_;
        const FloatPoint at = to_float_point(apart);
        const FloatLanes room = splat_float(static_cast<float>(widened(reach, apart)));
        for (std::size_t g = 0; g < groups_.size(); ++g) {
            const FloatPoint offset = at - groups_[g].center;
            const FloatLanes far = groups_[g].radius + room;
            for (unsigned bits = lane_bits(dot(offset, offset) <= far * far); bits != 0; bits &= bits - 1) {
                visit(parts_[g * node_width + static_cast<std::size_t>(std::countr_zero(bits))]);
            }
        }
    }

private:
    struct Group {
        FloatPoint center;  // from the origin; infinite where unused
        FloatLanes radius;
    };

    // By more than what single precision loses of it, of the place, and of their squares.
    static double widened(double length, const Vec3& place) {
        return length + 1e-6 * (length + glm::length(place));
    }

    Vec3 origin_{0.0};
    std::vector<std::uint32_t> parts_;
    std::vector<Group> groups_;
};

}  // namespace tactus
