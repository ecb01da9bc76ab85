// What a tool's spheres may meet: which surfaces bound its next motion, and how much of a motion is free.
//
// Turns are cut so that no sphere's way is farther from its chord than a quarter of its room, or of the skin,
// by which the tool rests above surfaces: sweeps along the chords then miss nothing.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "core/haptics/contact.hpp"
#include "core/tool/nearest_motion.hpp"
#include "core/tool/part_balls.hpp"
#include "core/tool/sphere_hood.hpp"
#include "core/tool/tool_shape.hpp"
#include "core/tree/deform_sweep.hpp"

namespace tactus {

// Where one of a tool's spheres touches a surface, or may soon.
struct ToolContact {
    Vec3 point{0.0};             // on the surface, in the world (unit: meters)
    Vec3 normal{0.0, 1.0, 0.0};  // unit, from the surface to the tool, in the world
    double gap = 0.0;            // distance still to where the tool rests (unit: meters)
    int body = -1;               // slot in the TouchScene
    FeatureId feature;           // of the scene, now
};

struct ToolContacts {
    static constexpr int capacity = 128;

    std::array<ToolContact, capacity> items;
    int count = 0;

    // Where there is no room the farthest goes. Sweeps still see it.
    void add(const ToolContact& contact);
    std::span<const ToolContact> all() const { return {items.data(), static_cast<std::size_t>(count)}; }
};

// A small motion of the tool's spheres, from one place to another.
struct ToolWay {
    Pose from;
    Pose to;
    RigidMotion motion;  // that leads there
    // How it gets there: no centre is accelerated by more than fixed + per_arm * (its distance from the
    // tool's origin) on its way, in units of the time that takes. A turn by w about an axis: w^2 per arm.
    double fixed = 0.0;    // (unit: meters)
    double per_arm = 0.0;  // (dimensionless)

    // How far its way may be from its chord: |x''| / 8 (unit: meters).
    double off_chord(double arm) const { return (fixed + per_arm * arm) / 8.0; }
};
// At a steady speed, seen from where everything else stands still.
ToolWay steady_way(const Pose& pose, const RigidMotion& motion);

class ToolSurroundings {
public:
    ToolSurroundings(std::shared_ptr<const ToolShape> shape, std::size_t max_parts);

    const ToolShape& shape() const { return *shape_; }
    // How far above surfaces the tool rests (unit: meters).
    double skin() const { return skin_; }

    // Once a tick: the tool stands at `pose` and goes no farther than `way`, of which bodies take it along by
    // no more than `ride` (unit: meters).
    void begin_tick(const TouchScene& scene, std::uint32_t mask, const Pose& pose, double way,
                    double ride = 0.0);
    void forget();
    bool is_empty() const { return parts_.is_empty(); }
    // Whether the tool neither touches nor is inside anything, by more than this share of a sphere's radius.
    // False where the work is gone.
    bool is_free(const Pose& pose, WorkBudget& work, double depth = 0.0);

    // The contacts that a motion may meet before its farthest point has gone `far` (unit: meters).
    // `is_exact`: for a tool that is about to rest, all that it touches, as exactly as that can be told.
    // Where the work is gone before all spheres are looked at, the next look begins with the others.
    void collect(const Pose& pose, const RigidMotion& motion, double far, ToolContacts& contacts,
                 WorkBudget& work, bool is_exact = false);
    // What of the motion is a small enough turn.
    double straight_share(const RigidMotion& motion) const;
    double straight_share(const ToolWay& way) const;
    // What of the motion no sphere meets anything on, but the body `except`.
    double free_share(const Pose& pose, const RigidMotion& motion, WorkBudget& work, int except = -1) {
        return free_share(steady_way(pose, motion), work, except);
    }
    double free_share(const ToolWay& way, WorkBudget& work, int except = -1);
    // The spheres that bodies may have entered by more than this share of their radius. Until the tool moves.
    std::span<const std::uint32_t> enterable(double depth) {
        return spheres_where(
            [&](std::size_t i) { return !cannot_be_entered(static_cast<std::uint32_t>(i), depth); });
    }
    // Which bodies may have entered these spheres by that share on their way in this tick, while the tool
    // went from `before` to `now`. Until the next call, or where the work is gone none but those found.
    void find_entering(std::span<const std::uint32_t> spheres, const Pose& before, const Pose& now,
                       double depth, WorkBudget& work);
    bool may_have_entered(int body) const { return may_have_entered_[scene_->body(body).first_part] != 0; }
    // What of its way in this tick the body has gone when it is this share of a sphere's radius in the tool,
    // which went from `before` to `now`; 1: it is not.
    double share_until_entered(std::span<const std::uint32_t> spheres, int body, const Pose& before,
                               const Pose& now, double depth, WorkBudget& work);
    // The same for a body that gives, between its two last forms, and how its surface goes on there until the
    // tick ends, in the world (unit: meters).
    struct Entering {
        double share = 1.0;
        Vec3 way{0.0};
    };
    Entering entered_by_form(int body, const Pose& before, const Pose& now, double depth, WorkBudget& work);
    // The tool has made the motion.
    void went(const RigidMotion& motion);

