// Everything a joint is made of survives the wire to the bit, and nothing else is believed.
#include <gtest/gtest.h>

#include <limits>

#include "network/discovery_receiver.hpp"
#include "network/discovery_sender.hpp"
#include "published_vectors.hpp"
#include "shared/random_values.hpp"

namespace tactus::joint_description_test {
namespace {

using Bytes = std::vector<std::byte>;

ObjectJoint sample() {
    ObjectJoint joint;
    joint.object = first_joint + 3;
    joint.first = 5;
    joint.second = 9;
    joint.joint.kind = JointKind::Hinge;
    joint.joint.frame = {{0.25, -1.0, 2.0}, Quat(0.5, 0.5, -0.5, 0.5)};
    joint.joint.second_frame = Pose{{1.5, 0.0, -0.125}, Quat(0.5, -0.5, 0.5, 0.5)};
    joint.joint.linear = {JointRange{-0.5, 0.75}, JointRange::locked(), JointRange::free()};
    joint.joint.angular = {JointRange{-1.0, 1.5}, JointRange::free(), JointRange{-0.25, 0.0}};
    joint.joint.motor_speed = -2.5;
    joint.joint.motor_torque = 12.5;
    joint.joint.bodies_collide = true;
    return joint;
}

TEST(JointDescription, SurvivesTheWire) {
    const Bytes bytes = encode_joint(sample());
    ASSERT_FALSE(bytes.empty());
    ObjectJoint read;
    ASSERT_EQ(decode_joint(bytes, read), Refusal::none);
    EXPECT_EQ(encode_joint(read), bytes) << "every field";
    EXPECT_EQ(read.object, sample().object);
    EXPECT_EQ(read.second, 9u);
    EXPECT_EQ(read.joint.kind, JointKind::Hinge);
    EXPECT_EQ(read.joint.second_frame->position, sample().joint.second_frame->position);
    EXPECT_EQ(read.joint.angular[2].lower, -0.25);
    EXPECT_EQ(read.joint.motor_torque, 12.5);
    EXPECT_TRUE(read.joint.bodies_collide);
}

TEST(JointDescription, IsTheBytesOfThePublishedVectors) {
    EXPECT_EQ(samples::published_vectors()["joint"], samples::hex(encode_joint(sample())));
}

TEST(JointDescription, IsRefusedWhenCutLongerOrDamaged) {
    const Bytes whole = encode_joint(sample());
    ObjectJoint read;
    for (std::size_t size = 0; size < whole.size(); ++size) {
        EXPECT_NE(decode_joint(std::span(whole).first(size), read), Refusal::none);
    }
    Bytes longer = whole;
    longer.push_back(std::byte{0});
    EXPECT_EQ(decode_joint(longer, read), Refusal::oversized);
    shared::RandomValues random(5);
    for (int round = 0; round < 20'000; ++round) {
        Bytes bytes = whole;
        bytes[static_cast<std::size_t>(random.below(static_cast<int>(bytes.size())))] =
            static_cast<std::byte>(random.below(256));
        if (decode_joint(bytes, read) == Refusal::none) {
            EXPECT_EQ(encode_joint(read), bytes);
        }
    }
}

TEST(JointDescription, ABrokenOneIsNotSent) {
    const auto breaks = [](auto&& damage) {
        ObjectJoint joint = sample();
        damage(joint);
        return encode_joint(joint).empty();
    };
    EXPECT_FALSE(breaks([](auto&) {}));
    EXPECT_FALSE(breaks([](auto& j) { j.second = no_object; })) << "joined to the scene";
    EXPECT_TRUE(breaks([](auto& j) { j.object = 3; })) << "the number of a body";
    EXPECT_TRUE(breaks([](auto& j) { j.first = no_object; }));
    EXPECT_TRUE(breaks([](auto& j) { j.first = first_joint; }));
    EXPECT_TRUE(breaks([](auto& j) { j.second = j.first; }));
    EXPECT_TRUE(breaks([](auto& j) { j.joint.second_frame.reset(); }));
    EXPECT_TRUE(breaks([](auto& j) { j.joint.frame.rotation = Quat(0.0, 0.0, 0.0, 0.0); }));
    EXPECT_TRUE(breaks([](auto& j) { j.joint.angular[0].upper = 4.0; }));
    EXPECT_TRUE(breaks([](auto& j) { j.joint.motor_torque = -1.0; }));
    EXPECT_TRUE(breaks([](auto& j) { j.joint.motor_speed = std::numeric_limits<double>::quiet_NaN(); }));
}

// By the same way as a body; a body that calls itself a joint is none.
TEST(JointDescription, TravelsInPiecesAndIsTold) {
    DiscoverySender sender;
    DiscoveryReceiver receiver;
    PreparedDiscovery prepared = prepare_discovery(sample());
    ASSERT_TRUE(prepared);
    ASSERT_TRUE(sender.announce(prepared));
    Message message;
    ASSERT_TRUE(sender.next(0, message));
    ASSERT_TRUE(receiver.put(std::get<DiscoveryFragment>(message)));
    const std::optional<DiscoveryEvent> event = receiver.next();
    ASSERT_TRUE(event);
    EXPECT_EQ(event->object, sample().object);
    EXPECT_EQ(encode_joint(event->joint), encode_joint(sample()));

    ObjectDescription body;
    body.object = first_joint;
    body.body.shapes.push_back({SphereShape{0.1}, {}});
    EXPECT_TRUE(encode_description(body).empty());
}

}  // namespace
}  // namespace tactus::joint_description_test
