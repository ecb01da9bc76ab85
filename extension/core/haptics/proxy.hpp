// The proxy: a sphere that goes where the hand goes and never enters a surface.
//
// Thesis 3.2.2 walks in three steps: towards the hand until contact, along the first plane, along the line of
// two planes. Here the same walk goes on, collecting planes, until the proxy stands at the place nearest to
// the hand that its surfaces allow, within a bounded number of steps a tick; what is then still missing is
// known (`residual`).
#pragma once

#include <cstdint>
#include <glm/geometric.hpp>
#include <limits>
#include <span>

#include "core/haptics/constrained_step.hpp"
#include "core/haptics/letting_out.hpp"
#include "core/haptics/surroundings.hpp"

namespace tactus {

struct ProxySettings {
    double radius = 0.01;               // (unit: meters), > 0
    std::uint32_t mask = 0xffff'ffffu;  // layers it touches
    int max_steps = 64;                 // a tick; what is missing then is made up in the next
    std::int64_t max_work = 18'000;     // a tick (see WorkBudget): about 0.3 ms
};

enum ProxyStatus : std::uint32_t {
    proxy_absent = 1u << 0,      // the hand is inside a body since the start: no touch until it is out
    proxy_touching = 1u << 1,    // at least one contact holds it back
    proxy_sliding = 1u << 2,     // dynamic friction applies
    proxy_unfinished = 1u << 3,  // this tick's steps or work did not suffice: residual is not small
    proxy_squeezed = 1u << 4,    // moving bodies leave it no room
    // A body has come to stand where the proxy is, or has squeezed it: it is not touched until the proxy is
    // out of it.
    proxy_letting_out = 1u << 5,
};

struct ProxyTick {
    Vec3 position{0.0};     // of the sphere's centre, in the world (unit: meters)
    Vec3 slide{0.0};        // pull along the surfaces that friction holds (unit: meters)
    double residual = 0.0;  // length of the step that would come next (unit: meters)
    std::uint32_t status = 0;
    int steps = 0;
    // The force may jump (see FadingForce): something else than the motion of the hand and of bodies has
    // changed what is touched, the proxy has slipped farther than that motion leads it, or has no place that
    // follows from where the hand is: it is squeezed, or the work of this tick or the last did not suffice.
    bool jumped = false;
};

// Where a crowd has held the proxy last, and how: see proxy_crowd.cpp.
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

// Everything of a proxy that its next move depends on, besides the scene.
struct ProxyMemory {
    Vec3 position{0.0};  // in the world (unit: meters)
    bool present = false;
    bool sliding = false;
    bool overlaps = false;
    bool unfinished = false;
    Vec3 hand{0.0};  // in the world (unit: meters)
    TouchList touching;
    double slide_speed = 0.0;  // (unit: meters per second)
    CrowdHold crowd;
};

class Proxy {
public:
    Proxy(std::size_t max_parts, const ProxySettings& settings);

    void set_settings(const ProxySettings& settings) { settings_ = settings; }
    const ProxySettings& settings() const { return settings_; }

    // One tick, so many seconds long: the scene as it is now, the hand where it is now. Allocates nothing.
    ProxyTick move(const TouchScene& scene, const Vec3& hand, double seconds = 0.001);

    // The contacts that hold the proxy back after the last move, with their pressure.
    std::span<const Touch> touching() const { return touching_.all(); }
    const Vec3& position() const { return position_; }

    // Moves the proxy by hand, without a sweep: for a correction that carries it along with an object.
    void displace(const Vec3& offset) { put(position_ + offset); }
    // The same where `body`, which it rests on, is put elsewhere: a proxy that sticks to it goes along; of
    // one that slides the hand leads what lies along the surface, so that it is only pushed.
    void go_along(const Vec3& offset, int body);
    // The proxy as it was, to move it again from there.
    ProxyMemory memory() const {
        return {position_, present_,  sliding_,     overlaps_, unfinished_,
                hand_,     touching_, slide_speed_, crowd_};
    }
    void recall(const ProxyMemory& memory) {
        put(memory.position);
        present_ = memory.present;
        sliding_ = memory.sliding;
        overlaps_ = memory.overlaps;
        unfinished_ = memory.unfinished;
        hand_ = memory.hand;
        touching_ = memory.touching;
        slide_speed_ = memory.slide_speed;
        crowd_ = memory.crowd;
        if (crowd_.next == CrowdHold::Next::on) {  // how far it had come is not remembered
            crowd_.next = CrowdHold::Next::anew;
        }
    }
    // Whether dynamic or static friction holds it next, where another proxy knows.
    void set_sliding(bool sliding) { sliding_ = sliding; }
    // The surface of a body breaks: the proxy goes through it and is held back again once it is clear of it.
    // False where it goes through too many bodies already.
    bool pass_through(int body) {
        contacts_hold_ = false;
        return surroundings_.passed().pass(body, PassedBecause::broken);
    }