    // No point of the tool goes farther (unit: meters).
    double farthest_way(const RigidMotion& motion) const { return way_of(motion, shape_->reach); }

private:
    static constexpr int max_stops = 32;
    static constexpr std::uint32_t no_sphere = 0xffff'ffffu;

    // All of the tool's reach.
    static constexpr double hood_share = 0.1;      // how far around a sphere features are remembered
    static constexpr double farthest_share = 0.2;  // no hood looks farther than parts are looked for

    static constexpr double same_share = 1e-3;  // of a skin: distances that differ by less are the same

    // See WorkBudget: one sphere that may meet something, and how many that cannot are passed over for a
    // unit.
    static constexpr std::int64_t sphere_cost = 2;
    static constexpr std::int64_t spheres_at_a_time = 6;

    struct Stop {
        std::uint32_t sphere = 0, part = 0, triangle = 0;
    };

    static double way_of(const RigidMotion& motion, double arm);
    // Of a point in the tool's frame (unit: meters).
    double distance_outside_box(const Vec3& local) const;
    // How exactly contacts are looked for: a tick's first are as near as they seem, those of a tool at rest
    // are all that it touches.
    enum class Care : std::uint8_t { usual, first, exact };

    void refresh(SphereHood& hood, const Vec3& center, double rest, double window, Care care,
                 WorkBudget& work);
    void look_at_sphere(std::uint32_t index, const Pose& pose, double window, Care care,
                        ToolContacts& contacts, WorkBudget& work);
    // Until the next call.
    template <typename Condition>
    std::span<const std::uint32_t> spheres_where(Condition&& holds) {
        std::size_t count = 0;
        for (std::size_t i = 0; i < near_.size(); ++i) {
            near_[count] = static_cast<std::uint32_t>(i);
            count += holds(i) ? 1u : 0u;  // without a branch
        }
        return {near_.data(), count};
    }
    // What of the way no surface can be met on, by what its hood remembers.
    double known_share(std::uint32_t sphere, const Vec3& from, const Vec3& to, double stop) const;
    static double share_until_near(const DeformSweep& sweep, const Vec3& from, const Vec3& to, double room,
                                   double limit, WorkBudget& work);
    double sweep_sphere(std::uint32_t index, const Vec3& from, const Vec3& to, double sag, double limit,
                        int except, WorkBudget& work);
    bool has_stopped(std::uint32_t sphere, const HoodPlane& plane) const;
    bool is_inside(const Pose& pose, WorkBudget& work) const;
    bool is_between_spheres(const Pose& pose, WorkBudget& work) const;
    std::span<const std::uint32_t> parts_of(int body) const;
    void note_stop(const Stop& stop);
    double rest(std::uint32_t sphere) const { return shape_->spheres[sphere].radius + skin_; }
    // How much farther than the motion's way and `turn` say a sphere may get before it has arrived.
    static double strays(const ToolWay& way, double turn, double arm);
    // Sweeps have arrived when they are this close to where they end (unit: meters).
    double arrival() const { return 0.125 * skin_; }
    // By this share of its radius. Its room counts already with all ways of the tick, the bodies' and its
    // own.
    bool cannot_be_entered(std::uint32_t sphere, double depth) const {
        return room_[sphere] > -depth * shape_->spheres[sphere].radius;
    }

    std::shared_ptr<const ToolShape> shape_;
    // The box around its spheres, in its frame (unit: meters).
    Vec3 low_{std::numeric_limits<double>::infinity()};
    Vec3 high_{-std::numeric_limits<double>::infinity()};
    double skin_;
    const TouchScene* scene_ = nullptr;
    std::uint64_t revision_ = 0;
    // Of the scene, on their way in this tick: those near the tool, and those that may enter it.
    PartBalls parts_, entering_;
    // One each a sphere.
    std::vector<SphereHood> hoods_;
    std::vector<double> arms_;         // from the tool's origin to the centre (unit: meters)
    std::vector<double> room_;         // it rests on nothing before it has gone so far (unit: meters)
    std::vector<std::uint32_t> near_;  // of spheres_where()
    // One each a part: of the first of a body, what find_entering() has found.
    std::vector<std::uint8_t> may_have_entered_;
    std::vector<ToolBridge> bridges_;
    // What stops a sphere counts as a contact for the rest of the tick, even where another one seems to stand
    // for it.
    std::array<Stop, max_stops> stops_;
    int stop_count_ = 0;
    bool is_first_ = true;  // the tick's next collect()
    // The sphere that the next one begins with: where the work of the last one has ended.
    std::uint32_t next_look_ = 0;
    Stop stopped_by_;  // the last sweep
};

// The tool's place after the motion.
Pose moved(const Pose& pose, const RigidMotion& motion);
// That takes it from one place to the other.
RigidMotion motion_between(const Pose& from, const Pose& to);

}  // namespace tactus
