// A body of a scene and its twin: made, told, shown, and taken out.
#include "world/body_twin.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/geometry/surface_query.hpp"

namespace tactus::body_twin_test {
namespace {

BodyPlan box_plan(Motion motion = Motion::Dynamic) {
    BodyPlan plan;
    plan.form.shapes = {PlacedShape{BoxShape{Vec3(0.1)}, Pose{}}};
    plan.form.touchable = true;
    plan.values.motion = motion;
    plan.may_move = motion == Motion::Dynamic;
    return plan;
}

// A sheet with a bump, of 2 n² triangles.
TriangleMesh sheet(std::uint32_t n, double height) {
    TriangleMesh mesh;
    for (std::uint32_t z = 0; z <= n; ++z) {
        for (std::uint32_t x = 0; x <= n; ++x) {
            mesh.vertices.emplace_back(x * 0.01, x == n / 2 && z == n / 2 ? height : 0.0, z * 0.01);
        }
    }
    for (std::uint32_t z = 0; z < n; ++z) {
        for (std::uint32_t x = 0; x < n; ++x) {
            const std::uint32_t i = z * (n + 1) + x;
            mesh.triangles.push_back({i, i + n + 1, i + 1});
            mesh.triangles.push_back({i + 1, i + n + 1, i + n + 2});
        }
    }
    return mesh;
}

BodyPlan mesh_plan(std::uint32_t n, double height, const BodyPlan* before = nullptr) {
    auto source = std::make_shared<TriangleSource>([n, height] { return sheet(n, height); }, 2u * n * n);
    if (before != nullptr) {
        source->succeed(before->form.meshes.front().source);
    }
    BodyPlan plan;
    plan.form.meshes = {MeshDraft{source, Mat3(1.0), Pose{}, 0.0, false, "'Sheet': "}};
    plan.form.touchable = true;
    return plan;
}

struct Scene {
    explicit Scene(std::uint32_t max_bodies = 16) : session(settings(max_bodies)) {}
    static SessionSettings settings(std::uint32_t max_bodies) {
        SessionSettings settings;
        settings.max_bodies = max_bodies;
        settings.physics.gravity = Vec3(0.0);
        return settings;
    }
    bool add(BodyTwin& twin, BodyPlan plan) {
        twin.plan(std::move(plan), workers);
        workers.wait();
        return twin.take_ready(session, ticks + 1);
    }
    void tick(int count = 1) {
        for (int i = 0; i < count; ++i) {
            session.collect();
            session.tick(static_cast<Nanoseconds>(ticks++) * 1'000'000);
        }
        session.refresh();
    }
    const BodyState* state_of(const BodyTwin& twin) {
        const SessionSnapshot& snapshot = session.snapshot();
        return tactus::state_of(snapshot.bodies, snapshot.body_count, twin.handle());
    }

