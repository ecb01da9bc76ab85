#include "world/mesh_collector.hpp"

#include <gtest/gtest.h>

#include <cstring>

namespace tactus::mesh_collector_test {
namespace {

const std::vector<PackedPlace> two_triangles = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0},
                                                {0, 1, 0}, {1, 0, 0}, {1, 1, 0}};

template <class T>
std::vector<std::uint8_t> bytes_of(const std::vector<T>& values) {
    std::vector<std::uint8_t> bytes(values.size() * sizeof(T));
    std::memcpy(bytes.data(), values.data(), bytes.size());
    return bytes;
}

TEST(MeshCollector, CornersAtOnePlaceBecomeOneVertex) {
    MeshCollector collector;
    collector.add(two_triangles, {});
    const TriangleMesh mesh = collector.take();
    EXPECT_EQ(mesh.vertices.size(), 4u);
    ASSERT_EQ(mesh.triangles.size(), 2u);
}

TEST(MeshCollector, FrontFacesAreTurned) {
    MeshCollector collector;
    collector.add(two_triangles, {});
    const TriangleMesh mesh = collector.take();
    EXPECT_EQ(mesh.vertices[mesh.triangles[0][1]], Vec3(0.0, 1.0, 0.0));
    EXPECT_EQ(mesh.vertices[mesh.triangles[0][2]], Vec3(1.0, 0.0, 0.0));
}

TEST(MeshCollector, ZeroAndMinusZeroAreOnePlace) {
    MeshCollector collector;
    collector.add(
        std::vector<PackedPlace>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-0.0f, 0, -0.0f}, {0, 1, 0}, {2, 0, 0}},
        {});
    EXPECT_EQ(collector.take().vertices.size(), 4u);
}

TEST(MeshCollector, SurfacesComeTogetherAtTheirSeams) {
    MeshCollector collector;
    collector.add({two_triangles.data(), 3}, {});
    collector.add({two_triangles.data() + 3, 3}, {});
    EXPECT_EQ(collector.take().vertices.size(), 4u);
}

TEST(MeshCollector, AnIndexWithoutACornerStaysOne) {
    MeshCollector collector;
    collector.add({two_triangles.data(), 3}, std::vector<std::int32_t>{0, 1, 7, 0, 1, -1});
    const TriangleMesh mesh = collector.take();
    ASSERT_EQ(mesh.triangles.size(), 2u);
    EXPECT_EQ(mesh.triangles[0][1], 0xffff'ffffu);
    EXPECT_EQ(mesh.triangles[1][1], 0xffff'ffffu);
}

TEST(MeshCollector, CornersThatAreNoTriangleAreLeftOut) {
    MeshCollector collector;
    collector.add({two_triangles.data(), 5}, {});
    EXPECT_EQ(collector.take().triangles.size(), 1u);
}

TEST(SurfaceBytes, PlainPlacesAndBothWidthsOfIndices) {
    const std::vector<std::uint8_t> corners = bytes_of(two_triangles);
    const std::vector<std::int32_t> wide = {0, 1, 2, 3, 4, 5};
    const std::vector<std::uint16_t> narrow = {0, 1, 2, 3, 4, 5};
    for (const std::vector<std::uint8_t>& indices : {bytes_of(wide), bytes_of(narrow)}) {
        const SurfaceBytes bytes{corners, indices, 6, 6, false, {}, {}};
        EXPECT_TRUE(is_whole(bytes));
        EXPECT_EQ(read_corners(bytes), two_triangles);
        EXPECT_EQ(read_indices(bytes), wide);
    }
}

TEST(SurfaceBytes, CompressedPlacesAreSharesOfTheBox) {
    const std::vector<std::uint8_t> corners =
        bytes_of(std::vector<std::uint16_t>{0, 65535, 0, 9, 65535, 0, 65535, 9});
    const SurfaceBytes bytes{corners, {}, 2, 0, true, {1, 2, 3}, {10, 20, 30}};
    EXPECT_TRUE(is_whole(bytes));
    EXPECT_EQ(read_corners(bytes), (std::vector<PackedPlace>{{1, 22, 3}, {11, 2, 33}}));
    EXPECT_TRUE(read_indices(bytes).empty());
}

TEST(SurfaceBytes, TooFewAreNotWhole) {
    const std::vector<std::uint8_t> bytes(71);
    EXPECT_FALSE(is_whole({bytes, {}, 6, 0, false, {}, {}}));
    EXPECT_TRUE(is_whole({bytes, {}, 5, 0, false, {}, {}}));
    EXPECT_FALSE(is_whole({bytes, {bytes.data(), 3}, 5, 1, false, {}, {}}));
}

TEST(LateSurface, AreReadTogetherWhenSomebodyAsks) {
    int reads = 0;
    const auto surface = [&reads](float z) {
        return LateSurface{2, [&reads, z](MeshCollector& collector) {
                               ++reads;
                               std::vector<PackedPlace> corners = two_triangles;
                               for (PackedPlace& corner : corners) {
                                   corner[2] = z;
                               }
                               collector.add(corners, {});
                           }};
    };
    const std::shared_ptr<TriangleSource> source = source_of({surface(0.0f), surface(1.0f)});
    EXPECT_EQ(source->triangle_count(), 4u);
    EXPECT_EQ(reads, 0);
    EXPECT_EQ(source->triangles().mesh->vertices.size(), 8u);
    EXPECT_EQ(reads, 2);
}

}  // namespace
}  // namespace tactus::mesh_collector_test
