// Everything a body is made of survives the wire to the bit, and nothing else is believed.
#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <map>
#include <string>

#include "network/messages.hpp"
#include "published_vectors.hpp"
#include "shared/object_samples.hpp"
#include "shared/random_values.hpp"

namespace tactus::object_description_test {
namespace {

using Bytes = std::vector<std::byte>;

Refusal refusal_of(const Bytes& bytes) {
    ObjectDescription description;
    return decode_description(bytes, description);
}

TEST(ObjectDescription, SurvivesTheWire) {
    const ObjectDescription sent = samples::object_of_all_shapes(5);
    const Bytes bytes = encode_description(sent);
    ASSERT_FALSE(bytes.empty());
    ObjectDescription read;
    ASSERT_EQ(decode_description(bytes, read), Refusal::none);
    EXPECT_EQ(read.object, sent.object);
    EXPECT_EQ(read.name, sent.name);
    EXPECT_EQ(read.body.mass, sent.body.mass);
    EXPECT_EQ(read.body.pose.position, sent.body.pose.position);
    EXPECT_EQ(read.body.inertia, sent.body.inertia);
    EXPECT_EQ(read.body.center_of_mass, sent.body.center_of_mass);
    EXPECT_EQ(read.body.motion, sent.body.motion);
    EXPECT_EQ(read.body.collision.mask, sent.body.collision.mask);
    EXPECT_TRUE(read.body.lock_angular[2]);
    EXPECT_EQ(read.touch.stiffness, sent.touch.stiffness);
    EXPECT_EQ(read.touch.pop_through_force, sent.touch.pop_through_force);
    EXPECT_EQ(read.touch.impact_strength, sent.touch.impact_strength);
    EXPECT_EQ(read.touch.impact_frequency, sent.touch.impact_frequency);
    EXPECT_EQ(read.touch.impact_decay, sent.touch.impact_decay);
    EXPECT_EQ(read.touch.stribeck_speed, sent.touch.stribeck_speed);
    EXPECT_EQ(read.touch.stiffening, sent.touch.stiffening);
    EXPECT_EQ(read.touch.stiffening_depth, sent.touch.stiffening_depth);
    EXPECT_TRUE(read.touch.by_uv);
    ASSERT_NE(read.touch.detail, nullptr);
    EXPECT_EQ(read.touch.detail, read.detail.get());
    EXPECT_EQ(read.detail->images.heights->values, sent.detail->images.heights->values);
    EXPECT_EQ(read.detail->images.friction->values, sent.detail->images.friction->values);
    ASSERT_EQ(read.body.shapes.size(), sent.body.shapes.size());
    for (std::size_t i = 0; i < sent.body.shapes.size(); ++i) {
        EXPECT_EQ(read.body.shapes[i].shape.index(), sent.body.shapes[i].shape.index());
    }
    EXPECT_EQ(encode_description(read), bytes) << "every field, in every kind of shape";
}

TEST(ObjectDescription, CitizenHolesOfAHeightFieldSurviveTheWire) {
    ObjectDescription sent;
    sent.object = 3;
    sent.body.shapes.push_back({HeightFieldShape{3, 2, Vec3(1.0),
                                                 std::make_shared<const std::vector<float>>(
                                                     std::vector<float>{0, hole_height, 1, 2, 3, 4})},
                                {}});
    ObjectDescription read;
    ASSERT_EQ(decode_description(encode_description(sent), read), Refusal::none);
    const auto& field = std::get<HeightFieldShape>(read.body.shapes.front().shape);
    EXPECT_EQ((*field.heights)[1], hole_height);
    EXPECT_EQ(encode_description(read), encode_description(sent));
}

TEST(ObjectDescription, ABareOneSurvivesToo) {
    ObjectDescription sent;
    sent.object = 0;
    sent.body.shapes.push_back({SphereShape{0.1}, {}});
    ObjectDescription read;
    ASSERT_EQ(decode_description(encode_description(sent), read), Refusal::none);
    EXPECT_EQ(read.detail, nullptr);
    EXPECT_EQ(read.touch.detail, nullptr);
    EXPECT_FALSE(read.body.inertia.has_value());
    EXPECT_EQ(encode_description(read), encode_description(sent));
}

TEST(ObjectDescription, IsRefusedWhenCutAtAnyByteOrLonger) {
    Bytes bytes = encode_description(samples::object_of_all_shapes(5));
    for (std::size_t size = 0; size < bytes.size(); ++size) {
        EXPECT_NE(refusal_of(Bytes(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size))),
                  Refusal::none);
    }
    bytes.push_back(std::byte{0});
    EXPECT_EQ(refusal_of(bytes), Refusal::oversized);
}

TEST(ObjectDescription, SurvivesDamageOrIsRefused) {
    const Bytes whole = encode_description(samples::object_of_all_shapes(5));
    shared::RandomValues random(9);
    for (int round = 0; round < 20'000; ++round) {
        Bytes bytes = whole;
        for (int hits = 1 + random.below(3); hits > 0; --hits) {
            bytes[static_cast<std::size_t>(random.below(static_cast<int>(bytes.size())))] =
                static_cast<std::byte>(random.below(256));
        }
        ObjectDescription read;
        if (decode_description(bytes, read) == Refusal::none) {
            EXPECT_EQ(encode_description(read), bytes);
        }
    }
}

TEST(ObjectDescription, ABrokenOneIsNotSent) {
    const auto breaks = [](auto&& damage) {
        ObjectDescription description = samples::object_of_all_shapes(5);
        damage(description);
        return encode_description(description).empty();
    };
    EXPECT_FALSE(breaks([](auto&) {}));
    EXPECT_TRUE(breaks([](auto& d) { d.object = no_object; }));
    EXPECT_TRUE(breaks([](auto& d) { d.body.mass = 0.0; }));
    EXPECT_TRUE(breaks([](auto& d) { d.body.mass = std::numeric_limits<double>::quiet_NaN(); }));
    EXPECT_TRUE(breaks([](auto& d) { d.body.shapes.clear(); }));
    EXPECT_TRUE(breaks([](auto& d) { d.body.shapes = {{ConvexHullShape{}, {}}}; }));
    EXPECT_TRUE(breaks([](auto& d) { d.body.shapes = {{SphereShape{-1.0}, {}}}; }));
    EXPECT_TRUE(breaks([](auto& d) { d.body.shapes = {{PlaneShape{{0.0, 2.0, 0.0}, 0.0}, {}}}; }));
    EXPECT_TRUE(breaks([](auto& d) { d.body.pose.rotation = Quat(0.0, 0.0, 0.0, 0.0); }));
    EXPECT_TRUE(breaks([](auto& d) { d.body.material.restitution = 1.5; }));
    EXPECT_TRUE(breaks([](auto& d) { d.touch.stiffness = -1.0; }));
    EXPECT_TRUE(breaks([](auto& d) { d.name = std::string(max_name_bytes + 1, 'a'); }));
    EXPECT_TRUE(breaks([](auto& d) { d.name = "\xff"; }));
    EXPECT_TRUE(breaks([](auto& d) { d.name = "\xc3"; }));
    EXPECT_FALSE(breaks([](auto& d) { d.name = "Tisch/Kl\xc3\xb6tzchen"; }));
    EXPECT_FALSE(breaks([](auto& d) {
        d.body.mass = 0.0;
        d.body.motion = Motion::Static;
    }));
}

TEST(ObjectDescription, AnIndexOutsideTheMeshIsRefused) {
    auto mesh = std::make_shared<TriangleMesh>();
    mesh->vertices = {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}};
    mesh->triangles = {{0, 1, 3}};
    ObjectDescription description;
    description.object = 1;
    description.body.shapes = {{MeshShape{mesh, 0.0}, {}}};
    EXPECT_TRUE(encode_description(description).empty());
}

