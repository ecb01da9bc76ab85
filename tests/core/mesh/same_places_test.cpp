#include "core/mesh/same_places.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "shared/meshes.hpp"

namespace tactus::same_places_test {
namespace {

TEST(SamePlaces, TheFirstStandsForAllAndMinusZeroIsZero) {
    const std::vector<Vec3> vertices{Vec3(1.0), Vec3(0.0), Vec3(1.0), Vec3(-0.0), Vec3(1.0 + 1e-15)};
    EXPECT_EQ(same_places(vertices), (std::vector<std::uint32_t>{0, 1, 0, 1, 4}));
}

// Each is looked for among the others before it: in one step, not in as many as there are.
TEST(SamePlaces, NumbersThatAreNoneAreOnePlace) {
    const Vec3 none(std::numeric_limits<double>::quiet_NaN());
    const std::vector<std::uint32_t> first = same_places(std::vector<Vec3>(300'000, none));
    EXPECT_EQ(first, std::vector<std::uint32_t>(300'000, 0));
}

TEST(SamePlaces, AMeshOfLooseTrianglesIsMerged) {
    const TriangleMesh whole = shared::icosphere(3, 1.0);
    TriangleMesh loose;
    for (const auto& triangle : whole.triangles) {
        const auto first = static_cast<std::uint32_t>(loose.vertices.size());
        for (const std::uint32_t corner : triangle) {
            loose.vertices.push_back(whole.vertices[corner]);
        }
        loose.triangles.push_back({first, first + 1, first + 2});
    }
    TriangleMesh merged = loose;
    merge_places(merged);
    EXPECT_EQ(merged.vertices.size(), whole.vertices.size());
    ASSERT_EQ(merged.triangles.size(), whole.triangles.size());
    for (std::size_t t = 0; t < whole.triangles.size(); ++t) {
        for (std::size_t k = 0; k < 3; ++k) {
            EXPECT_EQ(merged.vertices[merged.triangles[t][k]], whole.vertices[whole.triangles[t][k]]);
        }
    }
}

TEST(SamePlaces, AnIndexWithoutAVertexStaysOne) {
    TriangleMesh mesh{{Vec3(0.0), Vec3(0.0), Vec3(1.0)}, {{0, 1, 7}}};
    merge_places(mesh);
    EXPECT_EQ(mesh.vertices.size(), 2u);
    EXPECT_GE(mesh.triangles[0][2], mesh.vertices.size());
}

}  // namespace
}  // namespace tactus::same_places_test
