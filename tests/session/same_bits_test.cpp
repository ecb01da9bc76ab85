// The same touch gives the same bits on every platform. What is recorded as "bits" here is held against what
// this machine's own program records when another platform's tests are run (tools/testing/same_bits.py).
//
// Nothing here asks the C library for more than a square root: of sines each has its own opinion.
#include <string>

#include "core/math/bit_hash.hpp"
#include "session_rig.hpp"

namespace tactus::same_bits_test {
namespace {

using namespace session_test;

// Over [-1, 1]², as smooth as triangles are.
TriangleMesh hills() {
    constexpr std::uint32_t cells = 24;
    TriangleMesh mesh;
    for (std::uint32_t z = 0; z <= cells; ++z) {
        for (std::uint32_t x = 0; x <= cells; ++x) {
            const double u = 2.0 * x / cells - 1.0, v = 2.0 * z / cells - 1.0;
            mesh.vertices.push_back({u, 0.06 * (u * u * u - u) * (1.0 - 3.0 * v * v), v});
        }
    }
    for (std::uint32_t z = 0; z < cells; ++z) {
        for (std::uint32_t x = 0; x < cells; ++x) {
            const std::uint32_t corner = z * (cells + 1) + x, below = corner + cells + 1;
            mesh.triangles.push_back({corner, below, corner + 1});
            mesh.triangles.push_back({corner + 1, below, below + 1});
        }
    }
    return mesh;
}

// A point that goes around the unit circle, by one turn after the other.
class Turning {
public:
    explicit Turning(double tangent_of_half_step)
        : cosine_((1.0 - tangent_of_half_step * tangent_of_half_step) /
                  (1.0 + tangent_of_half_step * tangent_of_half_step)),
          sine_(2.0 * tangent_of_half_step / (1.0 + tangent_of_half_step * tangent_of_half_step)) {}
    void step() {
        const double x = cosine_ * x_ - sine_ * y_;
        y_ = sine_ * x_ + cosine_ * y_;
        x_ = x;
    }
    double x() const { return x_; }
    double y() const { return y_; }

private:
    double cosine_, sine_;
    double x_ = 1.0, y_ = 0.0;
};

struct Outcome {
    std::uint64_t bits = 0;
    int touching = 0;
    double box_moved = 0.0;
};

// A finger goes around over the hills and pushes a tower of boxes, a ball and a capsule about.
Outcome run() {
    SessionRig rig;
    BodyAddition ground =
        body(MeshShape{std::make_shared<const TriangleMesh>(hills())}, Vec3(0.0), Motion::Static);
    ground.touch_material = {800.0, 1.0, 0.5, 0.4};
    rig.add(ground);
    std::vector<SessionHandle> moving;
    for (int i = 0; i < 4; ++i) {
        moving.push_back(
            rig.add(body(BoxShape{Vec3(0.08)}, {0.4, 0.2 + 0.17 * i, 0.0}, Motion::Dynamic, 0.3)));
    }
    moving.push_back(rig.add(body(SphereShape{0.07}, {0.0, 0.2, 0.4}, Motion::Dynamic, 0.3)));
    moving.push_back(rig.add(body(CapsuleShape{0.05, 0.1}, {-0.4, 0.3, 0.0}, Motion::Dynamic, 0.3)));
    ProxyDescription description;
    description.device = rig.hand;
    description.settings.radius = 0.02;
    rig.session.set_proxy(rig.proxy, description);

    Outcome outcome;
    BitHash hash;
    Turning around(0.001), up_and_down(0.004);
    Vec3 start(0.0);
    for (int i = 0; i < 3'000; ++i) {
        around.step();
        up_and_down.step();
        rig.device.position = {0.4 * around.x(), 0.04 + 0.1 * up_and_down.y(), 0.4 * around.y()};
        rig.device.velocity = {-0.8 * around.y(), 0.8 * up_and_down.x(), 0.8 * around.x()};
        hash.add(static_cast<std::uint64_t>(rig.tick()));
        hash.add(rig.device.force);
        outcome.touching += glm::length(rig.device.force) > 0.0;
        start = i == 0 ? rig.state_of(moving[0])->pose.position : start;
        for (const SessionHandle body : moving) {
            hash.add(rig.state_of(body)->pose.position);
            hash.add(rig.state_of(body)->pose.rotation);
        }
    }
    outcome.bits = hash.value();
    outcome.box_moved = glm::length(rig.state_of(moving[0])->pose.position - start);
    return outcome;
}

TEST(SameBits, OfATouchAmongThingsThatMove) {
    const Outcome outcome = run();
    EXPECT_GT(outcome.touching, 300);
    EXPECT_GT(outcome.box_moved, 0.01);
    EXPECT_EQ(run().bits, outcome.bits);
    RecordProperty("bits", std::to_string(outcome.bits));
}

}  // namespace
}  // namespace tactus::same_bits_test
