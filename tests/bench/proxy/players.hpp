// Ours and the thesis's proxy, each as what a bench moves tick by tick.
#pragma once

#include <memory>
#include <optional>

#include "core/haptics/force_law.hpp"
#include "proxy/three_pass.hpp"
#include "shared/touch_rig.hpp"

namespace tactus::bench {

struct PlayedTick {
    Vec3 position;
    std::uint32_t status = 0;  // see ProxyStatus
    bool touching = false;     // something holds it back
};

class OurPlayer {
public:
    OurPlayer(std::shared_ptr<const TouchShape> shape, double radius, std::int64_t max_work) : rig_(radius) {
        ProxySettings settings = rig_.proxy.settings();
        settings.max_work = max_work;
        rig_.proxy.set_settings(settings);
        rig_.add(std::move(shape));
    }

    PlayedTick tick(const Vec3& hand) {
        const ProxyTick tick = rig_.tick(hand);
        const HandForce force = contact_force(rig_.scene, rig_.proxy.touching(), tick.slide, Vec3(0.0), 1e-3);
        return {tick.position, tick.status, force.contact_count > 0};
    }
    double bytes() const { return static_cast<double>(rig_.scene.parts()[0].part->tree()->bytes()); }

private:
    shared::TouchRig rig_;
};

// Begins where the hand is farther from the mesh than the radius for the first time, as ours does.
class ThreePassPlayer {
public:
    ThreePassPlayer(const shared::JudgeTree& tree, double radius, const Epsilons& epsilons)
        : tree_(tree), clearance_(radius + 2.0 * epsilons.base), proxy_(tree.mesh(), radius, epsilons) {}

    PlayedTick tick(const Vec3& hand) {
        if (!is_there_) {
            is_there_ = tree_.nearest(hand, 2.0 * clearance_).distance > clearance_;
            proxy_.put(hand);
            return {hand, proxy_absent, false};
        }
        const bool held = proxy_.move(hand);
        return {proxy_.position(), held ? std::uint32_t{proxy_touching} : 0u, held};
    }
    double bytes() const { return proxy_.bytes(); }

private:
    const shared::JudgeTree& tree_;
    double clearance_;
    ThreePassProxy proxy_;
    bool is_there_ = false;
};

}  // namespace tactus::bench