// A count that promises more than there is may not make the reader take memory for it.
TEST(ObjectDescription, APromiseOfGigabytesIsRefusedAtOnce) {
    auto mesh = std::make_shared<TriangleMesh>();
    mesh->vertices.assign(3, Vec3(0.25));
    mesh->triangles = {{0, 1, 2}};
    ObjectDescription description;
    description.object = 1;
    description.body.shapes = {{MeshShape{mesh, 0.0}, {}}};
    Bytes bytes = encode_description(description);
    // From the end: no touch shapes, one triangle and its count, three corners.
    const std::size_t count_at = bytes.size() - 4 - 12 - 4 - 3 * 24 - 4;
    const std::uint32_t promise = 16'000'000;
    std::memcpy(&bytes[count_at], &promise, 4);
    EXPECT_EQ(refusal_of(bytes), Refusal::truncated);
}

TEST(ObjectDescription, WhatIsTooLongIsNotSent) {
    auto mesh = std::make_shared<TriangleMesh>();
    mesh->vertices.assign(max_description_bytes / 24 + 1, Vec3(0.0));
    ObjectDescription description;
    description.object = 1;
    description.body.shapes = {{MeshShape{mesh, 0.0}, {}}};
    EXPECT_TRUE(encode_description(description).empty());
}

// For a second implementation to read: tests/tools does.
TEST(ObjectDescription, IsTheBytesOfThePublishedVectors) {
    const std::map<std::string, std::string> published = samples::published_vectors();
    const Bytes bytes = encode_description(samples::object_of_all_shapes(5));
    EXPECT_EQ(published.at("description"), samples::hex(bytes));
    const ContentHash hash = content_hash(bytes);
    EXPECT_EQ(published.at("description_hash"), samples::hex(std::as_bytes(std::span(hash))));
}

// BLAKE2b with 128 bits of digest, as RFC 7693 and Python's hashlib.blake2b(digest_size=16) have it.
TEST(ContentHash, IsBlake2b) {
    const ContentHash expected{0xcf, 0x4a, 0xb7, 0x91, 0xc6, 0x2b, 0x8d, 0x2b,
                               0x21, 0x09, 0xc9, 0x02, 0x75, 0x28, 0x78, 0x16};
    const Bytes abc{std::byte{'a'}, std::byte{'b'}, std::byte{'c'}};
    EXPECT_EQ(content_hash(abc), expected);
}

}  // namespace
}  // namespace tactus::object_description_test
