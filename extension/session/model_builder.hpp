// The owner's half of discovery where the operator is: builds what the far side describes, so that the
// session's bodies are the local model (G') of the environment.
//
// Belongs to the owner of the session. A body that is described anew is replaced where it is; another start
// of the far side takes all of the earlier one's bodies away. What takes time, reading and preparing a body,
// is done by `run` where one is set, whose jobs must have ended before the session does.
#pragma once

#include <atomic>
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
};

class ModelBuilder {
public:
    // What an experiment makes wrong about the model, before it is built.
    using Distortion = std::function<void(ObjectDescription&)>;

    // The session must outlive the builder.
    ModelBuilder(Session& session, std::shared_ptr<TeleopPort> port)
        : session_(session), port_(std::move(port)) {}

    void set_distortion(Distortion distortion) { distortion_ = std::move(distortion); }

    // Who reads and prepares bodies; the caller of update() where nobody is set.
    void set_run(DiscoveryReceiver::Run run);

    // Call it now and then, as each of Godot's frames does. `link`: the port's newest statistics. True where
    // objects() has changed.
    bool update(const LinkStatistics& link);

    // Takes everything out of the session again.
    void clear();

    const std::vector<ModelObject>& objects() const { return objects_; }

private:
    // Where the caller prepares bodies himself: a tree takes milliseconds for a large mesh, and a frame
    // should not take much longer for it.
    static constexpr std::size_t most_built_at_once = 32;

    // A body that is being prepared. Shared with who does it.
    struct Preparing {
        ObjectId object = no_object;
        std::string name;
        BodyAddition addition;
        ReadyBody ready;
        std::atomic<bool> done{false};
    };

    void take(DiscoveryEvent& event);
    void prepare(ObjectDescription& description);
    bool add_prepared();
    void add(Preparing& prepared);
    void forget_prepared(ObjectId object);
    void remove(ObjectId object);
    void take_out(const ModelObject& object);
    void bind(ObjectId object, SessionHandle body);
    void send_on();
    std::vector<ModelObject>::iterator find(ObjectId object);

    Session& session_;
    std::shared_ptr<TeleopPort> port_;
    Distortion distortion_;
    DiscoveryReceiver::Run run_;
    std::deque<std::shared_ptr<Preparing>> preparing_;
    std::vector<ModelObject> objects_;
    std::deque<ObjectBinding> waiting_;  // found the ring full
    Vec3 gravity_{0.0};                  // as set last (unit: meters per second squared)
    bool gravity_known_ = false;
};

}  // namespace tactus
