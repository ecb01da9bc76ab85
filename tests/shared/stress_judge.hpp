// Watches one body of a stress case: whether the sphere stays out of it, tick by tick, by the judge's own
// distances. What cannot have come near since it was last looked at is not looked at again; now and then it
// is all the same, to see that the bound held.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>

#include "core/math/pose.hpp"
#include "shared/judge_tree.hpp"

namespace tactus::shared {

class BodyJudge {
public:
    static BodyJudge of_mesh(const JudgeTree& tree) {
        BodyJudge judge;
        judge.tree_ = &tree;
        return judge;
    }
    static BodyJudge of_ball(double radius) {
        BodyJudge judge;
        judge.ball_ = radius;
        return judge;
    }
    static BodyJudge of_box(const Vec3& half) {
        BodyJudge judge;
        judge.half_ = half;
        return judge;
    }

    void place(const Pose& pose) { pose_ = pose; }
    // Its corners have moved: what is known of the distance is void.
    void changed() { known_ = -1.0; }

    // Less than the radius where the centre is too near, by more than the rounding of the coordinates (unit:
    // meters). Otherwise at least the radius, not always exact.
    double distance(const Vec3& center, double radius);

    // It stands where the sphere is for a reason that is not the sphere's: nothing is held against it until
    // it is clear of the body.
    void excuse() { excused_ = true; }
    bool is_excused() const { return excused_; }
    // Whether the sphere is in the body though it should not be.
    bool is_penetrated(const Vec3& center, double radius);

    std::uint64_t looks = 0, spared = 0, bound_faults = 0;

private:
    double look(const Vec3& local, double far) const;

    const JudgeTree* tree_ = nullptr;
    double ball_ = 0.0;
    Vec3 half_{0.0};
    Pose pose_;
    bool excused_ = false;
    double known_ = -1.0;  // distance of known_at_, which is in the body's frame
    Vec3 known_at_{0.0};
};

// Watches which side of a surface the sphere is on, whenever it is asked.
class SideJudge {
public:
    // True where it is on another side than when it was last seen: `side` is empty where there is none.
    bool has_passed(std::optional<int> side) {
        const std::optional<int> before = std::exchange(side_, side);
        return before && side && *before != *side;
    }
    // It may go through the surface: wherever it is seen next it begins anew.
    void excuse() { side_.reset(); }

private:
    std::optional<int> side_;
};

}  // namespace tactus::shared
