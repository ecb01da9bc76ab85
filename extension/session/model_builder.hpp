// The owner's half of discovery where the operator is: builds what the far side describes, so that the
// session's bodies are the local model (G') of the environment.
//
// Belongs to the owner of the session. A body that is described anew is replaced where it is. After another
// start of the far side the earlier one's bodies stay, so that a hand that presses one goes on pressing,
// until each is described again under its name; what is not within `patience` is gone. What takes time,
// reading and preparing a body, is done by `run` where one is set, whose jobs must have ended before the
// session does.
#pragma once

#include <atomic>
#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "session/model_joints.hpp"
#include "session/session.hpp"
#include "session/teleop_port.hpp"

namespace tactus {

struct ModelObject {
    ObjectId object = no_object;
    std::string name;                // the far node's path below its HapticWorld
    SessionHandle body = no_handle;  // no_handle: it could not be built
    std::string problem;             // why
    bool outdated = false;           // of an earlier start of the far side, which has not described it yet
    Motion motion = Motion::Static;  // as it was described
    double gravity_scale = 1.0;      // likewise
    bool floats = false;             // until all is known that it may rest on
};

class ModelBuilder {
public:
    // What an experiment makes wrong about the model, before it is built.
    using Distortion = std::function<void(ObjectDescription&)>;

    // The session must outlive the builder.
    ModelBuilder(Session& session, std::shared_ptr<TeleopPort> port)
        : session_(session), port_(std::move(port)), joints_(session) {}

    // Where this side's world stands in its scene (TeleopSettings::frame). Before anything is described.
    void set_frame(const Pose& frame) {
        frame_ = frame;
        joints_.set_frame(frame);
    }

    void set_distortion(Distortion distortion) { distortion_ = std::move(distortion); }

    // Who reads and prepares bodies; the caller of update() where nobody is set.
    void set_run(DiscoveryReceiver::Run run);

    // Call it now and then, as each of Godot's frames does. `now`: any steady clock; `link`: the port's
    // newest statistics. True where objects() has changed.
    bool update(Nanoseconds now, const LinkStatistics& link);

    // Takes everything out of the session again.
    void clear();

    const std::vector<ModelObject>& objects() const { return objects_; }
    const ModelJoints& joints() const { return joints_; }

private:
    // Where the caller prepares bodies himself: a tree takes milliseconds for a large mesh, and a frame
    // should not take much longer for it.
    static constexpr std::size_t max_built_at_once = 32;

    static constexpr Nanoseconds settling = 200'000'000;
    static constexpr Nanoseconds patience = 2'000'000'000;
    static constexpr Nanoseconds floats_at_most = 5'000'000'000;  // after the last description

    // A body that is being prepared. Shared with who does it.
    struct Preparing {
        ObjectId object = no_object;
        std::string name;
        BodyAddition addition;
        ReadyBody ready;
        double gravity_scale = 1.0;
        std::atomic<bool> done{false};
    };

    void outdate(Nanoseconds now);
    bool all_described(Nanoseconds now, const LinkStatistics& link) const;
    bool all_known() const;
    void begin_first();
    void let_fall(Nanoseconds now);
    void remove_outdated();
    void follow_gravity(Nanoseconds now, const Vec3& wanted);
    void take(DiscoveryEvent& event, Nanoseconds now);
    void prepare(ObjectDescription& description);
    bool add_prepared();
    void add(Preparing& prepared);
    void forget_prepared(ObjectId object);
    void remove(ObjectId object);
    void take_out(const ModelObject& object);
    void bind(ObjectId object, SessionHandle body);
    void send_on();
    void join();
    std::vector<ModelObject>::iterator find(ObjectId object);
    std::vector<ModelObject>::iterator find_before(ObjectId object, const std::string& name);

    Session& session_;
    std::shared_ptr<TeleopPort> port_;
    Distortion distortion_;
    DiscoveryReceiver::Run run_;
    std::deque<std::shared_ptr<Preparing>> preparing_;
    std::vector<ModelObject> objects_;
    ModelJoints joints_;
    Nanoseconds outdated_at_ = 0;  // when the far side has started anew
    bool any_outdated_ = false;
    FirstDescription first_ = FirstDescription::awaited;
    std::deque<ObjectBinding> waiting_;  // found the ring full
    Vec3 gravity_{0.0};                  // as set last (unit: meters per second squared)
    Nanoseconds gravity_at_ = 0;
    bool gravity_known_ = false;
    std::size_t object_count_ = 0;  // that the far side says it has
    std::uint64_t counted_by_ = 0;  // the packet in which it said so
    Nanoseconds news_at_ = 0;       // when something was described last
    double delay_ = 0.0;            // there and back (unit: seconds)
    Pose frame_;
};

}  // namespace tactus
