#include "world/hand_picture.hpp"

#include <cmath>
#include <glm/geometric.hpp>

namespace tactus {

namespace {

// Relative to the fingertip's radius.
constexpr double hand_size = 0.5;
constexpr double line_size = 0.2;
constexpr double points_apart = 1e-3;

// The cylinder's frame, stretched along y over the way.
Mat3 along(const Vec3& way, double thickness) {
    const Vec3 y = glm::normalize(way);
    const Vec3 x = glm::normalize(glm::cross(std::abs(y.y) < 0.9 ? Vec3(0, 1, 0) : Vec3(1, 0, 0), y));
    return Mat3(thickness * x, way, thickness * glm::cross(x, y));
}

}  // namespace

HandPicture hand_picture(const HandView& view) {
    const Vec3 way = view.is_running ? view.hand - view.proxy : Vec3(0.0);
    HandPicture picture;
    picture.proxy = {view.shows_proxy && (!view.is_running || view.is_present), view.proxy,
                     Mat3(view.radius)};
    picture.hand = {view.shows_hand && view.is_running, view.proxy + way, Mat3(hand_size * view.radius)};
    if (glm::length(way) > points_apart * view.radius) {
        picture.line = {picture.hand.is_visible && view.is_present, view.proxy + 0.5 * way,
                        along(way, line_size * view.radius)};
    }
    return picture;
}

}  // namespace tactus
