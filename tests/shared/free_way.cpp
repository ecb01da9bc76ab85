#include "shared/free_way.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <queue>
#include <unordered_map>

namespace tactus::shared {

namespace {

constexpr double cell_share = 0.25;       // of the radius
constexpr double kept_share = 0.78;       // 1 - cell_share * sqrt(3) / 2, rounded down
constexpr std::size_t longest = 300'000;  // places looked at

using Place = std::array<std::int32_t, 3>;

std::uint64_t key_of(const Place& p) {
    constexpr std::uint64_t middle = 1u << 20;
    return ((static_cast<std::uint64_t>(p[0]) + middle) << 42) ^
           ((static_cast<std::uint64_t>(p[1]) + middle) << 21) ^ (static_cast<std::uint64_t>(p[2]) + middle);
}

}  // namespace

FreeWay find_free_way(const JudgeTree& mesh, const Vec3& from, const Vec3& to, double radius,
                      const Vec3& around, double reach) {
    const double cell = cell_share * radius;
    const double kept = kept_share * radius;
    struct Open {
        double estimate;
        double gone;
        Place place;
    };
    const auto is_worse = [](const Open& p, const Open& q) { return p.estimate > q.estimate; };
    std::priority_queue<Open, std::vector<Open>, decltype(is_worse)> open(is_worse);
    std::unordered_map<std::uint64_t, bool> seen;  // whether it is free
    const auto at = [&](const Place& p) { return from + cell * Vec3(p[0], p[1], p[2]); };
    open.push({glm::distance(from, to), 0.0, {0, 0, 0}});
    seen.emplace(key_of({0, 0, 0}), true);
    while (!open.empty()) {
        const Open next = open.top();
        open.pop();
        // A way ends within half a diagonal of a place.
        if (glm::distance(at(next.place), to) <= 0.87 * cell) {
            return FreeWay::found;
        }
        if (seen.size() > longest) {
            return FreeWay::unknown;
        }
        for (int i = 0; i < 27; ++i) {
            const Place place{next.place[0] + i % 3 - 1, next.place[1] + i / 3 % 3 - 1,
                              next.place[2] + i / 9 - 1};
            const auto [known, added] = seen.try_emplace(key_of(place), false);
            if (!added) {
                continue;
            }
            const Vec3 p = at(place);
            if (glm::distance(p, around) > reach + cell || mesh.nearest(p, kept).distance < kept) {
                continue;
            }
            known->second = true;
            const double gone = next.gone + glm::distance(at(next.place), p);
            open.push({gone + 1.5 * glm::distance(p, to), gone, place});
        }
    }
    return FreeWay::none;
}

bool is_straight_way_free(const JudgeTree& mesh, const Vec3& from, const Vec3& to, double radius) {
    const double length = glm::distance(from, to);
    const double kept = kept_share * radius;
    for (double gone = 0.0; gone < length;) {
        const Vec3 at = from + (to - from) * (gone / length);
        const double distance = mesh.nearest(at, kept + length - gone).distance;
        if (distance < kept) {
            return false;
        }
        gone += std::max(distance - kept, 0.02 * radius);
    }
    return true;
}

}  // namespace tactus::shared
