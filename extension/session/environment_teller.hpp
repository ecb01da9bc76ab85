// The owner's half of discovery where the environment is: describes each body to the operator.
//
// Belongs to the owner of the session. The pieces travel by the loop (teleoperator_side.hpp), which tells
// them until the operator has acknowledged them.
#pragma once

#include <deque>
#include <memory>
#include <string>
#include <unordered_map>

#include "session/session.hpp"
#include "session/teleop_port.hpp"

namespace tactus {

class EnvironmentTeller {
public:
    explicit EnvironmentTeller(std::shared_ptr<TeleopPort> port) : port_(std::move(port)) {}

    // Where this side's world stands in its scene (TeleopSettings::frame). Before anything is told.
    void set_frame(const Pose& frame) { frame_ = frame; }

    // Describes a body of the session, or one that has been described, anew. `name`: how the operator finds
    // its picture, the node's path below its HapticWorld. Empty text, or why it cannot be described.
    std::string tell(SessionHandle body, const std::string& name, const BodyAddition& addition);

    // The body is about to be removed.
    void forget(SessionHandle body);

    // Describes a joint of the session, or anew. Its frames are those of its two bodies, told or about to be,
    // or of the scene where `second` is none.
    void tell_joint(SessionHandle joint, const JointDescription& description, SessionHandle first,
                    SessionHandle second);
    void forget_joint(SessionHandle joint);

    // Call it now and then, as each of Godot's frames does. An operator who has just come (`peer_epoch` is
    // another one) is told where things are by now.
    void update(const SessionSnapshot& snapshot, std::uint64_t peer_epoch);

private:
    struct Told {
        std::string name;
        BodyAddition addition;
    };

    void announce(SessionHandle body, const Told& told);
    void withdraw(ObjectId object);
    void send_on();

    std::shared_ptr<TeleopPort> port_;
    std::unordered_map<SessionHandle, Told> told_;
    // In the order in which it was said; empty content: withdrawn.
    std::deque<PreparedDiscovery> waiting_;
    std::uint64_t peer_epoch_ = 0;
    Pose frame_;
};

}  // namespace tactus
