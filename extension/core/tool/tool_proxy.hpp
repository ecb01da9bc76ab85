// A rigid tool that goes where the hand goes, turns as it turns, and never enters a surface: what Proxy is
// for a point, for spheres that move as one. docs/tool.md derives it.
//
// A tick goes in steps. Each takes the contacts around the tool as bounds of its motion, finds the motion
// nearest to the hand's (nearest_motion) and goes along it, up to the first surface. The steps end where none
// is left to go. Bodies that have moved carry a tool that rests on them and push one that is in their way.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>

#include "core/tool/tool_settings.hpp"
#include "core/tool/tool_surroundings.hpp"

namespace tactus {

class ToolPair;
class ToolProxy;

// A contact that holds the tool back.
struct ToolTouch {
    Vec3 point{0.0};             // on the surface, in the world (unit: meters)
    Vec3 normal{0.0, 1.0, 0.0};  // unit, from the surface to the tool, in the world
    Vec3 force{0.0};             // on the tool (unit: newtons); the body gets the opposite
    double stiffness = 0.0;      // by which that grows when tool and hand come apart there, along it
                                 // (unit: newtons per meter)
    int body = -1;               // slot in the TouchScene
    FeatureId feature;           // of the scene, now
};

// A contact of two tools that holds this one back.
struct ToolMeeting {
    Vec3 point{0.0};             // in the world (unit: meters)
    Vec3 normal{0.0, 1.0, 0.0};  // unit, from the other tool to this one, in the world
    Vec3 force{0.0};             // on this one, of its coupling as a whole (unit: newtons)
    const ToolProxy* other = nullptr;
};

struct ToolTick {
    Pose pose;                 // of the tool, in the world
    Vec3 force{0.0};           // on the hand (unit: newtons)
    Vec3 torque{0.0};          // on the hand, about its own place (unit: newton meters)
    double residual = 0.0;     // length of the step that would come next (unit: meters)
    std::uint32_t status = 0;  // ToolStatus
    int steps = 0;
    bool jumped = false;  // the force may jump, see ProxyTick
};

// Everything of a tool that its next move depends on, besides the scene. Of its contacts only the one it
// rests on hardest, which carries it.
struct ToolMemory {
    Pose pose;  // in the world
    bool present = false;
    bool sliding = false;
    bool rests = false;
    double pace = 0.0;  // (unit: meters)
    double trust = 1.0;
    ToolTouch on;
    std::uint32_t slides_on = 0;  // bits, by the order of its pairs
};

class ToolProxy {
public:
    static constexpr std::size_t max_pairs = 3;
    static constexpr std::size_t max_meetings = 6;

    ToolProxy(std::shared_ptr<const ToolShape> shape, std::size_t max_parts, const ToolSettings& settings);

    ToolProxy(const ToolProxy&) = delete;  // pairs know where it is
    ToolProxy& operator=(const ToolProxy&) = delete;

    // One tick: the scene as it is, the hand where it is. Allocates nothing. What tools it is in a pair with
    // stand still for it: ToolGroup moves them together.
    ToolTick move(const TouchScene& scene, const Pose& hand);

    void set_settings(const ToolSettings& settings);
    std::span<const ToolTouch> touching() const {
        return {touches_.data(), static_cast<std::size_t>(touch_count_)};
    }
    // At most max_meetings of them, the hardest.
    std::span<const ToolMeeting> meetings() const {
        return {meetings_.data(), static_cast<std::size_t>(meeting_count_)};
    }
    const ToolSettings& settings() const { return settings_; }
    const Pose& pose() const { return pose_; }
    bool is_present() const { return present_; }
    // That it has made in its last move.
    RigidMotion way() const { return motion_between(start_, pose_); }
    const ToolShape& shape() const { return around_.shape(); }
    double skin() const { return around_.skin(); }
    // As if just started: present again as soon as the hand is in a free place.
    void restart() {
        present_ = false;
        touch_count_ = meeting_count_ = 0;
        is_changed_ = true;
        ++starts_;
    }
    // Restarts so far.
    std::uint32_t starts() const { return starts_; }

