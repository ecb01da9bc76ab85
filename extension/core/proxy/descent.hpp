// One tick's way of the proxy to the hand, or as near as the surfaces let it be: look around, plan a step,
// go, until nothing is left to go or to spend.
#pragma once

#include <glm/geometric.hpp>

#include "core/proxy/constrained_step.hpp"
#include "core/proxy/crowd.hpp"
#include "core/proxy/proxy_sphere.hpp"
#include "core/proxy/slide_friction.hpp"
#include "core/proxy/step_trust.hpp"

namespace tactus {

// What holds a proxy back, from one tick to the next.
struct ProxyHold {
    TouchList touching;  // the contacts that hold it back, with their pressure
    SlideFriction friction;
    Crowd crowd;
};

struct DescentEnd {
    int steps = 0;
    double residual = 0.0;  // length of the step that would come next (unit: meters)
    Vec3 slide{0.0};        // pull along the surfaces that friction holds (unit: meters)
    bool is_unfinished = false;
    bool overlaps = false;  // a surface
};

class Descent {
public:
    // `given_way`: of the hand and of what carries the proxy since the last tick (unit: meters).
    Descent(ProxySphere& sphere, ProxyHold& hold, const Vec3& hand, double given_way);

    // `seconds`: of the tick.
    DescentEnd go(double seconds);

private:
    const Tolerances& tolerances() const { return sphere_.tolerances(); }
    double radius() const { return sphere_.settings.radius; }

    void go_on_through_crowd();
    bool plan_next();
    bool lift();
    // Nothing holds it back, or nothing is left to go.
    bool is_end() const {
        return step_.pressing_count == 0 || glm::length(step_.motion) <= tolerances().step;
    }
    void hold_back();
    void keep_touching();
    bool arrives();
    Hit take();
    Hit sweep(FeatureId& stopped_by);
    void conclude(double seconds);

    // descent_plan.cpp
    bool look_around();
    void plan();
    void plan_in_share();

    // descent_arrival.cpp
    bool has_come_to_rest(const Vec3& from);
    bool settles();
    bool stays_on_planes();
    bool finds_same_planes();
    void leave_slide();
    bool drops_onto_one();
    bool leads_clear_of_others(const Vec3& way);

    ProxySphere& sphere_;
    ProxyHold& hold_;
    const Vec3 hand_;
    const Vec3 start_;       // where the tick began
    const double distance_;  // and how far that was from the hand (unit: meters)
    StepTrust trust_;

    ConstrainedStep step_;  // the next one, or the last
    Vec3 pull_{0.0};        // to the hand, from where it begins (unit: meters)
    double beyond_ = 0.0;   // how far above a surface the last step may have ended (unit: meters)
    double dropped_ = 0.0;  // the same, where it led along one
    DescentEnd end_;
    bool slid_ = false;
    bool touched_ = false;       // something has held it in this tick
    bool is_last_ = false;       // the work is gone: this step is planned, not taken
    bool is_cut_short_ = false;  // the last plan, by its share of the work
    bool is_known_ = true;       // the step, from all that there is
    bool recalls_ = false;       // the next step goes by what is in mind: see look_around
    bool is_dense_ = false;      // there were many contacts when all were found last: see look_around
    bool grips_ = false;         // friction has a say in the last step
    bool strays_ = false;        // the last step was stopped at once, and would be so again: see lift
    bool is_stuck_ = false;      // what stops it at once is a contact already
};

}  // namespace tactus
