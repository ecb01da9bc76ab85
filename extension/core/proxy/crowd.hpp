// Crowds: where thousands of triangles are about as near as the one that is touched, so that to ask for all
// of them takes longer than a tick.
#pragma once

#include <algorithm>
#include <cstdint>

#include "core/proxy/constrained_step.hpp"
#include "core/proxy/proxy_sphere.hpp"

namespace tactus {

// Where a crowd has held the sphere last, and how.
struct CrowdHold {
    // How the step that was held is asked next.
    enum class Next : std::uint8_t {
        anew,     // by a question's share of the work, or where it is the same one, by all of it
        on,       // as far as a tick's work takes it, and on from there in the next
        no_more,  // it has been asked to its end
    };

    double slope = 0.0;  // by which the next step rises; above 0: in a crowd
    Vec3 place{0.0};     // of the sphere's centre, in the world (unit: meters)
    Vec3 step{0.0};      // that it was to go (unit: meters)
    Next next = Next::anew;
    Vec3 pull{0.0};  // on: to the hand, when it was held (unit: meters)
};

// No question of the surroundings takes more than a quarter of a tick's work, or than three usual ones take:
// one that would is asked in another way.
inline std::int64_t question_share(std::int64_t max_work) {
    constexpr std::int64_t least_share = 1'000;
    return std::max(max_work / 4, least_share);
}

class Crowd {
public:
    const CrowdHold& hold() const { return hold_; }
    // How far a sweep had come is not remembered.
    void recall(const CrowdHold& hold);
    void leave() { hold_ = {}; }
    // What a long sweep goes along may not be there any more.
    void scene_has_changed() { hold_.next = CrowdHold::Next::anew; }

    bool is_around() const { return hold_.slope > 0.0; }
    double slope() const { return hold_.slope; }
    // A question has taken more than its share.
    void enter();

    void begin_tick() { slope_before_ = hold_.slope; }
    // What the next tick begins with. `way` is how far this one has led, `pull` what leads to the hand now
    // (unit: meters).
    void end_tick(const ProxySphere& sphere, double way, const Vec3& pull, bool is_unfinished);

    // Lifts a step over the crowd; it ends no farther from the hand than `distance`, but for a little (unit:
    // meters).
    void step_over(ConstrainedStep& step, const Vec3& pull, ProxySphere& sphere, double distance) const;
    // As far as the step is known to be free. `start` is where the tick began.
    Hit sweep(ProxySphere& sphere, const ConstrainedStep& step, const Vec3& start, FeatureId& stopped_by);
    // Whether this very step has been asked to its end.
    bool has_answered(const ConstrainedStep& step, const ProxySphere& sphere) const {
        return hold_.next == CrowdHold::Next::no_more && is_asked_again(step, sphere);
    }

    // Whether the step that was held is asked on in this tick. It no longer is where that leads elsewhere by
    // now.
    bool goes_on(const ProxySphere& sphere, const Vec3& pull) {
        return hold_.next == CrowdHold::Next::on && leads_on(sphere, pull);
    }
    // Asks on. Returns how far that has led (unit: meters): nowhere before it is done.
    double go_on(ProxySphere& sphere);

private:
    bool leads_on(const ProxySphere& sphere, const Vec3& pull);
    bool is_asked_again(const ConstrainedStep& step, const ProxySphere& sphere) const;

    CrowdHold hold_;
    double slope_before_ = 0.0;  // this tick
    LongSweep long_sweep_;       // of the step that was held last
};

}  // namespace tactus
