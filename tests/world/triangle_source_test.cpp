#include "world/triangle_source.hpp"

#include <gtest/gtest.h>

#include <future>
#include <thread>

#include "core/tree/triangle_tree.hpp"

namespace tactus::triangle_source_test {
namespace {

TriangleMesh sheet(double height) {
    TriangleMesh mesh;
    mesh.vertices = {{0, 0, 0}, {1, height, 0}, {0, 0, 1}, {1, 0, 1}};
    mesh.triangles = {{0, 2, 1}, {1, 2, 3}};
    return mesh;
}

TEST(TriangleSource, IsReadOnceAndOnlyWhenAsked) {
    int reads = 0;
    TriangleSource source(
        [&reads] {
            ++reads;
            return sheet(0.0);
        },
        2);
    EXPECT_EQ(source.triangle_count(), 2u);
    EXPECT_EQ(reads, 0);
    EXPECT_EQ(source.triangles().error, "");
    source.built(Mat3(1.0), run_serially);
    EXPECT_EQ(reads, 1);
}

TEST(TriangleSource, SaysWhatIsWrongWithItsTriangles) {
    TriangleSource source([] { return TriangleMesh{}; }, 0);
    EXPECT_NE(source.triangles().error, "");
    EXPECT_EQ(source.triangles().mesh, nullptr);
}

TEST(TriangleSource, SaysWhyNothingCouldBeRead) {
    TriangleSource source([] { return TriangleSource::Read({}, "no scanner has been here"); }, 0);
    EXPECT_EQ(source.triangles().error, "no scanner has been here");
    EXPECT_EQ(source.triangles().mesh, nullptr);
}

TEST(TriangleSource, BodiesOfOneScaleShareATree) {
    TriangleSource source([] { return sheet(0.0); }, 2);
    const BuiltMesh first = source.built(Mat3(1.0), run_serially);
    const BuiltMesh second = source.built(Mat3(1.0), run_serially);
    const BuiltMesh twice = source.built(Mat3(2.0), run_serially);
    EXPECT_EQ(first.tree, second.tree);
    EXPECT_NE(first.tree, twice.tree);
    EXPECT_EQ(twice.mesh->vertices[3], Vec3(2.0, 0.0, 2.0));
}

TEST(TriangleSource, ATreeLivesAsLongAsABodyIsMadeOfIt) {
    TriangleSource source([] { return sheet(0.0); }, 2);
    std::weak_ptr<const TriangleTree> tree = source.built(Mat3(1.0), run_serially).tree;
    EXPECT_TRUE(tree.expired());
}

TEST(TriangleSource, AMirroredMeshKeepsItsOutside) {
    const TriangleMesh mirrored = scaled(sheet(0.0), Mat3(Vec3(-1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)));
    EXPECT_EQ(mirrored.triangles[0], (std::array<std::uint32_t, 3>{0, 1, 2}));
    EXPECT_EQ(mirrored.vertices[3], Vec3(-1.0, 0.0, 1.0));
}

TEST(TriangleSource, CornersThatMovedAreRefittedInATreeThatNobodyTouches) {
    const auto before = std::make_shared<TriangleSource>([] { return sheet(0.0); }, 2);
    BuiltMesh flat = before->built(Mat3(1.0), run_serially);
    const TriangleTree* const first = flat.tree.get();

    const auto second = std::make_shared<TriangleSource>([] { return sheet(0.5); }, 2);
    second->succeed(before);
    BuiltMesh high = second->built(Mat3(1.0), run_serially);
    EXPECT_NE(high.tree.get(), first) << "the first one is still touched";

    flat = {};
    TriangleSource third([] { return sheet(0.7); }, 2);
    third.succeed(second);
    EXPECT_EQ(third.built(Mat3(1.0), run_serially).tree.get(), first);
}

TEST(TriangleSource, OneThatIsStillBeingBuiltIsRefittedLater) {
    std::promise<void> begun, may_end;
    const auto before = std::make_shared<TriangleSource>(
        [&] {
            begun.set_value();
            may_end.get_future().wait();
            return sheet(0.0);
        },
        2);
    BuiltMesh flat;
    std::thread builder([&] { flat = before->built(Mat3(1.0), run_serially); });
    begun.get_future().wait();
    TriangleSource second([] { return sheet(0.5); }, 2);
    second.succeed(before);
    may_end.set_value();
    builder.join();
    const std::uint64_t refitted = TriangleSource::trees_refitted();
    EXPECT_NEAR(second.built(Mat3(1.0), run_serially).mesh->vertices[1].y, 0.5, 0.0);
    EXPECT_EQ(TriangleSource::trees_refitted(), refitted + 1);
}

TEST(TriangleSource, OtherTrianglesAreBuiltAnew) {
    const auto before = std::make_shared<TriangleSource>([] { return sheet(0.0); }, 2);
    std::shared_ptr<const TriangleTree> old = before->built(Mat3(1.0), run_serially).tree;
    TriangleSource other(
        [] {
            TriangleMesh mesh = sheet(0.0);
            mesh.triangles.pop_back();
            return mesh;
        },
        1);
    other.succeed(before);
    old.reset();
    const BuiltMesh built = other.built(Mat3(1.0), run_serially);
    EXPECT_EQ(built.mesh->triangles.size(), 1u);
}

TEST(KnownSources, AreReadByTheFirstWhoAsks) {
    KnownSources<int> known;
    int reads = 0;
    const auto make = [&reads] {
        ++reads;
        return std::make_shared<TriangleSource>([] { return sheet(0.0); }, 2);
    };
    std::shared_ptr<TriangleSource> first = known.get(1, nullptr, make);
    EXPECT_EQ(known.get(1, nullptr, make), first);
    EXPECT_NE(known.get(2, nullptr, make), first);
    EXPECT_EQ(reads, 2);
    first.reset();
    known.get(1, nullptr, make);
    EXPECT_EQ(reads, 3) << "nobody had it any more";
}

TEST(KnownSources, OfTwoWhoKnowOfAChangeTheFirstReadsAndTheOtherTakesIt) {
    KnownSources<int> known;
    const auto make = [] { return std::make_shared<TriangleSource>([] { return sheet(0.0); }, 2); };
    const std::shared_ptr<TriangleSource> before = known.get(1, nullptr, make);
    const std::shared_ptr<TriangleSource> now = known.get(1, before, make);
    EXPECT_NE(now, before);
    EXPECT_EQ(known.get(1, before, make), now);
}

std::shared_ptr<TriangleSource> sheet_source(double height) {
    return std::make_shared<TriangleSource>([height] { return sheet(height); }, 2);
}

TEST(OwnSource, IsMadeAnewAfterItWasForgotten) {
    OwnSource own;
    EXPECT_EQ(own.get(), nullptr);
    const auto first = sheet_source(0.0);
    own.set(first);
    EXPECT_EQ(own.get(), first);
    EXPECT_EQ(own.former(), nullptr);
    own.forget();
    EXPECT_EQ(own.get(), nullptr);
    EXPECT_EQ(own.former(), first);
    own.forget();
    EXPECT_EQ(own.former(), first) << "there was none since";
    own.set(sheet_source(1.0));
    EXPECT_EQ(own.former(), nullptr);
}

TEST(OwnSource, WhoeverSucceedsHasTheTreesOfTheOneBefore) {
    for (const bool is_forgotten : {false, true}) {
        OwnSource own;
        own.set(sheet_source(0.0));
        const BuiltMesh before = own.get()->built(Mat3(1.0), run_serially);
        if (is_forgotten) {
            own.forget();
        }
        own.succeed_by(sheet_source(1.0));
        const std::uint64_t refitted = TriangleSource::trees_refitted();
        own.get()->built(Mat3(1.0), run_serially);
        EXPECT_EQ(TriangleSource::trees_refitted(), refitted + 1);
    }
}

}  // namespace
}  // namespace tactus::triangle_source_test