    Workers workers;
    Session session;
    std::uint64_t ticks = 0;
};

TEST(BodyTwin, AFewTrianglesAreThereAtOnce) {
    Scene scene;
    BodyTwin twin;
    EXPECT_TRUE(twin.plan(box_plan(), scene.workers));
    EXPECT_TRUE(twin.take_ready(scene.session, 1));
    EXPECT_NE(twin.handle(), no_handle);
    EXPECT_FALSE(twin.is_building());
    EXPECT_TRUE(twin.problems().empty());
}

TEST(BodyTwin, ManyTrianglesAreBuiltByTheWorkers) {
    Scene scene;
    BodyTwin twin;
    EXPECT_FALSE(twin.plan(mesh_plan(40, 0.01), scene.workers));
    EXPECT_TRUE(twin.is_building());
    scene.workers.wait();
    EXPECT_EQ(twin.handle(), no_handle) << "nobody has taken it yet";
    EXPECT_TRUE(twin.take_ready(scene.session, 1));
    EXPECT_NE(twin.touch(), nullptr);
}

TEST(BodyTwin, WhatIsBuiltIsNotAddedOnceItIsNotWanted) {
    Scene scene;
    BodyTwin twin;
    twin.plan(mesh_plan(40, 0.01), scene.workers);
    twin.remove(scene.session);
    scene.workers.wait();
    EXPECT_FALSE(twin.take_ready(scene.session, 1));
    EXPECT_EQ(twin.handle(), no_handle);
}

TEST(BodyTwin, MovedCornersAreADeformationOfTheSameTwin) {
    Scene scene;
    BodyTwin twin;
    const BodyPlan flat = mesh_plan(8, 0.0);
    ASSERT_TRUE(scene.add(twin, flat));
    const SessionHandle handle = twin.handle();
    const std::uint64_t revision = twin.revision();
    EXPECT_FALSE(scene.add(twin, mesh_plan(8, 0.02, &flat)));
    EXPECT_EQ(twin.handle(), handle);
    EXPECT_NE(twin.revision(), revision) << "it is to be described anew";
}

BodyPlan soft_plan(double stiffness) {
    SoftDescription description;
    description.source = std::make_shared<TriangleSource>([] { return sheet(4, 0.0); }, 32u);
    description.form = SoftDescription::Form::sheet;
    description.material.stiffness = stiffness;
    BodyPlan plan;
    plan.form.soft = std::make_shared<SoftPlan>(std::move(description));
    plan.form.touchable = true;
    return plan;
}

TEST(BodyTwin, WhatGivesStaysTheSameTwinWhenItIsMadeOfAnotherMaterial) {
    Scene scene;
    BodyTwin twin;
    ASSERT_TRUE(scene.add(twin, soft_plan(1e4)));
    const SessionHandle handle = twin.handle();
    const std::uint64_t revision = twin.revision();
    EXPECT_FALSE(scene.add(twin, soft_plan(2e4)));
    EXPECT_EQ(twin.handle(), handle);
    EXPECT_NE(twin.revision(), revision);
}

TEST(BodyTwin, WhatGivesIsAnotherTwinInAnotherForm) {
    Scene scene;
    BodyTwin twin;
    ASSERT_TRUE(scene.add(twin, soft_plan(1e4)));
    const std::uint64_t revision = twin.revision();
    EXPECT_TRUE(scene.add(twin, box_plan(Motion::Static)));
    EXPECT_NE(twin.revision(), revision);
    EXPECT_EQ(twin.addition().soft, nullptr);
}

// As a camera's does, thirty times a second, on a machine that takes longer to build one.
TEST(BodyTwin, AFormThatChangesFasterThanItIsBuiltGetsOn) {
    Scene scene;
    BodyTwin twin;
    constexpr std::uint32_t n = 40;
    std::vector<BodyPlan> plans = {mesh_plan(n, 0.01)};
    for (const double height : {0.02, 0.03}) {
        plans.push_back(mesh_plan(n, height, &plans.back()));
    }
    const std::uint64_t refitted = TriangleSource::trees_refitted();
    for (const BodyPlan& plan : plans) {
        EXPECT_FALSE(twin.plan(plan, scene.workers));
    }
    scene.workers.wait();
    EXPECT_TRUE(twin.take_ready(scene.session, 1)) << "the first is touched, though it is out of date";
    const SessionHandle handle = twin.handle();
    EXPECT_TRUE(twin.is_building());
    scene.workers.wait();
    EXPECT_FALSE(twin.take_ready(scene.session, 1));
    EXPECT_EQ(twin.handle(), handle) << "the last is a deformation of it";
    EXPECT_FALSE(twin.is_building());
    EXPECT_EQ(TriangleSource::trees_refitted(), refitted + 1);
    const SurfaceHit top = nearest_surface(*twin.touch(), Pose{}, {0.005 * n, 0.1, 0.005 * n}, 1.0);
    EXPECT_NEAR(top.point.y, 0.03, 1e-9);
}

TEST(BodyTwin, AnotherMassIsAnotherTwin) {
    Scene scene;
    BodyTwin twin;
    ASSERT_TRUE(scene.add(twin, box_plan()));
    const std::uint64_t revision = twin.revision();
    BodyPlan heavier = box_plan();
    heavier.makings.mass = 3.0;
    EXPECT_TRUE(scene.add(twin, heavier));
    EXPECT_NE(twin.revision(), revision);
    EXPECT_EQ(twin.addition().description.mass, 3.0);
}

TEST(BodyTwin, ValuesReachTheLoopWithoutAnotherTwin) {
    Scene scene;
    BodyTwin twin;
    ASSERT_TRUE(scene.add(twin, box_plan()));
    const SessionHandle handle = twin.handle();
    std::uint64_t revision = twin.revision();
    BodyValues values = twin.values();
    twin.set_values(scene.session, values);
    EXPECT_EQ(twin.revision(), revision) << "nothing has changed";
    values.layers.layer = 4;
    values.gravity_scale = 0.5;
    twin.set_values(scene.session, values);
    EXPECT_EQ(twin.handle(), handle);
    EXPECT_NE(std::exchange(revision, twin.revision()), twin.revision());
    EXPECT_EQ(twin.addition().description.gravity_scale, 0.5);
    values.constant_force = {1.0, 0.0, 0.0};
    twin.set_values(scene.session, values);
    EXPECT_EQ(twin.revision(), revision) << "a far side is not told of forces";
    scene.tick(1000);
    ASSERT_NE(scene.state_of(twin), nullptr);
    EXPECT_NEAR(scene.state_of(twin)->linear_velocity.x, 1.0, 1e-2) << "1 N on 1 kg for a second";
}

TEST(BodyTwin, AForceThatWasThereFromTheBeginningActs) {
    Scene scene;
    BodyTwin twin;
    BodyPlan plan = box_plan();
    plan.values.constant_force = {0.0, 2.0, 0.0};
    ASSERT_TRUE(scene.add(twin, plan));
    scene.tick(500);
    EXPECT_NEAR(scene.state_of(twin)->linear_velocity.y, 1.0, 1e-2);
}

TEST(BodyTwin, ItStandsWhereItHasGoneWhileItWasBuilt) {
    Scene scene;
    BodyTwin twin;
    ASSERT_TRUE(scene.add(twin, box_plan()));
    BodyPlace now;
    now.pose.position = {5.0, 0.0, 0.0};
    now.linear_velocity = {0.0, 0.0, 0.25};
    twin.stand_at(scene.session, now);
    scene.tick(2);
    EXPECT_NEAR(scene.state_of(twin)->pose.position.x, 5.0, 1e-9);
    EXPECT_NEAR(scene.state_of(twin)->linear_velocity.z, 0.25, 1e-3);
}

TEST(BodyTwin, IsShownOnceAndWithWhatWasSent) {
    Scene scene;
    BodyTwin twin;
    BodyPlan plan = box_plan();
    plan.place.linear_velocity = {1.0, 0.0, 0.0};
    ASSERT_TRUE(scene.add(twin, plan));
    scene.tick(3);
    const auto shown_tick = [&scene] { return scene.session.snapshot().tick; };
    const BodyState first = *scene.state_of(twin);
    EXPECT_TRUE(twin.has_news(first, shown_tick()));
    const double x = twin.take(first).pose.position.x;
    EXPECT_FALSE(twin.has_news(first, shown_tick())) << "it is shown already";
    twin.write_place(scene.session, {{x + 2.0, 7.0, 0.0}}, 0b0011, true);
    // One that has not heard of it yet, and the first one that has.
    BodyState late = *scene.state_of(twin);
    late.changed_at += 1;
    ASSERT_TRUE(twin.has_news(late, shown_tick()));
    const Vec3 expected = late.pose.position + Vec3(2.0, 7.0, 0.0);
    EXPECT_NEAR(glm::distance(twin.take(late).pose.position, expected), 0.0, 1e-9);
    scene.tick(2);  // the first one's change has the number that was made up
    ASSERT_TRUE(twin.has_news(*scene.state_of(twin), shown_tick()));
    EXPECT_NEAR(twin.take(*scene.state_of(twin)).pose.position.y, 7.0, 1e-9) << "it is counted twice";
}

// What is written is relative to what has been seen, and what is not written goes on.
TEST(BodyTwin, CitizenWhatIsWrittenLateLeavesTheRestAsItIsByThen) {
    Scene scene;
    BodyTwin twin;
    BodyPlan plan = box_plan();
    plan.place.linear_velocity = {1.0, 0.0, 0.0};
    ASSERT_TRUE(scene.add(twin, plan));
    scene.tick(3);
    const Vec3 seen = twin.take(*scene.state_of(twin)).pose.position;
    scene.tick(100);
    twin.write_place(scene.session, {seen + Vec3(0.5, 2.0, 0.0)}, 0b0011, true);
    twin.write_velocity(scene.session, {9.0, 3.0, 9.0}, Vec3(0.0), 0b000010);
    scene.tick();
    const BodyState now = *scene.state_of(twin);
    EXPECT_NEAR(now.pose.position.x - seen.x, 0.6, 0.01) << "it has moved on by 0.1 m meanwhile";
    EXPECT_NEAR(now.pose.position.y, seen.y + 2.0, 0.01);
    EXPECT_NEAR(now.linear_velocity.x, 1.0, 0.02);
    EXPECT_NEAR(now.linear_velocity.y, 3.0, 0.02);
    EXPECT_EQ(now.linear_velocity.z, 0.0);
    twin.take(now);
    scene.tick(100);
    twin.write_place(scene.session, {{0.0, -4.0, 0.0}}, 0b0010, false);
    scene.tick();
    EXPECT_NEAR(scene.state_of(twin)->pose.position.y, -4.0, 0.01) << "a place that is meant as it is";
    EXPECT_GT(scene.state_of(twin)->pose.position.x, now.pose.position.x + 0.05);
}

TEST(BodyTwin, OneThatFindsNoPlaceSaysSo) {
    Scene scene(1);
    BodyTwin first, second;
    ASSERT_TRUE(scene.add(first, box_plan()));
    EXPECT_FALSE(scene.add(second, box_plan()));
    ASSERT_EQ(second.problems().size(), 1u);
    EXPECT_NE(second.problems().front().find("limit of 1 bodies"), std::string::npos)
        << second.problems().front();
}

TEST(BodyTwin, WhatCannotBeTouchedSaysWhy) {
    Scene scene;
    BodyTwin twin;
    BodyPlan plan;
    const auto nothing = std::make_shared<TriangleSource>([] { return TriangleMesh{}; }, 0);
    plan.form.meshes = {MeshDraft{nothing, Mat3(1.0), Pose{}, 0.0, false, "'Hull': "}};
    plan.form.problems = {"one of its shapes is no surface"};
    EXPECT_FALSE(scene.add(twin, plan));
    ASSERT_EQ(twin.problems().size(), 2u);
    EXPECT_EQ(twin.problems().front(), "one of its shapes is no surface");
    EXPECT_EQ(twin.problems().back().rfind("'Hull': ", 0), 0u) << twin.problems().back();
    EXPECT_EQ(twin.handle(), no_handle);
}

TEST(BodyForm, IsTheSameOrAnother) {
    const BodyForm form = box_plan().form;
    BodyForm other = form;
    EXPECT_TRUE(same_form(form, other));
    other.shapes.front().pose.position.x = 0.1;
    EXPECT_FALSE(same_form(form, other));
    other = form;
    other.shapes.front().shape = SphereShape{0.1};
    EXPECT_FALSE(same_form(form, other));
    const BodyPlan mesh = mesh_plan(2, 0.0);
    BodyForm scaled = mesh.form;
    EXPECT_TRUE(same_form(mesh.form, scaled));
    scaled.meshes.front().scaling = Mat3(2.0);
    EXPECT_FALSE(same_form(mesh.form, scaled));
}

TEST(BodyForm, TouchesTheMeshAndCollidesByItsShapes) {
    BodyPlan plan = box_plan();
    plan.form.touched = mesh_plan(4, 0.01).form.meshes;
    const BuiltBody built = build_body(plan, run_serially);
    ASSERT_TRUE(built.buildable);
    EXPECT_EQ(built.addition.description.shapes.size(), 1u);
    EXPECT_EQ(built.addition.touch_shapes.size(), 1u);
    EXPECT_EQ(built.addition.touch->parts.size(), 1u);
}

TEST(BodyForm, AnOpenMeshIsNotTouchedFromOneSide) {
    BodyPlan plan = mesh_plan(4, 0.01);
    plan.form.meshes.front().one_sided = true;
    const BuiltBody built = build_body(plan, run_serially);
    ASSERT_EQ(built.problems.size(), 1u);
    EXPECT_NE(built.problems.front().find("touched from both sides"), std::string::npos);
    EXPECT_TRUE(built.buildable);
}

}  // namespace
}  // namespace tactus::body_twin_test
