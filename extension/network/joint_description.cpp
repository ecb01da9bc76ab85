// The encoded form of an ObjectJoint: docs/wire_format.md, "Description of a joint".
#include <numbers>

#include "network/messages.hpp"
#include "network/wire_stream.hpp"

namespace tactus {
namespace {

// More than any of them: three numbers, two poses, a kind, twelve limits, a motor and a flag.
constexpr std::size_t max_bytes = 256;

void range_fields(auto& s, auto& range, double most) {
    s.real(range.lower, -most, most);
    s.real(range.upper, -most, most);
}

template <typename Stream>
void joint_fields(Stream& s, auto& described) {
    s.integer(described.object);
    s.require(is_joint(described.object));
    s.integer(described.first);
    s.integer(described.second);
    s.require(described.first < first_joint && !is_joint(described.second) &&
              described.first != described.second);
    auto& joint = described.joint;
    s.choice(joint.kind, JointKind::SixAxes);
    s.pose(joint.frame);
    if constexpr (Stream::reads) {
        joint.second_frame.emplace();
    } else {
        s.require(joint.second_frame.has_value());
    }
    if (s.good()) {
        s.pose(*joint.second_frame);
    }
    for (auto& range : joint.linear) {
        range_fields(s, range, max_wire_length);
    }
    for (auto& range : joint.angular) {
        range_fields(s, range, std::numbers::pi);
    }
    s.real(joint.motor_speed, -plausible::max_angular_speed, plausible::max_angular_speed);
    s.real(joint.motor_torque, 0.0, max_motor_torque);
    s.flag(joint.bodies_collide);
}

}  // namespace

std::vector<std::byte> encode_joint(const ObjectJoint& joint) {
    std::vector<std::byte> bytes(max_bytes);
    WireWriter writer(bytes);
    joint_fields(writer, joint);
    bytes.resize(writer.good() ? writer.written() : 0);
    return bytes;
}

Refusal decode_joint(std::span<const std::byte> bytes, ObjectJoint& joint) {
    joint = {};
    WireReader reader(bytes);
    joint_fields(reader, joint);
    if (reader.good() && reader.remaining() != 0) {
        return Refusal::oversized;
    }
    return reader.refusal();
}

}  // namespace tactus
