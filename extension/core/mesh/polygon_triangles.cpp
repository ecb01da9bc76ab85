#include "core/mesh/polygon_triangles.hpp"

#include <cmath>
#include <glm/geometric.hpp>

namespace tactus {

namespace {

using Vec2 = glm::dvec2;
using Triangle = std::array<std::uint32_t, 3>;

// Twice the signed area (Newell): sums over the edges, so that no corner counts more than another.
Vec3 area_vector(std::span<const Vec3> vertices, std::span<const std::uint32_t> corners) {
    const Vec3& origin = vertices[corners[0]];
    Vec3 sum(0.0);
    for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
        sum += glm::cross(vertices[corners[i]] - origin, vertices[corners[i + 1]] - origin);
    }
    return sum;
}

// Twice the signed area of a triangle, counter-clockwise positive.
double area(const Vec2& a, const Vec2& b, const Vec2& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

class EarCutter {
public:
    EarCutter(std::vector<Vec2> places, std::int64_t& work) : places_(std::move(places)), work_(work) {
        const std::size_t count = places_.size();
        Vec2 low = places_[0];
        Vec2 high = places_[0];
        for (std::size_t i = 0; i < count; ++i) {
            next_.push_back(i + 1 < count ? i + 1 : 0);
            before_.push_back(i > 0 ? i - 1 : count - 1);
            low = glm::min(low, places_[i]);
            high = glm::max(high, places_[i]);
        }
        flat_ = 1e-14 * glm::dot(high - low, high - low);
        for (std::size_t i = 0; i < count; ++i) {
            blunt_.push_back(turn(i) <= flat_);
        }
    }

    // Positions among the corners; what is left at the end has no area.
    bool cut(std::vector<std::array<std::size_t, 3>>& triangles) {
        std::size_t left = places_.size();
        std::size_t at = 0;
        std::size_t passed = 0;  // corners since the last ear
        while (left > 2 && work_ > 0) {
            // One that crosses itself may have no ear: any corner that sticks out will do.
            const bool desperate = passed > left;
            if (passed > 2 * left) {
                break;
            }
            if (is_needless(at)) {
                at = take_out(at);
                --left;
                continue;
            }
            if (!(turn(at) > flat_) || !(desperate || is_ear(at))) {
                at = next_[at];
                ++passed;
                continue;
            }
            triangles.push_back({before_[at], at, next_[at]});
            at = next_[take_out(at)];  // every other one: fewer thin triangles about one corner
            passed = 0;
            --left;
        }
        return work_ > 0;
    }

private:
    double turn(std::size_t i) const { return area(places_[before_[i]], places_[i], places_[next_[i]]); }

    // At the place of the next, or the end of a way that is walked out and back.
    bool is_needless(std::size_t i) const {
        const Vec2 back = places_[before_[i]] - places_[i];
        const Vec2 on = places_[next_[i]] - places_[i];
        return on == Vec2(0.0) || (std::abs(turn(i)) <= flat_ && glm::dot(back, on) > 0.0);
    }

    // Returns the next.
    std::size_t take_out(std::size_t i) {
        const std::size_t start = before_[i];
        const std::size_t end = next_[i];
        next_[start] = end;
        before_[end] = start;
        blunt_[i] = false;
        blunt_[start] = turn(start) <= flat_;
        blunt_[end] = turn(end) <= flat_;
        return end;
    }

    // Corners that do not stick out are the only ones that can stand in an ear. One that stands on its rim
    // counts, so that it becomes a corner of triangles; one at the place of the ear's own corners does not.
    bool is_ear(std::size_t i) {
        const Vec2& a = places_[before_[i]];
        const Vec2& b = places_[i];
        const Vec2& c = places_[next_[i]];
        work_ -= static_cast<std::int64_t>(places_.size());
        for (std::size_t k = 0; k < places_.size(); ++k) {
            const Vec2& p = places_[k];
            if (blunt_[k] && k != before_[i] && k != next_[i] && area(a, b, p) >= 0.0 &&
                area(b, c, p) >= 0.0 && area(c, a, p) >= 0.0 && p != a && p != b && p != c) {
                return false;
            }
        }
        return true;
    }

    std::vector<Vec2> places_;
    std::vector<std::size_t> next_, before_;
    std::vector<bool> blunt_;  // straight or turning inwards
    double flat_ = 0.0;        // twice the area of a triangle that counts as none (unit: square meters)
    std::int64_t& work_;
};

// All triangles around the first corner lie as the polygon does: then they are its triangles.
bool is_fan(std::span<const Vec3> vertices, std::span<const std::uint32_t> corners, const Vec3& normal) {
    const Vec3& origin = vertices[corners[0]];
    const double flat = 1e-12 * glm::dot(normal, normal);
    for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
        const Vec3 one = glm::cross(vertices[corners[i]] - origin, vertices[corners[i + 1]] - origin);
        if (!(glm::dot(one, normal) > flat)) {
            return false;
        }
    }
    return true;
}

}  // namespace

bool add_polygon(std::span<const Vec3> vertices, std::span<const std::uint32_t> corners, std::int64_t& work,
                 std::vector<Triangle>& triangles) {
    const Vec3 normal = area_vector(vertices, corners);
    if (corners.size() == 3 || is_fan(vertices, corners, normal) || !(glm::dot(normal, normal) > 0.0)) {
        for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
            triangles.push_back({corners[0], corners[i], corners[i + 1]});
        }
        return true;
    }
    // Seen along the axis nearest to the normal; the two others in the order that keeps its winding.
    const Vec3 size = glm::abs(normal);
    const int up = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
    const int x = normal[up] > 0.0 ? (up + 1) % 3 : (up + 2) % 3;
    const int y = 3 - up - x;
    std::vector<Vec2> places;
    for (const std::uint32_t corner : corners) {
        places.emplace_back(vertices[corner][x], vertices[corner][y]);
    }
    std::vector<std::array<std::size_t, 3>> found;
    if (!EarCutter(std::move(places), work).cut(found)) {
        return false;
    }
    for (const auto& [a, b, c] : found) {
        triangles.push_back({corners[a], corners[b], corners[c]});
    }
    return true;
}

}  // namespace tactus
