#include "world/seen_library.hpp"

#include <gtest/gtest.h>

#include "shared/meshes.hpp"

namespace tactus::seen_library_test {
namespace {

constexpr Vec3 half{0.05, 0.1, 0.15};  // of a box of six litres

TriangleSource::Checked read(const Vec3& half_extents) {
    return {std::make_shared<TriangleMesh>(shared::box(half_extents)), {}};
}

SightedObject seen_as(std::int32_t mesh) {
    SightedObject object;
    object.id = 7;
    object.mesh = mesh;
    return object;
}

TEST(SeenLibrary, TheSensorIsGivenWhatCouldBeReadInItsOrder) {
    SeenLibrary library;
    library.add("cube", read(half), 0.3);
    library.add("broken", {nullptr, "broken.obj: line 1"}, 0.2);
    library.add("ball", read(2.0 * half), 0.0);
    const std::vector<KnownMesh> known = library.known();
    ASSERT_EQ(known.size(), 2u);
    EXPECT_STREQ(known[0].name, "cube");
    EXPECT_STREQ(known[1].name, "ball");
    EXPECT_EQ(known[0].mass, 0.3);
    EXPECT_EQ(known[1].mesh.vertices.size(), shared::box(half).vertices.size());
    EXPECT_EQ(library.error(), "broken.obj: line 1");
    EXPECT_EQ(SeenLibrary().error(), "");
}

TEST(SeenLibrary, AKnownObjectIsAsTheLibraryHasIt) {
    SeenLibrary library;
    library.add("cube", read(half), 0.3);
    const SeenForm form = library.form_of(seen_as(0));
    EXPECT_TRUE(form.is_known());
    EXPECT_EQ(form.known, "cube");
    EXPECT_EQ(form.name, "cube_7");
    EXPECT_EQ(form.mass, 0.3);
    EXPECT_EQ(form.mesh->triangles, shared::box(half).triangles);
}

TEST(SeenLibrary, OfUnknownMassItIsOfWater) {
    SeenLibrary library;
    library.add("cube", read(half), 0.0);
    EXPECT_NEAR(library.form_of(seen_as(0)).mass, 6.0, 1e-9);
}

TEST(SeenLibrary, WhatNobodyKnowsIsItsHull) {
    SeenLibrary library;
    library.add("cube", read(half), 0.3);
    const TriangleMesh hull = shared::box(2.0 * half);
    for (const std::int32_t none : {-1, 1, 1000}) {
        SightedObject object = seen_as(none);
        object.hull = {hull.vertices, hull.triangles};
        const SeenForm form = library.form_of(object);
        EXPECT_FALSE(form.is_known());
        EXPECT_EQ(form.name, "unknown_7");
        EXPECT_NEAR(form.mass, 48.0, 1e-9);
        EXPECT_EQ(form.mesh->vertices, hull.vertices);
        EXPECT_EQ(library.name_of(none), "unknown");
    }
}

TEST(SeenLibrary, NothingWeighsNothing) {
    EXPECT_EQ(SeenLibrary().form_of(seen_as(-1)).mass, 1e-3);
}

}  // namespace
}  // namespace tactus::seen_library_test