    ToolMemory memory() const;
    // In the scene as it is.
    void recall(const ToolMemory& memory, const TouchScene& scene);
    // A correction takes the body elsewhere: the tool goes with it where it rests on it hardest and does not
    // slide, and else only as far as the body pushes it; as far as nothing else is in the way. In the scene
    // as it is before that.
    void go_along(const TouchScene& scene, const Pose& motion, int body);
    // Of the last move, as WorkBudget counts.
    std::int64_t work_spent() const { return work_given_ - work_.left(); }

    // For ToolPair: one more tool that it may meet, and one less.
    void meet(ToolPair& pair);
    void leave(const ToolPair& pair);
    std::span<ToolPair* const> pairs() const {
        return {pairs_.data(), static_cast<std::size_t>(pair_count_)};
    }

private:
    friend class ToolGroup;  // which takes the steps of several tools together

    struct Plan {
        Vector6 motion{};  // (unit: meters)
        NearestMotion
            holding;  // what holds it back, forces that balance the coupling when it has come to rest
        bool possible = true;
        bool slides = false;
    };

    bool begin(const TouchScene& scene, const Pose& hand, ToolTick& tick);
    void finish(ToolTick& tick);
    ToolTick appear(const Pose& hand);
    bool fits_beside_tools();
    bool is_entered();
    double straight_share(const RigidMotion& motion) const;
    double free_share(const RigidMotion& motion, int except = -1);
    void go_free(const RigidMotion& motion, int except);
    double farthest_to_go() const;
    double longest_ride() const;
    bool ride();
    void take_along(const RigidMotion& motion, int body, double& taken);
    RigidMotion way_with(int body) const;
    bool ride_bodies(const Pose& before, double& taken);
    bool ride_forms(double& taken);
    RigidMotion way_of_form(int body) const;
    std::span<const ToolTouch>::iterator hardest_touch() const;
    int carrier() const;
    Pose place_after(const Pose& motion, int body) const;
    double way_since(const Pose& from) const;
    bool look_around(const RigidMotion& pull, double far, bool is_first);
    void descend(const Pose& hand, ToolTick& tick);
    Plan plan(const RigidMotion& pull);
    bool slips(const NearestMotion& held) const;
    // Coulomb's coefficient, against a body.
    double friction_at(const ToolContact& contact, bool sliding) const;
    NearestMotion hold(const Vector6& goal, bool sliding);
    void bound_motion();
    void bound_slides(const Vector6& x);
    NearestMotion nearest(const Vector6& goal, double tolerance);
    void keep_touches(const NearestMotion& holding);
    void give_work(std::int64_t units);
    void go(const RigidMotion& motion) {
        pose_ = moved(pose_, motion);
        around_.went(motion);
    }

    ToolSettings settings_;
    double length_ = 0.0;  // L of nearest_motion.hpp (unit: meters)
    ToolSurroundings around_;
    const TouchScene* scene_ = nullptr;
    std::uint64_t revision_ = 0;
    std::uint64_t material_changes_ = 0;
    std::uint32_t starts_ = 0;
    bool is_changed_ = false;  // itself, or with whom it is, since the last move
    double given_way_ = 0.0;   // of the hand and of what took it along, in this tick (unit: meters)
    Pose hand_;                // that was given last and is one
    Pose start_;               // of the last move
    Pose pose_;
    bool present_ = false;
    bool sliding_ = false;
    bool at_rest_ = false;  // it was where it should be: contacts are looked for as exactly as that needs
    double trust_ = 1.0;    // share of its way that the next tick's first step tries
    double pace_ = 0.0;     // of the farthest sphere, in the last tick (unit: meters)
    WorkBudget work_{0};
    std::int64_t work_given_ = 0;
    ToolContacts contacts_;
    std::array<MotionBound, ToolContacts::capacity> bounds_;  // of contacts_
    std::array<ToolTouch, 6> touches_;
    int touch_count_ = 0;
    std::array<ToolPair*, max_pairs> pairs_{};
    int pair_count_ = 0;
    std::array<ToolMeeting, max_meetings> meetings_;
    int meeting_count_ = 0;
};

}  // namespace tactus
