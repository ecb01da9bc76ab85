#include "core/haptics/field_line.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/math/shortened.hpp"

namespace tactus {

namespace {

// Windows that are tried: the shortest (unit: meters), and each as many times as wide as the one before.
constexpr double shortest_window = 1e-4;
constexpr double widening = 1.15;
// A window is kept until one that is so many times as wide, or as narrow, is needed.
constexpr double kept = 1.3;

std::size_t index(int i) {
    return static_cast<std::size_t>(i);
}

}  // namespace

void FieldLine::add(double where, const Vec3& what) {
    int i = count++;
    for (; i > 0 && at[index(i - 1)] > where; --i) {
        at[index(i)] = at[index(i - 1)];
        force[index(i)] = force[index(i - 1)];
    }
    at[index(i)] = where;
    force[index(i)] = what;
}

FieldProfile::FieldProfile(const Vec3& origin, const Vec3& force) : origin_(origin) {
    line_.add(0.0, force);
}

FieldProfile::FieldProfile(const Vec3& origin, const FieldLine& line) : origin_(origin), line_(line) {
    integrate();
}

void FieldProfile::integrate() {
    integral_[0] = Vec3(0.0);
    for (int i = 1; i < line_.count; ++i) {
        const double width = line_.at[index(i)] - line_.at[index(i - 1)];
        integral_[index(i)] =
            integral_[index(i - 1)] + 0.5 * width * (line_.force[index(i - 1)] + line_.force[index(i)]);
    }
}

double FieldProfile::along(const Vec3& place) const {
    return glm::dot(line_.direction, place - origin_);
}

Vec3 FieldProfile::across(const Vec3& place) const {
    return place - origin_ - line_.direction * along(place);
}

// The sample that ends the piece in which s is: 0 before the first, the count of them behind the last.
int FieldProfile::segment(double s) const {
    const auto begin = line_.at.begin();
    return static_cast<int>(std::upper_bound(begin, begin + line_.count, s) - begin);
}

Vec3 FieldProfile::force(double s) const {
    const int i = segment(s);
    if (line_.count == 0) {
        return Vec3(0.0);
    }
    if (i == 0 || i == line_.count) {
        return line_.force[index(i == 0 ? 0 : i - 1)];
    }
    const double share = (s - line_.at[index(i - 1)]) / (line_.at[index(i)] - line_.at[index(i - 1)]);
    return line_.force[index(i - 1)] + share * (line_.force[index(i)] - line_.force[index(i - 1)]);
}

Vec3 FieldProfile::integral(double s) const {
    if (line_.count == 0) {
        return Vec3(0.0);
    }
    const std::size_t i = index(std::max(segment(s) - 1, 0));
    return integral_[i] + 0.5 * (s - line_.at[i]) * (line_.force[i] + force(s));
}

Vec3 FieldProfile::rendered(double s) const {
    return window_ > 0.0 ? (integral(s + 0.5 * window_) - integral(s - 0.5 * window_)) / window_ : force(s);
}

// As far as what is rendered where the hand may get depends on the force (unit: meters).
double FieldProfile::reach(double stiffest, double strongest) const {
    Vec3 least = line_.force[0], most = line_.force[0];
    for (int i = 1; i < line_.count; ++i) {
        least = glm::min(least, line_.force[index(i)]);
        most = glm::max(most, line_.force[index(i)]);
    }
    return line_.near + 0.5 * std::min(glm::distance(least, most), 2.0 * strongest) / stiffest;
}

// The largest one of what is rendered so. It is F(s + w/2) - F(s - w/2) over w, and largest where one of both
// is a sample.
double FieldProfile::slope(double window, double reach) const {
    double largest = 0.0;
    for (int i = 0; i < line_.count; ++i) {
        const double at = line_.at[index(i)];
        if (window == 0.0) {
            const double from = i > 0 ? line_.at[index(i - 1)] : at;
            if (at > from && at >= -reach && from <= reach) {
                const double leap = glm::distance(line_.force[index(i)], line_.force[index(i - 1)]);
                largest = std::max(largest, leap / (at - from));
            }
            continue;
        }
        for (const double side : {-1.0, 1.0}) {
            if (std::abs(at + side * 0.5 * window) <= reach) {
                const double leap = glm::distance(line_.force[index(i)], force(at + side * window));
                largest = std::max(largest, leap / window);
            }
        }
    }
    return largest;
}

void FieldProfile::make_safe(double stiffest, double strongest, const FieldProfile& before) {
    window_ = 0.0;
    if (line_.count < 2) {
        return;
    }
    const double longest = std::min(strongest, 0.5 * stiffest * FieldLine::beyond);
    const double reach = this->reach(stiffest, longest);
    steepest_ = slope(0.0, reach);
    if (steepest_ <= stiffest) {
        return;
    }
    for (int i = 0; i < line_.count; ++i) {
        line_.force[index(i)] = shortened(line_.force[index(i)], longest);
    }
    integrate();
    if (before.window_ > 0.0 && slope(before.window_, reach) <= stiffest &&
        slope(before.window_ / kept, reach) > stiffest) {
        window_ = before.window_;
        return;
    }
    window_ = shortest_window;
    while (window_ < FieldLine::beyond && slope(window_, reach) > stiffest) {
        window_ *= widening;
    }
}

}  // namespace tactus
