// The joints of the operator's model: each joins the bodies that stand here for the objects it names, as soon
// as they are there, and again when one of them is described anew.
//
// Belongs to the owner of the session.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "network/messages.hpp"
#include "session/session.hpp"

namespace tactus {

class ModelJoints {
public:
    // Which body is an object of the present start of the far side; no_handle: none.
    using FindBody = std::function<SessionHandle(ObjectId)>;

    // The session must outlive them.
    explicit ModelJoints(Session& session) : session_(session) {}

    // Where this side's world stands in its scene.
    void set_frame(const Pose& frame) { frame_ = frame; }

    // Known, or refused where it makes no sense.
    DiscoveryVerdict describe(const ObjectJoint& joint);
    void remove(ObjectId joint);

    // The far side has started anew: what it joined before stays joined until its bodies are others.
    void outdate();
    void remove_outdated();
    void clear();

    // Joins what can be joined: whenever bodies or joints have changed.
    void join(const FindBody& body_of);

    std::size_t count() const;                  // without outdated ones
    std::vector<std::string> problems() const;  // of those that could not be joined

private:
    struct Joint {
        ObjectJoint described;
        SessionHandle handle = no_handle;                     // no_handle: not joined
        SessionHandle first = no_handle, second = no_handle;  // that it joins
        bool outdated = false;
        std::string problem;
    };

    void release(Joint& joint);
    void join(Joint& joint, SessionHandle first, SessionHandle second);

    Session& session_;
    std::vector<Joint> joints_;
    Pose frame_;
};

}  // namespace tactus
