// One joint of a scene and its twin in the session. Owner's thread only.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "world/body_mirror.hpp"
#include "world/joint_twin.hpp"

namespace tactus {

struct JointReading {
    JointDescription joint;  // its frame is in the world
    std::string problem;     // what is not carried out and what to do; the rest is, if `usable`
    bool usable = true;
};

// A joint of an engine's scene, as its mirror sees it.
class SceneJoint {
public:
    // One that is not named is the world.
    struct End {
        bool is_named = false;
        std::uint64_t body = 0;  // who that is; 0: there is none of that name
    };

    virtual ~SceneJoint() = default;

    virtual std::uint64_t id() const = 0;
    virtual bool is_there() const = 0;  // else only the id may be asked
    virtual std::string name() const = 0;
    virtual JointReading read() const = 0;
    virtual End first() const = 0;
    virtual End second() const = 0;
    // Why it joins nothing yet, where that is a mistake: that a script has still to name its ends is none.
    virtual std::string problem() const = 0;
    virtual void say(const std::string& problem) const = 0;  // once for each; an empty one says nothing
};

class JointMirror {
public:
    explicit JointMirror(std::unique_ptr<SceneJoint> joint) : joint_(std::move(joint)), id_(joint_->id()) {}

    std::uint64_t id() const { return id_; }
    const SceneJoint* joint() const { return joint_->is_there() ? joint_.get() : nullptr; }  // null: gone
    const JointTwin& twin() const { return twin_; }

    // The mirror of a body of the world; null where the world has none of it.
    using FindMirror = std::function<const BodyMirror*(std::uint64_t body)>;
    // Joins what there is to join, once both bodies are in the session. Call after the bodies.
    void synchronise(Session& session, const FindMirror& mirror_of);
    void release(Session& session) { twin_.remove(session); }

    // Why it does not join, or only in part; empty where it does.
    const std::string& problem() const { return problem_; }

private:
    std::unique_ptr<SceneJoint> joint_;
    std::uint64_t id_;
    JointTwin twin_;
    std::string problem_;
};

}  // namespace tactus
