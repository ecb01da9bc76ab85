// Who judges the proxy is held against what is slower still, and against cases whose answer is known.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "shared/bench_kit.hpp"
#include "shared/free_way.hpp"
#include "shared/judge_tree.hpp"
#include "shared/meshes.hpp"
#include "shared/random_values.hpp"
#include "shared/rough_meshes.hpp"
#include "shared/rough_paths.hpp"
#include "shared/stress_judge.hpp"

namespace tactus::judges_test {
namespace {

using shared::FreeWay;
using shared::JudgeTree;
using shared::RandomValues;

TEST(JudgeTree, FindsTheNearestTriangleOfSoupsAndSlivers) {
    RandomValues random(71);
    TriangleMesh mesh = shared::soup(200, 1.0, 7);
    for (int i = 0; i < 50; ++i) {  // slivers, down to none at all
        const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
        const Vec3 a = random.in_ball(1.0);
        const Vec3 b = random.in_ball(1.0);
        const double width = i % 5 ? random.magnitude(1e-18, 1e-2) : 0.0;
        mesh.vertices.insert(mesh.vertices.end(),
                             {a, b, a + (b - a) * random.unit() + random.in_ball(1.0) * width});
        mesh.triangles.push_back({first, first + 1, first + 2});
    }
    const JudgeTree tree(mesh);
    for (int i = 0; i < 500; ++i) {
        const Vec3 p = random.in_ball(1.5);
        const auto distance = static_cast<double>(shared::slow_distance(p, mesh));
        EXPECT_NEAR(tree.nearest(p, 9.0).distance, distance, 1e-14);
        EXPECT_EQ(tree.nearest(p, 0.5 * distance).distance, 0.5 * distance);
        std::vector<std::uint32_t> within;
        tree.within(p, 1.5 * distance, within);
        std::size_t expected = 0;
        for (std::size_t k = 0; k < mesh.triangles.size(); ++k) {
            expected += shared::slow_distance(p, shared::corners_of(mesh, k)) <= 1.5 * distance;
        }
        EXPECT_EQ(within.size(), expected);
    }
}

TEST(JudgeTree, FollowsCornersThatMove) {
    TriangleMesh mesh = shared::icosphere(2, 1.0);
    JudgeTree tree(mesh);
    for (Vec3& v : mesh.vertices) {
        v = 2.0 * v + Vec3(1.0, 0.0, 0.0);
    }
    tree.moved();
    const Vec3 p(0.3, 0.4, 0.1);
    EXPECT_NEAR(tree.nearest(p, 9.0).distance, static_cast<double>(shared::slow_distance(p, mesh)), 1e-14);
}

TEST(JudgeTree, SeesWhereAWayGoesThrough) {
    const TriangleMesh mesh = shared::box(Vec3(1.0));
    const JudgeTree tree(mesh);
    EXPECT_NEAR(tree.first_crossing({3.0, 0.1, 0.2}, {-4.0, 0.0, 0.0}), 0.5, 1e-15);
    EXPECT_EQ(tree.first_crossing({3.0, 0.1, 0.2}, {-1.9, 0.0, 0.0}), 2.0);
    EXPECT_EQ(tree.first_crossing({3.0, 1.1, 0.2}, {-9.0, 0.0, 0.0}), 2.0);
    // Exactly through the edge that two triangles share.
    EXPECT_NEAR(tree.first_crossing({3.0, 0.0, 0.0}, {-4.0, 0.0, 0.0}), 0.5, 1e-15);
}

// A wall with a hole in it.
TriangleMesh pierced_wall(double half_hole) {
    TriangleMesh mesh;
    mesh.vertices = {{-1, 0, -1}, {1, 0, -1}, {1, 0, 1}, {-1, 0, 1}};
    for (const Vec3& corner : {Vec3(-1, 0, -1), Vec3(1, 0, -1), Vec3(1, 0, 1), Vec3(-1, 0, 1)}) {
        mesh.vertices.push_back(half_hole * corner);
    }
    for (std::uint32_t i = 0; i < 4; ++i) {
        const std::uint32_t next = (i + 1) % 4;
        mesh.triangles.push_back({i, next, i + 4});
        mesh.triangles.push_back({next, next + 4, i + 4});
    }
    return mesh;
}

TEST(FreeWay, LeadsThroughAHoleThatIsWideEnoughOnly) {
    constexpr double radius = 0.1;
    const Vec3 above(0.35, 0.11, 0.1);
    const Vec3 below(0.35, -0.11, 0.1);
    const TriangleMesh wide = pierced_wall(0.13);
    const TriangleMesh narrow = pierced_wall(0.05);
    const JudgeTree through(wide);
    const JudgeTree shut(narrow);
    EXPECT_FALSE(is_straight_way_free(through, above, below, radius));
    EXPECT_TRUE(is_straight_way_free(through, above, above + Vec3(0.1, 0.05, 0.0), radius));
    EXPECT_EQ(find_free_way(through, above, below, radius, below, 0.7), FreeWay::found);
    EXPECT_EQ(find_free_way(shut, above, below, radius, below, 0.7), FreeWay::none);
    // Around the wall's rim, if the hand is that far off.
    EXPECT_EQ(find_free_way(shut, above, below, radius, below, 1.5), FreeWay::found);
}

TEST(FreeWay, LeavesNoClosedMesh) {
    const TriangleMesh mesh = shared::icosphere(3, 1.0);
    const JudgeTree tree(mesh);
    EXPECT_EQ(find_free_way(tree, {0.85, 0.0, 0.0}, {1.15, 0.0, 0.0}, 0.1, {1.2, 0.0, 0.0}, 0.5),
              FreeWay::none);
}

TEST(BodyJudge, KnowsMeshesBoxesAndBallsWhereverTheyStand) {
    const Vec3 half(0.3, 0.2, 0.4);
    const TriangleMesh mesh = shared::box(half);
    const JudgeTree tree(mesh);
    shared::BodyJudge by_mesh = shared::BodyJudge::of_mesh(tree);
    shared::BodyJudge by_box = shared::BodyJudge::of_box(half);
    shared::BodyJudge by_ball = shared::BodyJudge::of_ball(0.3);
    RandomValues random(91);
    for (int i = 0; i < 200; ++i) {
        const Pose pose{random.in_ball(3.0), random.rotation()};
        const Vec3 local = random.in_ball(1.0);
        for (shared::BodyJudge* const judge : {&by_mesh, &by_box, &by_ball}) {
            judge->place(pose);
            judge->changed();
        }
        const Vec3 p = to_parent(pose, local);
        EXPECT_NEAR(by_ball.distance(p, 2.0), glm::length(local) - 0.3, 1e-14);
        if (by_box.distance(p, 2.0) > 0.0) {
            EXPECT_NEAR(by_box.distance(p, 2.0), by_mesh.distance(p, 2.0), 1e-14);
        } else {
            EXPECT_TRUE(glm::all(glm::lessThanEqual(glm::abs(local), half)));
        }
    }
}

TEST(BodyJudge, SparesLooksOnlyWhereNothingCanHaveComeNear) {
    const TriangleMesh mesh = shared::icosphere(2, 1.0);
    const JudgeTree tree(mesh);
    shared::BodyJudge judge = shared::BodyJudge::of_mesh(tree);
    RandomValues random(92);
    Vec3 p(1.3, 0.0, 0.0);
    for (int i = 0; i < 5'000; ++i) {
        p += random.in_ball(0.01) - 0.002 * (p - Vec3(1.2, 0.0, 0.0));
        const bool near = tree.nearest(p, 9.0).distance < 0.1;
        EXPECT_EQ(judge.distance(p, 0.1) < 0.1, near);
    }
    EXPECT_GT(judge.spared, 1'000u);
    EXPECT_GT(judge.looks, 20u);
    EXPECT_EQ(judge.bound_faults, 0u);
}

TEST(BodyJudge, ExcusesUntilTheSphereIsClear) {
    shared::BodyJudge judge = shared::BodyJudge::of_ball(1.0);
    judge.excuse();
    EXPECT_FALSE(judge.is_penetrated({1.05, 0.0, 0.0}, 0.1));
    EXPECT_TRUE(judge.is_excused());
    EXPECT_FALSE(judge.is_penetrated({1.2, 0.0, 0.0}, 0.1));
    EXPECT_TRUE(judge.is_penetrated({1.05, 0.0, 0.0}, 0.1));
}

TEST(SideJudge, SeesAPassUnlessItIsExcusedInBetween) {
    shared::SideJudge judge;
    EXPECT_FALSE(judge.has_passed(1));
    EXPECT_TRUE(judge.has_passed(0));
    EXPECT_FALSE(judge.has_passed(0));
    EXPECT_FALSE(judge.has_passed(std::nullopt));  // beyond the surface's end
    EXPECT_FALSE(judge.has_passed(1));
    judge.excuse();
    EXPECT_FALSE(judge.has_passed(0));
    EXPECT_TRUE(judge.has_passed(1));
}

TEST(Bench, ChoosesCasesByTheBeginningOfTheirNames) {
    EXPECT_TRUE(shared::is_chosen("rough_gear_100_r0.2_walk", ""));
    EXPECT_TRUE(shared::is_chosen("rough_gear_100_r0.2_walk", "rough_gear"));
    EXPECT_TRUE(shared::is_chosen("rough_gear_100_r0.2_walk", "rough_*_r0.2"));
    EXPECT_FALSE(shared::is_chosen("rough_gear_100_r0.2_walk", "rough_*_r0.05"));
    EXPECT_FALSE(shared::is_chosen("rough_gear", "rough_gear_1"));
    EXPECT_TRUE(shared::is_chosen("rough_gear_", "rough_gear_100", false));
    EXPECT_FALSE(shared::is_chosen("rough_gear_", "rough_scan", false));
}

// Closed: every edge has two sides, in opposite directions.
bool has_two_sides_at_every_edge(const TriangleMesh& mesh) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> forth, back;
    for (const auto& t : mesh.triangles) {
        for (std::size_t k = 0; k < 3; ++k) {
            forth.emplace_back(t[k], t[(k + 1) % 3]);
            back.emplace_back(t[(k + 1) % 3], t[k]);
        }
    }
    std::ranges::sort(forth);
    std::ranges::sort(back);
    return forth == back;
}

TEST(Bench, OfNothingLeavesTheLastFigures) {
    const std::filesystem::path file =
        std::filesystem::path(::testing::TempDir()) / "tactus_figures_of_nothing.json";
    shared::Report figures;
    figures.set("case.tick_p99_us", 2.5);
    ASSERT_TRUE(figures.write_json(file));
    const auto size = std::filesystem::file_size(file);
    EXPECT_FALSE(shared::Report().write_json(file));
    EXPECT_EQ(std::filesystem::file_size(file), size);
    std::filesystem::remove(file);
}

TEST(RoughMeshes, AreWhatTheySay) {
    for (const TriangleMesh& mesh :
         {shared::blobs(20, 1), shared::branches(32, 0), shared::displaced(3), shared::shell(3),
          shared::rounded_box(4), shared::gear(600), shared::graded(24, 40), shared::cavity(3)}) {
        EXPECT_TRUE(has_two_sides_at_every_edge(mesh)) << mesh.triangles.size();
    }
    EXPECT_FALSE(has_two_sides_at_every_edge(shared::scanned(3)));
    for (const TriangleMesh& mesh : {shared::scanned(3), shared::clustered(2, 100)}) {
        Vec3 size(0.0);
        for (const Vec3& v : mesh.vertices) {
            size = glm::max(size, glm::abs(v));
        }
        EXPECT_NEAR(std::max({size.x, size.y, size.z}), 0.5, 1e-12);
    }
}

TEST(RoughPaths, StartWithRoomAndGoOnEvenly) {
    const TriangleMesh mesh = shared::blobs(20, 0);
    const JudgeTree tree(mesh);
    for (const shared::RoughPath& path : shared::rough_paths()) {
        const std::vector<Vec3> way = path.make(tree, 0.05, 2'000);
        ASSERT_EQ(way.size(), 2'000u) << path.name;
        EXPECT_GT(tree.nearest(way[0], 9.0).distance, 0.05) << path.name;
        int near = 0;
        for (std::size_t i = 1; i < way.size(); ++i) {
            EXPECT_LT(glm::distance(way[i - 1], way[i]), 0.021) << path.name;
            near += tree.nearest(way[i], 9.0).distance < 0.05;
        }
        EXPECT_GT(near, 200) << path.name;
    }
}

}  // namespace
}  // namespace tactus::judges_test
