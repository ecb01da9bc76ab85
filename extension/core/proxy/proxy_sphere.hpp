// The proxy's sphere at its place in a scene: what was found around it there, and how it goes on from there.
#pragma once

#include <cstdint>

#include "core/proxy/surroundings.hpp"

namespace tactus {

struct ProxySettings {
    double radius = 0.01;               // (unit: meters), > 0
    std::uint32_t mask = 0xffff'ffffu;  // layers it touches
    int max_steps = 64;                 // a tick; what is missing then is made up in the next
    std::int64_t max_work = 18'000;     // a tick (see WorkBudget): about 0.3 ms
};

struct ProxySphere {
    ProxySphere(std::size_t max_parts, const ProxySettings& given)
        : settings(given), surroundings(max_parts) {}

    // Elsewhere, without a sweep.
    void put(const Vec3& place);
    // Along the way as far as it is known to be free. The body `except` is not in the way; `stopped_by` is
    // what it ends at, where something does.
    Hit advance(const Vec3& motion, FeatureId& stopped_by, int except = -1);

    ContactLook look() { return surroundings.look_from(position); }
    WorkBudget& work() { return surroundings.work(); }
    const Tolerances& tolerances() const { return surroundings.tolerances(); }

    ProxySettings settings;
    Surroundings surroundings;
    const TouchScene* scene = nullptr;  // of this tick
    Vec3 position{0.0};                 // of its centre, in the world (unit: meters)
    ContactList contacts;               // as they were found last
    bool contacts_hold = false;         // they are those at its position
};

}  // namespace tactus
