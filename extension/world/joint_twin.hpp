// The session's twin of one joint of a scene: made once both bodies are there, anew when the joint or one of
// the bodies has changed. Owner's thread only.
#pragma once

#include <cstdint>
#include <string>

#include "session/session.hpp"

namespace tactus {

// All but the frames.
bool same_joint(const JointDescription& a, const JointDescription& b);

class JointTwin {
public:
    struct End {
        std::uint64_t source = 0;  // who the body is, whichever twin it has; 0: it is the world
        SessionHandle body = no_handle;
        Pose pose;  // of the body, as the scene has it now
    };

    // `joint` has its frame in the world. The first end is a body.
    void synchronise(Session& session, const JointDescription& joint, const End& first, const End& second);
    void remove(Session& session);

    // Why the session does not take it; empty where it does.
    const std::string& problem() const { return problem_; }
    SessionHandle handle() const { return handle_; }
    // What it joins, and how (see Session::add_joint).
    SessionHandle first() const { return first_; }
    SessionHandle second() const { return second_; }
    const JointDescription& joined() const { return joined_; }
    // Another one whenever it joins anew.
    std::uint64_t revision() const { return revision_; }

private:
    void note_frames(const Pose& frame, const End& first, const End& second);

    SessionHandle handle_ = no_handle;
    SessionHandle first_ = no_handle;
    SessionHandle second_ = no_handle;
    JointDescription asked_;   // as it was given
    JointDescription joined_;  // with frames in those of the bodies
    Pose frame_in_first_, frame_in_second_;
    std::uint64_t sources_[2] = {0, 0};  // that these are of
    std::uint64_t revision_ = 0;
    std::string problem_;
};

}  // namespace tactus
