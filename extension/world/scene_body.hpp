// A body of an engine's scene, as its mirror (body_mirror.hpp) sees it: what an engine has to offer for its
// bodies to be touched. Owner's thread only.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "world/body_form.hpp"
#include "world/scene_frame.hpp"

namespace tactus {

// As the engine has it: not always made of numbers.
struct SceneSpeed {
    Vec3 linear{0.0};   // (unit: meters per second)
    Vec3 angular{0.0};  // (unit: radians per second)
    bool operator==(const SceneSpeed&) const = default;
};

// What touch and collision take their form from. Where neither the shapes are others nor the scaling has done
// more than drift (has_only_drifted()), no new reading is needed, unless a shape said that it changed.
struct ShapeKey {
    struct Entry {
        std::uint64_t shape = 0;  // who it is
        SceneFrame place;         // in the body
        bool operator==(const Entry&) const = default;
    };
    std::vector<Entry> shapes;
    Mat3 scaling{1.0};    // of the body
    bool is_out = false;  // it is in the scene and not in its physics for now
};

// What a world adds to each of its bodies.
struct BodyDefaults {
    TouchMaterial touch;                        // of bodies without a material of their own
    std::shared_ptr<const TouchDetail> detail;  // of the same
    double linear_damping = 0.1;                // (unit: 1/seconds)
    double angular_damping = 0.1;               // likewise
};

class SceneBody {
public:
    virtual ~SceneBody() = default;

    virtual std::uint64_t id() const = 0;
    // A script may have freed it: then only what stands above this line may be asked, and let_go() called.
    virtual bool is_there() const = 0;
    // It is there and has a place in the scene. Asked of all that move, in every frame.
    virtual bool is_in_scene() const = 0;

    virtual std::string name() const = 0;    // for messages
    virtual std::string path() const = 0;    // below its world: the far side's name for it
    virtual bool can_be_thrown() const = 0;  // it is moved by physics, or will be; always or never
    // The id of the nearest body above it that can be thrown, and takes it along in the scene; 0: none.
    virtual std::uint64_t carrier() const = 0;
    virtual SceneFrame frame() const = 0;  // in the world
    virtual SceneSpeed speed() const = 0;  // zero of what cannot be thrown
    // `scaling`: the one that the body counts as having, a drift left out.
    virtual BodyMakings makings(const Mat3& scaling) const = 0;
    virtual ShapeKey shape_key() const = 0;
    virtual BodyForm form(const Mat3& scaling) const = 0;
    virtual BodyValues values(const BodyDefaults& defaults) = 0;

    // As the engine's own physics has it in this frame.
    virtual BodyMotion true_motion() const = 0;
    // The engine's own physics is to push it in its next step, at its centre of mass (units: newton seconds,
    // newton meter seconds).
    virtual void push(const Vec3& impulse, const Vec3& turn) = 0;

    // Whether the engine's own physics leaves it where it is.
    virtual void hold_still(bool held) = 0;
    // Changes of its place, and of what it is made of now, are told (BodyMirrors::news()) until let_go().
    virtual void listen() = 0;
    // Whether changes of its place are. They are not while it moves: it is asked in every frame then.
    virtual void tell_of_moves(bool tell) = 0;
    virtual void let_go() = 0;

    // What the engine keeps of it.
    virtual SceneSpeed set_speed(const SceneSpeed& speed) = 0;
    // Puts it there, and answers where it stands by that. May call a script, which may free it.
    virtual SceneFrame stand_at(const Pose& pose, const Mat3& scaling) = 0;
    // The same, of a frame that it has had: what carried it has moved.
    virtual SceneFrame put_back(const SceneFrame& frame) = 0;

    virtual void say(const std::string& problem) const = 0;  // once for each; an empty one says nothing
};

}  // namespace tactus
