#include "physics/joint.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>

namespace tactus {

namespace {

using Ranges = std::array<JointRange, 3>;

constexpr Ranges all(const JointRange& range) {
    return {range, range, range};
}

double within(const JointRange& range, double value) {
    return range.is_free() ? value : std::clamp(value, range.lower, range.upper);
}

Ranges linear_ranges(const JointDescription& joint) {
    switch (joint.kind) {
        case JointKind::Slider:
            return {joint.linear[0], JointRange::locked(), JointRange::locked()};
        case JointKind::SixAxes:
            return joint.linear;
        case JointKind::Pin:
        case JointKind::Hinge:
            break;
    }
    return all(JointRange::locked());
}

Ranges angular_ranges(const JointDescription& joint) {
    switch (joint.kind) {
        case JointKind::Hinge:
            return {JointRange::locked(), JointRange::locked(), joint.angular[2]};
        case JointKind::SixAxes:
            return joint.angular;
        case JointKind::Pin:
            return all(JointRange::free());
        case JointKind::Slider:
            break;
    }
    return all(JointRange::locked());
}

// A locked axis takes its part from the quaternion: of two locked axes, the twist about the third is left.
Quat nearest_rotation(const Ranges& ranges, const Quat& rotation) {
    Vec3 part(rotation.x, rotation.y, rotation.z);
    int turns = 0, about = 0;
    for (int i = 0; i < 3; ++i) {
        if (ranges[static_cast<std::size_t>(i)].is_locked()) {
            part[i] = 0.0;
        } else {
            ++turns;
            about = i;
        }
    }
    if (turns == 3) {
        return rotation;
    }
    const double size = std::sqrt(rotation.w * rotation.w + glm::dot(part, part));
    if (!(size > 0.0)) {
        return {1.0, 0.0, 0.0, 0.0};
    }
    if (turns == 1) {
        const double angle =
            std::remainder(2.0 * std::atan2(part[about], rotation.w), 2.0 * glm::pi<double>());
        const double half = 0.5 * within(ranges[static_cast<std::size_t>(about)], angle);
        part[about] = std::sin(half);
        return {std::cos(half), part};
    }
    return {rotation.w / size, part / size};
}

}  // namespace

Pose nearest_allowed(const JointDescription& joint, const Pose& relative) {
    const Ranges linear = linear_ranges(joint);
    Pose nearest;
    for (int i = 0; i < 3; ++i) {
        nearest.position[i] = within(linear[static_cast<std::size_t>(i)], relative.position[i]);
    }
    nearest.rotation = nearest_rotation(angular_ranges(joint), relative.rotation);
    return nearest;
}

Pose first_allowed(const JointDescription& joint, const Pose& first, const Pose& second) {
    const Pose end = compose(second, *joint.second_frame);
    const Pose relative = compose(inverse(compose(first, joint.frame)), end);
    return compose(compose(end, inverse(nearest_allowed(joint, relative))), inverse(joint.frame));
}

Pose second_allowed(const JointDescription& joint, const Pose& first, const Pose& second) {
    const Pose start = compose(first, joint.frame);
    const Pose relative = compose(inverse(start), compose(second, *joint.second_frame));
    return compose(compose(start, nearest_allowed(joint, relative)), inverse(*joint.second_frame));
}

}  // namespace tactus
