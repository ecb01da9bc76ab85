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
    const TriangleMesh mesh = collector.take().mesh;
    EXPECT_EQ(mesh.vertices.size(), 4u);
    ASSERT_EQ(mesh.triangles.size(), 2u);
}

TEST(MeshCollector, FrontFacesAreTurned) {
    MeshCollector collector;
    collector.add(two_triangles, {});
    const TriangleMesh mesh = collector.take().mesh;
    EXPECT_EQ(mesh.vertices[mesh.triangles[0][1]], Vec3(0.0, 1.0, 0.0));
    EXPECT_EQ(mesh.vertices[mesh.triangles[0][2]], Vec3(1.0, 0.0, 0.0));
}

TEST(MeshCollector, ZeroAndMinusZeroAreOnePlace) {
    MeshCollector collector;
    collector.add(
        std::vector<PackedPlace>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-0.0f, 0, -0.0f}, {0, 1, 0}, {2, 0, 0}},
        {});
    EXPECT_EQ(collector.take().mesh.vertices.size(), 4u);
}

TEST(MeshCollector, SurfacesComeTogetherAtTheirSeams) {
    MeshCollector collector;
    collector.add({two_triangles.data(), 3}, {});
    collector.add({two_triangles.data() + 3, 3}, {});
    EXPECT_EQ(collector.take().mesh.vertices.size(), 4u);
}

TEST(MeshCollector, AnIndexWithoutACornerStaysOne) {
    MeshCollector collector;
    collector.add({two_triangles.data(), 3}, std::vector<std::int32_t>{0, 1, 7, 0, 1, -1});
    const TriangleMesh mesh = collector.take().mesh;
    ASSERT_EQ(mesh.triangles.size(), 2u);
    EXPECT_EQ(mesh.triangles[0][1], 0xffff'ffffu);
    EXPECT_EQ(mesh.triangles[1][1], 0xffff'ffffu);
}

// What names vertices by their numbers, as a pin does, means those that the engine has.
TEST(MeshCollector, CitizenVerticesAreFoundByTheNumbersThatTheEngineHas) {
    MeshCollector collector;
    collector.add(two_triangles, {});
    collector.add(two_triangles, {});
    const TriangleSource::Read read = collector.take();
    ASSERT_EQ(read.merged.size(), 2 * two_triangles.size());
    for (std::size_t i = 0; i < read.merged.size(); ++i) {
        const PackedPlace& place = two_triangles[i % two_triangles.size()];
        EXPECT_EQ(read.mesh.vertices[read.merged[i]], Vec3(place[0], place[1], place[2])) << i;
    }
}

TEST(TriangleStrip, CitizenEverySecondTriangleIsTurnedAndJointsAreLeftOut) {
    using List = std::vector<std::int32_t>;
    EXPECT_EQ(triangles_of_strip({}, 5), (List{0, 1, 2, 1, 3, 2, 2, 3, 4}));
    const List joined = {7, 8, 9, 9, 4, 4, 5, 6};
    EXPECT_EQ(triangles_of_strip(joined, 10), (List{7, 8, 9, 4, 6, 5})) << "the sixth is turned as well";
    EXPECT_TRUE(triangles_of_strip({}, 2).empty());
}

TEST(MeshCollector, CornersThatAreNoTriangleAreLeftOut) {
    MeshCollector collector;
    collector.add({two_triangles.data(), 5}, {});
    EXPECT_EQ(collector.take().mesh.triangles.size(), 1u);
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
