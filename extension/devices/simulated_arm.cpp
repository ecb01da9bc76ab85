#include "devices/simulated_arm.hpp"

namespace tactus {

// With h = seconds / 2 and the mean velocity u = v + h a, the middle is at x + h u:
//     m a = k (p - x - h u) + d (p' - u) + F
//     <=>  a (m + h d + h^2 k) = k (p - x - h v) + d (p' - v) + F.
ArmState step_arm(const ArmSettings& arm, const ArmState& from, const HandSample& intended, const Vec3& force,
                  double seconds) {
    const double h = 0.5 * seconds;
    const Vec3 pull = arm.stiffness * (intended.position - from.position - h * from.velocity) +
                      arm.damping * (intended.velocity - from.velocity) + force;
    const Vec3 acceleration = pull / (arm.mass + h * arm.damping + h * h * arm.stiffness);
    return {from.position + seconds * (from.velocity + h * acceleration),
            from.velocity + seconds * acceleration};
}

DeviceSample SimulatedArm::read(Nanoseconds now) {
    if (changed_.refresh()) {
        settings_ = changed_.front();
    }
    const Nanoseconds time = clock_.at(now);
    if (!started_) {
        started_ = true;
        read_at_ = now;
        const HandSample first = sample_path(path_, 0);
        arm_ = {first.position, first.velocity};
    }
    if (now > read_at_) {
        const HandSample intended = sample_path(path_, time - (now - read_at_) / 2);
        arm_ = step_arm(settings_, arm_, intended, force_, to_seconds(now - read_at_));
        read_at_ = now;
    }
    DeviceSample sample;
    sample.position = arm_.position;
    sample.velocity = arm_.velocity;
    sample.connected = true;
    return sample;
}

}  // namespace tactus
