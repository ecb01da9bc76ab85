// The proxy's sphere at its place in a scene: what was found around it there, and how it goes on from there.
#pragma once

#include <cstdint>

#include "core/proxy/proxy_settings.hpp"
#include "core/proxy/surroundings.hpp"

namespace tactus {

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
