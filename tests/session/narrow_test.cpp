// A body of which it becomes known what can be touched of it, while it is touched.
#include <glm/geometric.hpp>

#include "session_rig.hpp"
#include "shared/meshes.hpp"
#include "support/realtime_audit.hpp"

namespace tactus::narrow_test {
namespace {

using namespace session_test;
using testing::AuditScope;

constexpr double radius = 0.1;

BodyAddition lump(const TriangleMesh& mesh) {
    BodyAddition addition =
        body(MeshShape{std::make_shared<const TriangleMesh>(mesh)}, Vec3(0.0), Motion::Static);
    addition.touch = make_touch_shape(addition.description.shapes).shape;
    return addition;
}

struct Rig : SessionRig {
    Rig() {
        ProxyDescription pointer;
        pointer.device = hand;
        pointer.settings.radius = radius;
        session.set_proxy(proxy, pointer);
        session.settle();
    }
    Vec3 at() {
        session.refresh();
        return session.snapshot().proxies[0].position;
    }
};

TEST(NarrowTouch, TheHandFeelsNothingOfIt) {
    const BodyAddition rough = lump(shared::rough_sphere(4, 0.5, 1.0));
    const auto narrower = narrowed(*rough.touch, radius);
    ASSERT_NE(narrower, nullptr);
    Rig rig, other;
    const SessionHandle body = rig.add(rough);
    other.add(rough);
    double farthest = 0.0, strongest = 0.0;
    for (int i = 0; i < 400; ++i) {
        if (i == 200) {
            rig.session.narrow_touch(body, narrower, radius);
        }
        const Vec3 place = (i < 20 ? 0.7 : 0.45) * glm::normalize(Vec3(0.002 * i, 1.0, 0.001 * i));
        for (Rig* const one : {&rig, &other}) {
            one->device.position = place;
            AuditScope audit;
            one->tick();
        }
        farthest = std::max(farthest, glm::distance(rig.at(), other.at()));
        strongest = std::max(strongest, glm::length(rig.device.force));
    }
    EXPECT_GT(strongest, 1.0);
    EXPECT_LT(farthest, 1e-3 * radius);
}

TEST(NarrowTouch, WhatIsNotTakenIsGivenBack) {
    Rig rig;
    const BodyAddition first = lump(shared::icosphere(2, 0.3)), second = lump(shared::icosphere(2, 0.3));
    const SessionHandle body = rig.add(first), gone = rig.add(second);
    rig.session.settle();
    rig.session.remove_body(gone);
    const auto of_another = std::make_shared<const TouchShape>(*second.touch);
    const auto of_this = std::make_shared<const TouchShape>(*first.touch);
    rig.session.narrow_touch(body, of_another, radius);
    rig.session.narrow_touch(gone, of_another, radius);
    rig.session.narrow_touch(body, of_this, radius);
    rig.session.narrow_touch(body, of_this, -1.0);
    rig.session.narrow_touch(body, nullptr, radius);
    rig.tick();
    rig.session.collect();
    EXPECT_EQ(of_another.use_count(), 1);
    EXPECT_EQ(of_this.use_count(), 2);
    EXPECT_EQ(first.touch.use_count(), 1) << "its former shape comes back";
}

// A closed mesh that can be touched from both sides: who is inside stays there.
TEST(NarrowTouch, WhoIsInsideStaysInside) {
    Rig rig;
    const BodyAddition hollow = lump(shared::rough_sphere(4, 0.5, 1.0));
    const SessionHandle body = rig.add(hollow);
    rig.session.settle();
    rig.ticks(10);
    const auto narrower = narrowed(*hollow.touch, radius);
    ASSERT_NE(narrower, nullptr);
    rig.session.narrow_touch(body, narrower, radius);
    rig.tick();
    rig.draw({0.9, 0.0, 0.0}, 400);
    EXPECT_LT(glm::length(rig.at()), 0.5);
    EXPECT_GT(glm::length(rig.device.force), 10.0);
}

}  // namespace
}  // namespace tactus::narrow_test
