// Coulomb friction of the proxy: what holds it along the surfaces that hold it back (laws in friction.hpp).
#pragma once

#include "core/proxy/constrained_step.hpp"
#include "core/proxy/proxy_sphere.hpp"

namespace tactus {

class SlideFriction {
public:
    bool is_sliding() const { return sliding_; }  // dynamic friction applies
    void set_sliding(bool sliding) { sliding_ = sliding; }
    double speed() const { return speed_; }  // that it goes by, see friction.hpp (unit: meters per second)
    void recall(bool sliding, double speed) {
        sliding_ = sliding;
        speed_ = speed;
    }

    // What friction leaves of a step from where the sphere is. It has no say in how far down the surface is,
    // which the sphere is `dropped` above at most (unit: meters). False where there is none.
    bool brake(ConstrainedStep& step, const ProxySphere& sphere, double dropped);
    // After a tick, so many seconds long, in which the sphere has gone `way` (unit: meters) on the surfaces
    // of its last step.
    void heed_speed(const ConstrainedStep& step, const ProxySphere& sphere, const Vec3& way, double seconds);

private:
    double limit(const ConstrainedStep& step, const ProxySphere& sphere, double dropped) const;

    bool sliding_ = false;
    double speed_ = 0.0;
};

}  // namespace tactus
