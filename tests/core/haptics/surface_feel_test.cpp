// Materials of a mesh's surfaces, and images by its texture coordinates.
#include "core/haptics/surface_feel.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "core/haptics/force_law.hpp"
#include "core/haptics/surface_effects.hpp"
#include "shared/random_values.hpp"
#include "shared/touch_rig.hpp"

namespace tactus::surface_feel_test {
namespace {

using shared::TouchRig;

constexpr double radius = 0.01;

// A floor of two halves: x < 0 is surface 0, x > 0 is surface 1. Its texture coordinates are turned by a
// right angle and ten to the metre: u = 10 z, v = 10 x.
MeshShape two_halves() {
    auto mesh = std::make_shared<TriangleMesh>();
    auto map = std::make_shared<SurfaceMap>();
    for (const double x : {-1.0, 0.0, 1.0}) {
        mesh->vertices.emplace_back(x, 0.0, -1.0);
        mesh->vertices.emplace_back(x, 0.0, 1.0);
    }
    mesh->triangles = {{0, 1, 2}, {2, 1, 3}, {2, 3, 4}, {4, 3, 5}};
    map->surface = {0, 0, 1, 1};
    for (const auto& triangle : mesh->triangles) {
        SurfaceMap::Corners& corners = map->uv.emplace_back();
        for (std::size_t i = 0; i < 3; ++i) {
            const Vec3& corner = mesh->vertices[triangle[i]];
            corners[i] = {static_cast<float>(10.0 * corner.z), static_cast<float>(10.0 * corner.x)};
        }
    }
    return {mesh, 0.0, false, map};
}

std::shared_ptr<const TouchImage> ramp() {
    return std::make_shared<const TouchImage>(
        TouchImage{4, 2, {0.0f, 0.5f, 1.0f, 0.5f, 0.2f, 0.3f, 0.8f, 0.6f}});
}

// A hand pressed 2 mm into the floor.
struct Pressed {
    Pressed(const TouchMaterial& material, const TouchDetail& detail, const Pose& placed = {})
        : rig(radius), pose(placed) {
        TouchMaterial whole = material;
        whole.detail = &detail;
        rig.add(two_halves(), placed, whole);
    }
    HandForce at(const Vec3& place) {
        const Vec3 hand = to_parent(pose, place + Vec3(0.0, radius - 0.002, 0.0));
        rig.proxy.restart();
        rig.draw(to_parent(pose, place + Vec3(0.0, 2.0 * radius, 0.0)), hand, 4);
        return force(hand);
    }
    HandForce force(const Vec3& hand) {
        const ProxyTick tick = rig.tick(hand);
        HandForce force = contact_force(rig.scene, rig.proxy.touching(), tick.slide, Vec3(0.0), 1e-3);
        add_surface_effects(rig.scene, rig.proxy.touching(), {hand, Vec3(0.0)}, 0, 1e-3, memory, force);
        return force;
    }
    TouchRig rig;
    Pose pose;
    EffectMemory memory;
};

TEST(SurfaceFeel, EachSurfaceOfAMeshHasAMaterialOfItsOwn) {
    const TouchDetail detail{{}, {std::nullopt, SurfaceFeel{{900.0, 0.0, 0.0, 0.0}, {}}}};
    Pressed pressed({400.0, 0.0, 0.0, 0.0}, detail);
    EXPECT_NEAR(pressed.at({-0.5, 0.0, 0.3}).total.y, 400.0 * 0.002, 1e-4);
    EXPECT_NEAR(pressed.at({0.5, 0.0, 0.3}).total.y, 900.0 * 0.002, 1e-4);
}

TEST(SurfaceFeel, WhereNoneIsGivenItIsTheBodys) {
    for (const auto& surfaces :
         {std::vector<std::optional<SurfaceFeel>>{}, std::vector<std::optional<SurfaceFeel>>{std::nullopt}}) {
        const TouchDetail detail{{}, surfaces};
        Pressed pressed({400.0, 0.0, 0.0, 0.0}, detail);
        EXPECT_NEAR(pressed.at({0.5, 0.0, 0.3}).total.y, 400.0 * 0.002, 1e-4);
    }
}

TEST(SurfaceFeel, FrictionIsThatOfTheSurfaceTheHandIsOn) {
    const TouchDetail detail{
        {}, {SurfaceFeel{{500.0, 0.0, 0.2, 0.2}, {}}, SurfaceFeel{{500.0, 0.0, 0.7, 0.7}, {}}}};
    Pressed pressed({500.0, 0.0, 0.0, 0.0}, detail);
    pressed.at({-0.2, 0.0, 0.0});
    for (double x = -0.2; x < 0.2; x += 0.001) {
        const HandForce force = pressed.force({x, radius - 0.002, 0.0});
        if (x > -0.15 && std::abs(x) > 0.05) {  // it is drawn from where it stuck
            EXPECT_NEAR(-force.total.x / force.total.y, x < 0.0 ? 0.2 : 0.7, 5e-3) << x;
        }
    }
}

TEST(SurfaceFeel, AnImageLiesAsTheTextureCoordinatesSay) {
    const auto image = ramp();
    const TouchDetail detail{{image, nullptr}, {}};
    TouchMaterial material{500.0, 0.0, 0.0, 0.0};
    material.texture_depth = 0.001;
    material.by_uv = true;
    shared::RandomValues random(3);
    const Pose poses[] = {Pose{}, Pose{{0.2, 0.1, -0.3}, random.rotation()}};
    for (const Pose& pose : poses) {
        Pressed pressed(material, detail, pose);
        for (int i = 0; i < 50; ++i) {
            const Vec3 place(random.between(-0.9, 0.9), 0.0, random.between(-0.9, 0.9));
            const ImagePlace wanted{
                10.0 * place.z * 4.0, 10.0 * place.x * 2.0, {0.0, 0.0, 40.0}, {20.0, 0.0, 0.0}};
            const ImageSample relief = sample(*image, wanted, 0.001);
            const Vec3 force = direction_to_local(pose, pressed.at(place).total);
            EXPECT_NEAR(force.y, 500.0 * (0.002 + relief.value), 1e-3);
            EXPECT_NEAR(force.x, -500.0 * (0.002 + relief.value) * relief.gradient.x, 2e-3);
            EXPECT_NEAR(force.z, -500.0 * (0.002 + relief.value) * relief.gradient.z, 2e-3);
        }
    }
}

TEST(SurfaceFeel, AFrictionImageSaysHowMuchOfItThereIs) {
    const auto image = std::make_shared<const TouchImage>(TouchImage{1, 2, {1.0f, 0.25f}});
    const TouchDetail detail{{nullptr, image}, {}};
    TouchMaterial material{500.0, 0.0, 0.8, 0.8};
    material.by_uv = true;  // v = 10 x: rows of 50 mm
    Pressed pressed(material, detail);
    pressed.at({0.01, 0.0, 0.0});
    int seen = 0;
    for (double z = 0.0; z < 0.3; z += 0.001) {
        const HandForce force = pressed.force({0.01, radius - 0.002, z});
        if (z > 0.05) {
            const double x = pressed.rig.proxy.position().x;
            const double share = sample(*image, {0.0, 20.0 * x, Vec3(0.0), Vec3(0.0)}, 1.0).value;
            EXPECT_NEAR(-force.total.z / force.total.y, 0.8 * share, 5e-3);
            ++seen;
        }
    }
    EXPECT_GT(seen, 200);
}

TEST(SurfaceFeel, WithoutTextureCoordinatesAnImageLiesInTheFrame) {
    const auto image = ramp();
    TouchDetail detail{{image, nullptr}, {}};
    TouchMaterial material{500.0, 0.0, 0.0, 0.0};
    material.detail = &detail;
    material.texture_size = 0.3;
    const Vec3 point(0.11, 0.0, 0.07), up(0.0, 1.0, 0.0);
    for (const bool by_uv : {false, true}) {
        material.by_uv = by_uv;
        TouchRig rig(radius);
        const int box = rig.add(BoxShape{}, {}, material);
        const ImagePlace place =
            image_place(rig.scene, feel_at(rig.scene, box, {}), *image, box, {}, point, up);
        const ImagePlace wanted = place_in_frame(*image, 0.3, point, up);
        EXPECT_EQ(place.column, wanted.column);
        EXPECT_EQ(place.row, wanted.row);
    }
}

TEST(SurfaceFeel, ATriangleWithoutAnAreaHasAPlaceNevertheless) {
    const TriangleCorners needle{{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {2.0, 0.0, 0.0}};
    const ImagePlace place =
        place_by_uv(*ramp(), {{{0.5f, 0.25f}, {1.0f, 0.0f}, {0.0f, 1.0f}}}, needle, {0.5, 0.1, 0.0});
    EXPECT_EQ(place.column, 2.0);
    EXPECT_EQ(place.row, 0.5);
    EXPECT_EQ(place.along_columns, Vec3(0.0));
}

TEST(SurfaceFeel, AMapOfAnotherMeshIsRefused) {
    for (const bool cut_surface : {true, false}) {
        MeshShape shape = two_halves();
        auto map = std::make_shared<SurfaceMap>(*shape.surfaces);
        cut_surface ? map->surface.pop_back() : map->uv.pop_back();
        shape.surfaces = map;
        const PlacedShape placed{shape, {}};
        EXPECT_NE(make_touch_shape({&placed, 1}).error, "");
    }
    MeshShape shape = two_halves();
    auto map = std::make_shared<SurfaceMap>(*shape.surfaces);
    map->uv[1][2][0] = std::nanf("");
    shape.surfaces = map;
    const PlacedShape placed{shape, {}};
    EXPECT_NE(make_touch_shape({&placed, 1}).error.find("texture coordinates"), std::string::npos);
}

}  // namespace
}  // namespace tactus::surface_feel_test
