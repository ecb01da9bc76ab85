#include "core/safety/hand_passivity.hpp"

#include <algorithm>
#include <glm/geometric.hpp>

namespace tactus {

Vec3 HandPassivity::pass(const PassivitySample& now, const Vec3& wanted) {
    if (begun_) {
        const Vec3 way = now.position - position_;
        const double squared = glm::dot(way, way);
        // A device that takes anything takes nothing at rest: infinity times zero is no number.
        const double taken = squared > 0.0 ? now.damping * squared / now.seconds : 0.0;
        energy_ += taken - glm::dot(given_, way) + now.source;
    }
    position_ = now.position;
    begun_ = true;
    if (wanted == Vec3(0.0) && given_ == Vec3(0.0)) {
        energy_ = 0.0;  // the contact is over
        return wanted;
    }
    const double squared_speed = glm::dot(now.velocity, now.velocity);
    const double power = glm::dot(wanted, now.velocity);
    const double allowed = energy_ / now.seconds + now.damping * squared_speed;
    if (power <= allowed || squared_speed == 0.0) {
        return wanted;
    }
    return wanted - now.velocity * std::min((power - allowed) / squared_speed, now.max_damping);
}

void HandPassivity::given(const Vec3& force) {
    given_ = force;
}

}  // namespace tactus
