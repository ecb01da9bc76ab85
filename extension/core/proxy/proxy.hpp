// The proxy: a sphere that goes where the hand goes and never enters a surface.
//
// Thesis 3.2.2 walks in three steps: towards the hand until contact, along the first plane, along the line of
// two planes. Here the same walk goes on, collecting planes, until the proxy stands at the place nearest to
// the hand that its surfaces allow, within a bounded number of steps a tick; what is then still missing is
// known (`residual`).
#pragma once

#include <cstdint>
#include <span>

#include "core/proxy/descent.hpp"
#include "core/proxy/letting_out.hpp"
#include "core/proxy/proxy_settings.hpp"

namespace tactus {

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
    Proxy(std::size_t max_parts, const ProxySettings& settings) : sphere_(max_parts, settings) {}

    void set_settings(const ProxySettings& settings) { sphere_.settings = settings; }
    const ProxySettings& settings() const { return sphere_.settings; }

    // One tick, so many seconds long: the scene as it is now, the hand where it is now. Allocates nothing.
    ProxyTick move(const TouchScene& scene, const Vec3& hand, double seconds = 0.001);

    // The contacts that hold the proxy back after the last move, with their pressure.
    std::span<const Touch> touching() const { return hold_.touching.all(); }
    const Vec3& position() const { return sphere_.position; }

    // Moves the proxy by hand, without a sweep: for a correction that carries it along with an object.
    void displace(const Vec3& offset) { sphere_.put(sphere_.position + offset); }
    // The same where `body`, which it touches, is put elsewhere: a proxy that sticks to it goes along. One
    // that slides, or rests harder on another, is only pushed.
    void go_along(const Vec3& offset, int body);
    // The proxy as it was, to move it again from there.
    ProxyMemory memory() const;
    void recall(const ProxyMemory& memory);
    // Whether dynamic or static friction holds it next, where another proxy knows.
    void set_sliding(bool sliding) { hold_.friction.set_sliding(sliding); }
    // The surface of a body breaks: the proxy goes through it and is held back again once it is out of it on
    // this side. False where it goes through too many bodies already.
    bool pass_through(int body, const BrokenAt& broken);
    // Bodies that it goes through for now, for whatever reason.
    std::span<const PassedBodies::Passed> passed_bodies() const {
        return sphere_.surroundings.passed().all();
    }

    // As if just started: present again as soon as the hand is in a free place.
    void restart();
    // Restarts so far.
    std::uint32_t starts() const { return starts_; }

private:
    bool appear();
    bool fly(const Vec3& hand);
    void follow(const Vec3& hand, double given_way, bool changed, double seconds, ProxyTick& tick);
    bool take_in_jumps();
    void let_go(bool every);
    // proxy_ride.cpp
    double ride_along(ProxyTick& tick);
    void ride_bodies(ProxyTick& tick);
    void ride_deformations(ProxyTick& tick);
    bool ride_deformation(int body);
    const Touch* carrier() const;
    bool ride_carrier(const Touch& contact);

    const TouchScene& scene() const { return *sphere_.scene; }
    PassedBodies& passed() { return sphere_.surroundings.passed(); }
    TouchingSphere touching_sphere() const {
        return {sphere_.position, settings().radius, settings().mask, touching()};
    }

    ProxySphere sphere_;
    ProxyHold hold_;
    bool present_ = false;
    std::uint32_t starts_ = 0;
    Vec3 hand_{0.0};           // the last that was a place
    bool overlaps_ = false;    // a surface, since the last move
    bool unfinished_ = false;  // the last move was
    // What the last move has seen.
    std::uint64_t scene_ticks_ = 0;
    std::uint64_t revision_ = 0;
    std::uint64_t material_changes_ = 0;
    ProxySettings settled_{0.0, 0, 0};
};

}  // namespace tactus
