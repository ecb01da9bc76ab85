// One world with one hand in it, as experiments of teleoperation have several side by side.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "network/messages.hpp"
#include "session/session.hpp"
#include "shared/teleop_case.hpp"

namespace tactus::shared {

// Keeps what the hand was given.
class FeltDevice final : public Device {
public:
    explicit FeltDevice(std::unique_ptr<Device> inner) : inner_(std::move(inner)) {}
    DeviceSample read(Nanoseconds now) override {
        sample = inner_->read(now);
        sample.position = position_as_sent(sample.position);
        sample.velocity = velocity_as_sent(sample.velocity);
        return sample;
    }
    void write(Nanoseconds now, const Vec3& given) override {
        force = given;
        inner_->write(now, given);
    }

    DeviceSample sample;
    Vec3 force{0.0};

private:
    std::unique_ptr<Device> inner_;
};

// The same hand elsewhere: goes where another one went in the same tick, and feels nothing.
class FollowingDevice final : public Device {
public:
    explicit FollowingDevice(const FeltDevice& followed) : followed_(followed) {}
    DeviceSample read(Nanoseconds) override { return followed_.sample; }
    void write(Nanoseconds, const Vec3&) override {}

private:
    const FeltDevice& followed_;
};

// The hand of the case: a script, or an arm that is pushed back.
std::unique_ptr<Device> hand_of(const TeleopScene& scene, const TeleopCase& experiment);

SessionSettings teleop_session_settings();

// What the model believes of a body.
BodyAddition as_believed(const TeleopBody& body, const TeleopHinge* hinge, const TeleopCase& experiment);
const TeleopHinge* hinge_of(const TeleopScene& scene, std::size_t body);

struct TeleopPlace {
    TeleopPlace(const TeleopCase& experiment, std::unique_ptr<Device> hand)
        : session(teleop_session_settings()), device(std::move(hand)), object_name(experiment.object) {}

    void add_hand(const TeleopScene& scene);
    // Bodies that are a ghost only the model has.
    void fill(const TeleopScene& scene, const TeleopCase& experiment, bool believed);
    void tick(Nanoseconds now);
    // What acts on bodies in the next tick.
    void act(const TeleopScene& scene, const TeleopCase& experiment, double seconds);

    const ProxyState& pointer() const { return session.snapshot().proxies[0]; }
    Pose pose_of(SessionHandle body) const;
    double depth() const;
    bool touches(SessionHandle body) const;  // the pointer, that body; false for no_handle

    Session session;
    FeltDevice device;
    std::string object_name;
    SessionHandle object = no_handle;
    std::vector<SessionHandle> moving;   // what is dynamic, in the scene's order
    std::vector<SessionHandle> handles;  // of the scene's bodies; no_handle: it is not here

private:
    void hang(const TeleopHinge& hinge, const Pose& body, SessionHandle handle);
};

}  // namespace tactus::shared
