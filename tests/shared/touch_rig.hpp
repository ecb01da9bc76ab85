// A touch scene with one proxy in it, for tests and benches of the proxy alone: no device, no physics, no
// session.
#pragma once

#include <memory>
#include <vector>

#include "core/proxy/proxy.hpp"

namespace tactus::shared {

class TouchRig {
public:
    explicit TouchRig(double radius) : proxy(64, settings_for(radius)) {}

    int add(const Shape& shape, const Pose& pose = {}, const TouchMaterial& material = {}) {
        const PlacedShape placed{shape, {}};
        TouchShapeResult made = make_touch_shape({&placed, 1});
        if (!made.shape) {
            return -1;
        }
        return add(std::move(made.shape), pose, material);
    }
    int add(std::shared_ptr<const TouchShape> shape, const Pose& pose = {},
            const TouchMaterial& material = {}) {
        shapes_.push_back(std::move(shape));
        return scene.add(*shapes_.back(), pose, material, 1);
    }
    int add(const TriangleMesh& mesh, const Pose& pose = {}, const TouchMaterial& material = {}) {
        return add(Shape(MeshShape{std::make_shared<const TriangleMesh>(mesh)}), pose, material);
    }

    // One tick in which nothing but the hand moves.
    ProxyTick tick(const Vec3& hand) {
        scene.begin_tick();
        return proxy.move(scene, hand);
    }
    // One tick in which a body is somewhere else than before.
    ProxyTick tick(const Vec3& hand, int body, const Pose& pose) {
        scene.begin_tick();
        scene.set_pose(body, pose);
        return proxy.move(scene, hand);
    }
    // Straight from `from` to `to` in that many ticks.
    ProxyTick draw(const Vec3& from, const Vec3& to, int ticks) {
        ProxyTick last;
        for (int i = 1; i <= ticks; ++i) {
            last = tick(from + (to - from) * (static_cast<double>(i) / ticks));
        }
        return last;
    }

    TouchScene scene{32, 64};
    Proxy proxy;

private:
    static ProxySettings settings_for(double radius) {
        ProxySettings settings;
        settings.radius = radius;
        return settings;
    }

    std::vector<std::shared_ptr<const TouchShape>> shapes_;
};

}  // namespace tactus::shared
