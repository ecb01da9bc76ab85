#include "core/haptics/guide_way.hpp"

#include <algorithm>
#include <glm/geometric.hpp>
#include <limits>
#include <string>
#include <utility>

namespace tactus {

namespace {

std::size_t blocks_of(std::size_t points) {
    return points < 2 ? 0 : (points - 2) / GuideWay::block + 1;
}

GuideWay::Block block_around(const std::vector<Vec3>& points, std::size_t first, std::size_t last) {
    Vec3 low = points[first], high = points[first];
    for (std::size_t i = first; i <= last; ++i) {
        low = glm::min(low, points[i]);
        high = glm::max(high, points[i]);
    }
    const Vec3 center = 0.5 * (low + high);
    double radius = 0.0;
    for (std::size_t i = first; i <= last; ++i) {
        radius = std::max(radius, glm::distance(center, points[i]));
    }
    return {center, radius};
}

}  // namespace

std::shared_ptr<const GuideWay> GuideWay::of(std::vector<Vec3> points) {
    auto way = std::make_shared<GuideWay>();
    way->points = std::move(points);
    for (std::size_t i = 0; i < blocks_of(way->points.size()); ++i) {
        const std::size_t first = i * block;
        way->blocks.push_back(
            block_around(way->points, first, std::min(first + block, way->points.size() - 1)));
    }
    return way;
}

bool is_guide_place(const Vec3& place) {
    const Vec3 size = glm::abs(place);
    return size.x <= farthest_guide && size.y <= farthest_guide && size.z <= farthest_guide;
}

std::string check_guide_points(std::span<const Vec3> points) {
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (!is_guide_place(points[i])) {
            return "point " + std::to_string(i) + " of the guide is not a place within 1e9 m: set it anew";
        }
    }
    return {};
}

std::string check_way(const GuideWay& way) {
    if (way.points.size() < 2) {
        return "the guide has too few points: give a point one, a line or a path two, a plane three";
    }
    if (way.points.size() > GuideWay::most) {
        return "a guide has at most 4096 points: leave some out, or use several";
    }
    if (std::string problem = check_guide_points(way.points); !problem.empty()) {
        return problem;
    }
    if (way.blocks != GuideWay::of(way.points)->blocks) {
        return "the blocks of the guide are not those of its points: make it of its points again";
    }
    return {};
}

Vec3 nearest_on_line(const Vec3& a, const Vec3& b, const Vec3& hand, double first, double last) {
    const Vec3 way = b - a;
    const double squared = glm::dot(way, way);
    const double share = squared > 0.0 ? glm::dot(hand - a, way) / squared : 0.0;
    return a + way * std::clamp(share, first, last);
}

Vec3 nearest_on_way(const GuideWay& way, const Vec3& hand) {
    // Some place of a block is no farther than the far side of its sphere.
    double bound = std::numeric_limits<double>::infinity();
    for (const GuideWay::Block& block : way.blocks) {
        bound = std::min(bound, glm::distance(hand, block.center) + block.radius);
    }
    Vec3 nearest = way.points.front();
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < way.blocks.size(); ++k) {
        const double to_block = glm::distance(hand, way.blocks[k].center) - way.blocks[k].radius;
        if (to_block > std::min(bound, least)) {
            continue;
        }
        const std::size_t end = std::min((k + 1) * GuideWay::block, way.points.size() - 1);
        for (std::size_t i = k * GuideWay::block; i < end; ++i) {
            const Vec3 place = nearest_on_line(way.points[i], way.points[i + 1], hand, 0.0, 1.0);
            const double distance = glm::distance(place, hand);
            if (distance < least) {
                least = distance;
                nearest = place;
            }
        }
    }
    return nearest;
}

}  // namespace tactus
