#include <gtest/gtest.h>

#include "core/haptics/force_law.hpp"
#include "core/proxy/proxy.hpp"
#include "shared/meshes.hpp"
#include "shared/touch_rig.hpp"
#include "support/realtime_audit.hpp"

namespace tactus::proxy_realtime_test {
namespace {

TEST(ProxyRealtime, ATickAllocatesLocksAndCallsNothing) {
    shared::TouchRig rig(0.02);
    const TouchMaterial rough{500.0, 1.0, 0.5, 0.4};
    rig.add(shared::terrain(64, 2.0, 0.1), {}, rough);
    const int box = rig.add(shared::box(Vec3(0.1)), {Vec3(0.0, 0.3, 0.0), Quat(1.0, 0.0, 0.0, 0.0)}, rough);
    rig.add(CapsuleShape{0.05, 0.2}, {Vec3(0.3, 0.1, 0.2), Quat(1.0, 0.0, 0.0, 0.0)}, rough);
    testing::AuditScope audit;
    int contacts = 0;
    for (int i = 0; i < 3'000; ++i) {
        const Vec3 hand(0.8 * std::sin(0.003 * i), 0.2 * std::sin(0.02 * i), 0.7 * std::cos(0.0023 * i));
        const Pose pose{Vec3(0.4 * std::cos(0.004 * i), 0.1, 0.3), Quat(1.0, 0.0, 0.0, 0.0)};
        const ProxyTick tick = rig.tick(hand, box, pose);
        contacts += contact_force(rig.scene, rig.proxy.touching(), tick.slide, Vec3(0.0), 1e-3).contact_count;
    }
    rig.scene.remove(box);
    rig.tick(Vec3(0.0));
    audit.finish();
    EXPECT_EQ(audit.allocations() + audit.frees(), 0u) << audit.describe();
    EXPECT_EQ(audit.locks() + audit.waits() + audit.system_calls(), 0u) << audit.describe();
    EXPECT_GT(contacts, 500);
}

}  // namespace
}  // namespace tactus::proxy_realtime_test
