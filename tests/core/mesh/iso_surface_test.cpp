#include "core/mesh/iso_surface.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

#include "core/mesh/closed_mesh.hpp"
#include "core/mesh/mesh_check.hpp"
#include "shared/fields.hpp"
#include "shared/judge_tree.hpp"
#include "shared/mesh_volume.hpp"
#include "shared/random_values.hpp"

namespace tactus::iso_surface_test {
namespace {

using shared::OwnField;
using shared::RandomValues;
using shared::sampled;
using shared::volume;

using Size = std::array<std::uint32_t, 3>;

TriangleMesh surface_of(const OwnField& field) {
    IsoSurface surface = iso_surface(field.get());
    EXPECT_EQ(surface.error, "");
    EXPECT_EQ(check_mesh(surface.mesh), "");
    return std::move(surface.mesh);
}

std::size_t index(const Size& size, std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    return (std::size_t{z} * size[1] + y) * size[0] + x;
}

Vec3 place(const SampledField& field, std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    const Vec3 middle = 0.5 * (Vec3(field.size[0], field.size[1], field.size[2]) - 1.0);
    return field.spacing * (Vec3(x, y, z) - middle);
}

TEST(IsoSurface, ASphereOfAFewSamplesIsOneWithinATenthOfACell) {
    for (const double radius : {6.0, 10.0, 14.0}) {
        const TriangleMesh mesh = surface_of(
            sampled({32, 32, 32}, Vec3(1.0), [&](const Vec3& p) { return glm::length(p) - radius; }));
        EXPECT_TRUE(is_closed(mesh));
        for (const auto& [a, b, c] : mesh.triangles) {
            const Vec3& p = mesh.vertices[a];
            const Vec3& q = mesh.vertices[b];
            const Vec3& r = mesh.vertices[c];
            for (const Vec3& on : {p, 0.5 * (p + q), 0.5 * (q + r), 0.5 * (r + p), (p + q + r) / 3.0}) {
                ASSERT_NEAR(glm::length(on), radius, 0.1) << "radius " << radius;
            }
            ASSERT_GE(glm::dot(glm::cross(q - p, r - p), p), 0.0);  // seen from outside
        }
        EXPECT_NEAR(volume(mesh), 4.0 / 3.0 * std::numbers::pi * std::pow(radius, 3.0),
                    4.0 * std::numbers::pi * radius * radius * 0.1);
    }
}

// What is linear has a surface without any error, the sides at which it is cut off as well.
TEST(IsoSurface, AHalfSpaceIsCutOffAtTheBorderExactly) {
    const Vec3 normal = glm::normalize(Vec3(0.3, 0.9, -0.2));
    const Vec3 spacing(0.1, 0.25, 0.4);
    const OwnField field =
        sampled({9, 6, 5}, spacing, [&](const Vec3& p) { return glm::dot(normal, p) - 0.1; });
    const TriangleMesh mesh = surface_of(field);
    EXPECT_TRUE(is_closed(mesh));
    const Vec3 half = 0.5 * spacing * Vec3(8.0, 5.0, 4.0);
    // Below the plane, of a box that it cuts above all lower and below all upper corners.
    const double height = 0.1 / normal.y;
    EXPECT_NEAR(volume(mesh), 4.0 * half.x * half.z * (half.y + height), 1e-6);
    for (const Vec3& v : mesh.vertices) {
        const Vec3 beyond = glm::abs(v) - half;
        const double side = std::max({beyond.x, beyond.y, beyond.z});
        ASSERT_LE(side, 1e-12);
        ASSERT_LE(glm::dot(normal, v), 0.1 + 1e-6);
        ASSERT_TRUE(side > -1e-12 || std::abs(glm::dot(normal, v) - 0.1) < 1e-6);
    }
}

// Inside and outside of every sample, told by turns of the surface around it.
void expect_told_apart(const OwnField& own, const std::string& which) {
    const SampledField field = own.get();
    const TriangleMesh mesh = surface_of(own);
    ASSERT_TRUE(is_closed(mesh)) << which;
    for (std::uint32_t z = 1; z + 1 < field.size[2]; ++z) {
        for (std::uint32_t y = 1; y + 1 < field.size[1]; ++y) {
            for (std::uint32_t x = 1; x + 1 < field.size[0]; ++x) {
                const double value = own.values[index(field.size, x, y, z)];
                if (value != field.iso) {
                    const bool inside = field.inside_above ? value > field.iso : value < field.iso;
                    ASSERT_EQ(shared::winding(mesh, place(field, x, y, z)), inside ? 1 : 0)
                        << which << ": sample " << x << ", " << y << ", " << z;
                }
            }
        }
    }
}

TEST(IsoSurface, EveryCaseOfACellTellsItsCornersApart) {
    RandomValues random(1401);
    const Size size{4, 4, 4};
    for (unsigned bits = 1; bits < 256; ++bits) {
        for (int round = 0; round < 8; ++round) {
            OwnField field = sampled(size, Vec3(1.0), [](const Vec3&) { return 1.0; });
            for (unsigned c = 0; c < 8; ++c) {
                const double sign = bits >> c & 1u ? -1.0 : 1.0;
                field.values[index(size, 1 + (c & 1u), 1 + (c >> 1u & 1u), 1 + (c >> 2u))] =
                    static_cast<float>(sign * random.magnitude(0.01, 1.0));
            }
            expect_told_apart(field, "case " + std::to_string(bits));
        }
    }
}

TEST(IsoSurface, NoiseTellsItsSamplesApart) {
    RandomValues random(1402);
    for (int i = 0; i < 40; ++i) {
        OwnField field = sampled({7, 6, 8}, Vec3(0.5, 1.0, 2.0), [&](const Vec3&) {
            return i % 2 == 0 ? random.between(-1.0, 1.0) : static_cast<double>(random.below(5)) - 2.0;
        });
        field.field.inside_above = i % 4 >= 2;
        expect_told_apart(field, "noise " + std::to_string(i));
    }
}

// Whole numbers, as scanners give them, meet the iso-value at the samples: no triangle is without a size.
TEST(IsoSurface, ASurfaceThroughSamplesHasNoTriangleWithoutASize) {
    const TriangleMesh mesh = surface_of(sampled({17, 17, 17}, Vec3(1.0), [](const Vec3& p) {
        return std::abs(p.x) + std::abs(p.y) + std::abs(p.z) - 5.0;
    }));
    EXPECT_TRUE(is_closed(mesh));
    EXPECT_NEAR(volume(mesh), 4.0 / 3.0 * std::pow(5.0, 3.0), 1e-9);
    for (const auto& [a, b, c] : mesh.triangles) {
        const Vec3& p = mesh.vertices[a];
        ASSERT_GT(glm::length(glm::cross(mesh.vertices[b] - p, mesh.vertices[c] - p)), 1e-6);
    }
}

TEST(IsoSurface, DensitiesAreSolidAbove) {
    const auto distance = [](const Vec3& p) { return glm::length(p) - 0.3; };
    OwnField density = sampled({12, 12, 12}, Vec3(0.1), [&](const Vec3& p) { return 7.0 - distance(p); });
    density.field.iso = 7.0;
    density.field.inside_above = true;
    const double solid = volume(surface_of(density));
    EXPECT_NEAR(solid, volume(surface_of(sampled({12, 12, 12}, Vec3(0.1), distance))), 1e-5);
    EXPECT_GT(solid, 0.1);
}

TEST(IsoSurface, WhatIsNoFieldIsSaid) {
    const auto error_after = [](auto&& spoil) {
        OwnField field = sampled({4, 4, 4}, Vec3(0.1), [](const Vec3& p) { return glm::length(p) - 0.1; });
        spoil(field);
        const IsoSurface surface = iso_surface(field.get());
        EXPECT_TRUE(surface.mesh.triangles.empty());
        return surface.error;
    };
    const auto says = [](const std::string& error, const char* words) {
        EXPECT_NE(error.find(words), std::string::npos) << error;
    };
    says(error_after([](OwnField& f) { f.field.size = {0, 4, 4}; }), "two samples along an axis");
    says(error_after([](OwnField& f) { f.field.size = {4, 4, 1}; }), "two samples along an axis");
    says(error_after([](OwnField& f) { f.field.size = {5, 4, 4}; }), "64 values, and its size asks for 80");
    says(error_after([](OwnField& f) { f.field.size = {4096, 4096, 4096}; }), "134,217,728");
    says(error_after([](OwnField& f) { f.field.spacing.y = 0.0; }), "not a positive length");
    says(error_after([](OwnField& f) { f.field.spacing.z = std::numeric_limits<double>::quiet_NaN(); }),
         "not a positive length");
    says(error_after([](OwnField& f) { f.values[17] = std::numeric_limits<float>::quiet_NaN(); }),
         "value 17");
    says(error_after([](OwnField& f) { f.values[3] = std::numeric_limits<float>::infinity(); }), "value 3");
    says(error_after([](OwnField& f) { f.field.iso = -5.0; }), "one side of the iso-value -5");
    says(error_after([](OwnField& f) { f.field.iso = 5.0; }), "one side");
    says(error_after([](OwnField& f) { f.field.iso = std::numeric_limits<double>::quiet_NaN(); }),
         "iso-value");
}

}  // namespace
}  // namespace tactus::iso_surface_test
