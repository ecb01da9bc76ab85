// The owner's half of discovery where the operator is: builds what the far side describes, so that the
// session's bodies are the local model (G') of the environment.
//
// Belongs to the owner of the session. A body that is described anew is replaced where it is. After another
// start of the far side the earlier one's bodies stay, so that a hand that presses one goes on pressing,
// until each is described again under its name; what is not within `patience` is gone.
#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "session/session.hpp"
#include "session/teleop_port.hpp"

namespace tactus {

struct ModelObject {
    ObjectId object = no_object;
    std::string name;                // the far node's path below its HapticWorld
    SessionHandle body = no_handle;  // no_handle: it could not be built
    std::string problem;             // why
    bool outdated = false;           // of an earlier start of the far side, which has not described it yet
};

class ModelBuilder {
public:
    // What an experiment makes wrong about the model, before it is built.
    using Distortion = std::function<void(ObjectDescription&)>;

    // The session must outlive the builder.
    ModelBuilder(Session& session, std::shared_ptr<TeleopPort> port)
        : session_(session), port_(std::move(port)) {}

    // Where this side's world stands in its scene (TeleopSettings::frame). Before anything is described.
    void set_frame(const Pose& frame) { frame_ = frame; }

    void set_distortion(Distortion distortion) { distortion_ = std::move(distortion); }

    // Call it now and then, as each of Godot's frames does. `now`: any steady clock; `link`: the port's
    // newest statistics. True where objects() has changed.
    bool update(Nanoseconds now, const LinkStatistics& link);

    // Takes everything out of the session again.
    void clear();

    const std::vector<ModelObject>& objects() const { return objects_; }

private:
    // Building a tree takes milliseconds for a large mesh; a frame should not take much longer for it.
    static constexpr int most_built_at_once = 32;

    static constexpr Nanoseconds settling = 200'000'000;
    static constexpr Nanoseconds patience = 2'000'000'000;

    void outdate(Nanoseconds now);
    bool all_described(Nanoseconds now, const LinkStatistics& link) const;
    void remove_outdated();
    void build(ObjectDescription& description);
    void remove(ObjectId object);
    void take_out(const ModelObject& object);
    void bind(ObjectId object, SessionHandle body);
    void send_on();
    std::vector<ModelObject>::iterator find(ObjectId object);
    std::vector<ModelObject>::iterator find_before(const ObjectDescription& description);

    Session& session_;
    std::shared_ptr<TeleopPort> port_;
    Distortion distortion_;
    std::vector<ModelObject> objects_;
    Nanoseconds outdated_at_ = 0;  // when the far side has started anew
    bool any_outdated_ = false;
    std::deque<ObjectBinding> waiting_;  // found the ring full
    Vec3 gravity_{0.0};                  // as set last (unit: meters per second squared)
    bool gravity_known_ = false;
    Pose frame_;
};

}  // namespace tactus