    // As if just started: present again as soon as the hand is in a free place.
    void restart() {
        present_ = false;
        sliding_ = false;
        touching_.clear();
        crowd_ = {};
    }

private:
    // What the last step was, if it was a bent one.
    struct BentStep {
        double length = 0.0;    // 0: it was not (unit: meters)
        double slide = 0.0;     // of the flat step in its place (unit: meters)
        double distance = 0.0;  // where it began, as `Descent::nearest` (unit: meters)
    };
    // What steers the steps of one tick.
    struct Descent {
        double beyond = 0.0;   // how far above a surface the last step may have ended (unit: meters)
        double dropped = 0.0;  // the same, where it led along one
        double trust = std::numeric_limits<double>::infinity();     // see bend_step (unit: meters)
        double foreseen = std::numeric_limits<double>::infinity();  // see follow_hill (unit: meters)
        BentStep last_bent;
        double nearest =
            std::numeric_limits<double>::infinity();  // to the hand while touching (unit: meters)
        int planned = 0;                              // steps along a surface
        int stops = 0;                                // steps that something has stopped
        bool was_stopped = false;                     // the last one has been
        Vec3 began{0.0};  // where the last step began, and which way the surfaces pushed there
        Vec3 pushed{0.0};
        bool slid = false;
        bool is_last = false;       // the work is gone: this step is planned, not taken
        bool touched = false;       // something has held it in this tick
        bool strays = false;        // the last step was stopped at once, and would be so again: see lift
        bool recalls = false;       // the next step goes by what is in mind: see look_around
        bool grips = false;         // friction has a say in the last step
        bool is_stuck = false;      // what stops it at once is a contact already
        bool is_dense = false;      // there were many contacts when all were found last: see look_around
        bool is_cut_short = false;  // the last plan, by its share of the work
        Vec3 start{0.0};            // where the tick began,
        double distance = 0.0;      // and how far that was from the hand (unit: meters)
        CrowdHold crowd;
    };

    void put(const Vec3& place);
    bool appear();
    void follow(const Vec3& hand, double given_way, bool changed, ProxyTick& tick);
    TouchingSphere sphere() const { return {position_, settings_.radius, settings_.mask, touching()}; }
    bool take_in_jumps();
    void let_go(bool every);
    double ride_along(ProxyTick& tick);
    void ride_bodies(ProxyTick& tick);
    void ride_deformations(ProxyTick& tick);
    bool ride_deformation(int body);
    Hit advance(const Vec3& motion, FeatureId& stopped_by, int except = -1);
    Hit advance(const ConstrainedStep& step, Descent& descent, FeatureId& stopped_by);
    int carrier() const;
    bool fly(const Vec3& hand);
    void descend(const Vec3& hand, double given_way, ProxyTick& tick);
    Hit take(ConstrainedStep& step, const Vec3& pull, Descent& descent);
    void conclude(const ConstrainedStep& step, const Descent& descent, ProxyTick& tick);
    bool stays_on_planes(ConstrainedStep& step);
    bool drops_onto_one(ConstrainedStep& step, const Vec3& hand);
    bool leads_clear_of_others(const Vec3& way, const ConstrainedStep& step);
    bool has_come_to_rest(ConstrainedStep& step, const Vec3& from, const Vec3& hand, const Descent& descent,
                          ProxyTick& tick);
    bool is_end(const ConstrainedStep& step) const;
    ConstrainedStep plan(const Vec3& pull, Descent& descent);
    void doubt(const ConstrainedStep& step, const Vec3& pull, Descent& descent) const;
    void follow_whole(ConstrainedStep& step, const Vec3& pull, Descent& descent) const;
    void follow_hollow(ConstrainedStep& step, double newton, double bend, const Vec3& normal, double way,
                       double trust) const;
    void follow_hill(ConstrainedStep& step, double newton, double way, Descent& descent) const;
    bool look_around(Descent& descent);
    std::int64_t question_share() const;
    void enter_crowd(Descent& descent) const;
    ConstrainedStep plan_in_share(const Vec3& pull, Descent& descent);
    void step_over_crowd(ConstrainedStep& step, const Vec3& pull, const Descent& descent);
    bool is_asked_again(const ConstrainedStep& step, const CrowdHold& crowd) const;
    Hit sweep_in_share(const ConstrainedStep& step, Descent& descent, FeatureId& stopped_by);
    void go_on(const Vec3& pull, Descent& descent);
    void keep_crowd(const Descent& descent, double way, bool is_unfinished);
    bool lift(bool strays);
    bool strays(double length) const;
    bool brake(ConstrainedStep& step, double dropped);
    double drop_after(double length, double slope) const;
    double friction_limit(const ConstrainedStep& step, double dropped) const;
    void heed_speed(const ConstrainedStep& step, const Vec3& way);
    void keep_touching(const ConstrainedStep& step);
    const Tolerances& tolerances() const { return surroundings_.tolerances(); }

    ProxySettings settings_;
    Surroundings surroundings_;
    const TouchScene* scene_ = nullptr;
    Vec3 position_{0.0};
    bool present_ = false;
    bool sliding_ = false;
    double seconds_ = 0.001;    // of this tick
    double slide_speed_ = 0.0;  // that friction goes by, see friction.hpp (unit: meters per second)
    CrowdHold crowd_;
    LongSweep long_sweep_;  // of the step that a crowd has held last
    Vec3 hand_{0.0};        // the last that was a place
    ContactList contacts_;
    bool contacts_hold_ = false;  // contacts_ are those at position_
    bool overlaps_ = false;       // a surface, since the last move
    bool unfinished_ = false;     // the last move was
    // What the last move has seen.
    std::uint64_t scene_ticks_ = 0;
    std::uint64_t revision_ = 0;
    std::uint64_t material_changes_ = 0;
    ProxySettings settled_{0.0, 0, 0};
    TouchList touching_;
};

}  // namespace tactus
