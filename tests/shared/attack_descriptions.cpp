#include "shared/attack_descriptions.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

namespace tactus::shared {
namespace {

// Of what is attacked: the first few objects, which an honest side has described as well, and a few more.
constexpr std::uint32_t objects = 8;

}  // namespace

DiscoveryFragment FalseDescriptions::next() {
    if (offset_ >= bytes_.size()) {
        begin();
    }
    const auto total = static_cast<std::uint32_t>(bytes_.size());
    const auto size = std::min(static_cast<std::uint32_t>(max_fragment_bytes), total - offset_);
    piece_.offset = offset_;
    piece_.bytes = std::span(bytes_).subspan(offset_, size);
    offset_ += size;
    return piece_;
}

void FalseDescriptions::begin() {
    do {
        bytes_ = joints_ ? some_joint() : some_body();
        if (!bytes_.empty() && dice_.one_in(2)) {
            turn_bits(bytes_);
        }
    } while (bytes_.empty() || is_spared(bytes_));
    offset_ = 0;
    piece_.revision = ++revision_;
    piece_.hash = content_hash(bytes_);
    piece_.total_bytes = static_cast<std::uint32_t>(bytes_.size());
}

Vec3 FalseDescriptions::near_hand() {
    return dice_.one_in(4) ? dice_.vector(plausible::max_position) : dice_.vector(0.3);
}

std::vector<std::byte> FalseDescriptions::some_body() {
    ObjectDescription described;
    described.object = piece_.object = static_cast<ObjectId>(dice_.below(objects));
    described.name = "False" + std::to_string(described.object);
    TouchMaterial& touch = described.touch;
    constexpr double hardest = 1e12;
    touch.stiffness = dice_.one_in(2) ? 500.0 : dice_.size(hardest);
    touch.damping = dice_.one_in(2) ? 0.0 : dice_.size(hardest);
    touch.static_friction = dice_.size(10.0);
    touch.dynamic_friction = dice_.size(10.0);
    touch.viscosity = dice_.one_in(2) ? 0.0 : dice_.size(hardest);
    touch.magnet_force = dice_.one_in(2) ? 0.0 : dice_.size(hardest);
    touch.vibration_force = dice_.one_in(2) ? 0.0 : dice_.size(hardest);
    touch.impact_strength = dice_.one_in(2) ? 0.0 : dice_.size(hardest);
    touch.impact_frequency = dice_.size(1e3);
    touch.impact_decay = dice_.size(1.0);
    if (dice_.one_in(4)) {
        const auto image = std::make_shared<const TouchImage>(TouchImage{2, 2, {0.0f, 1.0f, 0.5f, 0.0f}});
        described.detail =
            std::make_shared<const TouchDetail>(TouchDetail{{image, dice_.one_in(2) ? image : nullptr}, {}});
        touch.detail = described.detail.get();
        touch.by_uv = dice_.one_in(2);
        touch.texture_depth = dice_.size(1.0);
        touch.texture_size = dice_.size(1.0);
    }
    BodyDescription& body = described.body;
    body.motion = static_cast<Motion>(dice_.below(3));
    body.may_move = dice_.one_in(2);
    body.pose = {near_hand(), dice_.rotation()};
    body.linear_velocity = dice_.vector(plausible::max_speed);
    body.angular_velocity = dice_.vector(plausible::max_angular_speed);
    body.mass = dice_.size(hardest);
    if (dice_.one_in(4)) {
        body.center_of_mass = dice_.vector(10.0);
    }
    if (dice_.one_in(4)) {
        body.inertia = dice_.sizes(1e6);
    }
    body.material = {dice_.size(hardest), dice_.unit(), dice_.one_in(2), dice_.one_in(2)};
    body.linear_damping = dice_.one_in(2) ? 0.0 : dice_.size(hardest);
    body.angular_damping = dice_.one_in(2) ? 0.0 : dice_.size(hardest);
    body.gravity_scale = dice_.one_in(2) ? 1.0 : dice_.real(hardest);
    body.collision = {static_cast<std::uint32_t>(dice_.bits()) & ~spared_,
                      static_cast<std::uint32_t>(dice_.bits()) & ~spared_};
    if (dice_.one_in(2)) {
        body.collision.layer |= 1u;
    }
    body.continuous = dice_.one_in(2);
    body.can_sleep = dice_.one_in(2);
    for (std::uint64_t count = 1 + dice_.below(3); count > 0; --count) {
        body.shapes.push_back({some_shape(), Pose{dice_.vector(0.1), dice_.rotation()}});
    }
    if (dice_.one_in(4)) {
        described.touch_shapes.push_back({some_shape(), Pose{}});
    }
    return encode_description(described);
}

Shape FalseDescriptions::some_shape() {
    const double most = dice_.one_in(8) ? 1e12 : 0.2;
    switch (dice_.below(8)) {
        case 0:
            return SphereShape{dice_.size(most)};
        case 1:
            return BoxShape{dice_.sizes(most)};
        case 2:
            return CapsuleShape{dice_.size(most), dice_.size(most)};
        case 3:
            return CylinderShape{dice_.size(most), dice_.size(most)};
        case 4:
            return PlaneShape{dice_.rotation() * Vec3(0.0, 1.0, 0.0), dice_.real(most)};
        case 5:
            return ConvexHullShape{std::make_shared<const TriangleMesh>(some_mesh())};
        case 6:
            return MeshShape{std::make_shared<const TriangleMesh>(some_mesh()), dice_.size(3.0)};
        default:
            break;
    }
    HeightFieldShape field;
    field.columns = 2 + static_cast<std::uint32_t>(dice_.below(3));
    field.rows = 2 + static_cast<std::uint32_t>(dice_.below(3));
    field.scale = dice_.sizes(most);
    std::vector<float> heights(std::size_t{field.columns} * field.rows);
    std::ranges::generate(heights, [&] { return static_cast<float>(dice_.real(1e6)); });
    field.heights = std::make_shared<const std::vector<float>>(std::move(heights));
    return field;
}

// Corners that coincide or lie on a line, triangles that turn back on themselves.
TriangleMesh FalseDescriptions::some_mesh() {
    TriangleMesh mesh;
    const std::uint64_t corners = 3 + dice_.below(dice_.one_in(16) ? 100 : 8);
    for (std::uint64_t i = 0; i < corners; ++i) {
        const bool again = i > 0 && dice_.one_in(4);
        mesh.vertices.push_back(again ? mesh.vertices[dice_.below(i)] : dice_.vector(0.2));
    }
    const auto corner = [&] { return static_cast<std::uint32_t>(dice_.below(corners)); };
    for (std::uint64_t i = 1 + dice_.below(2 * corners); i > 0; --i) {
        mesh.triangles.push_back({corner(), corner(), corner()});
    }
    return mesh;
}

std::vector<std::byte> FalseDescriptions::some_joint() {
    ObjectJoint described;
    described.object = piece_.object = first_joint + static_cast<ObjectId>(dice_.below(objects));
    described.first = static_cast<ObjectId>(dice_.below(objects));
    described.second = dice_.one_in(2) ? no_object : static_cast<ObjectId>(dice_.below(objects));
    JointDescription& joint = described.joint;
    joint.kind = static_cast<JointKind>(dice_.below(4));
    joint.frame = {near_hand(), dice_.rotation()};
    joint.second_frame = Pose{near_hand(), dice_.rotation()};
    for (JointRange& range : joint.linear) {
        range = {dice_.real(1e9), dice_.real(1e9)};
    }
    for (JointRange& range : joint.angular) {
        range = {dice_.real(std::numbers::pi), dice_.real(std::numbers::pi)};
    }
    joint.motor_speed = dice_.real(plausible::max_angular_speed);
    joint.motor_torque = dice_.one_in(2) ? 0.0 : dice_.size(max_motor_torque);
    joint.bodies_collide = dice_.one_in(2);
    return encode_joint(described);  // empty where it joins a body to itself
}

void FalseDescriptions::turn_bits(std::vector<std::byte>& bytes) {
    for (std::uint64_t turned = 1 + dice_.below(4); turned > 0; --turned) {
        bytes[dice_.below(bytes.size())] ^= static_cast<std::byte>(1u << dice_.below(8));
    }
}

bool FalseDescriptions::is_spared(const std::vector<std::byte>& bytes) const {
    ObjectDescription read;
    return !joints_ && decode_description(bytes, read) == Refusal::none &&
           ((read.body.collision.layer | read.body.collision.mask) & spared_) != 0;
}

}  // namespace tactus::shared
