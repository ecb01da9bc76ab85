// The meshes of the stress cases, and how hand and bodies move in them.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <string_view>

#include "core/geometry/touch_shape.hpp"
#include "shared/judge_tree.hpp"
#include "shared/random_values.hpp"

namespace tactus::shared {

struct StressSetting;

// Which side of the mesh a point of its frame is on, as a number that must not change.
using Side = std::function<int(const StressSetting&, const Vec3&)>;

struct StressSetting {
    const char* name = "";
    std::shared_ptr<TriangleMesh> mesh;  // scaled and in its place
    Side side;                           // empty: cannot be told
    bool deforms = false;                // its side can be told however its corners move
    double reach = 1.0;                  // the hand stays within this of `around` along each axis
    Vec3 around{0.0};                    // before scaling
    double scale = 1.0;
    Vec3 place{0.0};
    double radius = 0.02;  // before scaling

    double world_radius() const { return scale * radius; }
    Vec3 to_world(const Vec3& p) const { return place + scale * p; }
    Vec3 from_world(const Vec3& p) const { return (p - place) / scale; }

    // Of the large ones, which are made once.
    std::shared_ptr<const TouchShape> shape;
    const JudgeTree* tree = nullptr;
};

// Soups, slivers, wedges, plates, T-junctions, boxes, stars, hills, pits, books.
StressSetting make_small_setting(RandomValues& random);

// Up to a million triangles within reach of the sphere.
StressSetting make_dense_setting(RandomValues& random);

// Of a large mesh: the same narrowed for spheres of half its radius to its whole; made once.
std::shared_ptr<const TouchShape> narrowed_dense(const StressSetting& setting);

// The corners somewhere else, each by up to `farthest` (in world lengths), so that inside and outside stay
// told apart: hills go up and down, stars in and out, boxes grow and shrink.
void deform(StressSetting& setting, RandomValues& random, double farthest);

// Beyond this every side is unknown: unbounded surfaces end at 3 (before scaling).
constexpr double stress_sheet_end = 2.9;

// Where the hand goes next, before scaling.
class StressHand {
public:
    StressHand(RandomValues& random, double reach, double scale)
        : random_(random), reach_(reach), fast_(std::min(2.0 * reach, 0.1 / scale)), kind_(random.below(4)) {
        pace_ = reach * random.magnitude(1e-5, 3e-2);
        goal_ = random.in_box(reach);
    }

    Vec3 next(const Vec3& now) {
        switch (kind_) {
            case 0:  // at 100 m/s to and fro
                return within(now + fast_ * random_.direction());
            case 1:  // anywhere at once
                return random_.below(4) == 0 ? random_.in_box(reach_) : now;
            case 2:  // straight to a goal, then to the next, at its pace
                if (glm::distance(now, goal_) <= pace_) {
                    goal_ = random_.in_box(reach_);
                }
                return now + pace_ * (goal_ - now) / std::max(pace_, glm::distance(now, goal_));
            default:  // trembling at a place
                return within(now + pace_ * random_.in_ball(1.0) - 1e-3 * now);
        }
    }

private:
    Vec3 within(const Vec3& p) const { return glm::clamp(p, Vec3(-reach_), Vec3(reach_)); }

    RandomValues& random_;
    double reach_, fast_;
    int kind_;
    double pace_ = 0.0;
    Vec3 goal_{0.0};
};

// A body that moves and turns about where it stands, up to a twentieth of a metre a tick (before scaling).
class StressTumble {
public:
    StressTumble(RandomValues& random, const StressSetting& setting) : random_(random), setting_(setting) {
        fastest_ = random.magnitude(1e-5, 5e-2);
    }

    Pose next() {
        if (random_.below(50) == 0) {
            velocity_ = fastest_ * random_.in_ball(1.0);
            axis_ = random_.direction();
            rate_ = fastest_ * random_.unit();
        }
        if (glm::length(offset_ + velocity_) > 0.5) {  // no sheet's rim comes near the hand
            velocity_ = Vec3(0.0);
            offset_ *= 0.99;
        }
        offset_ += velocity_;
        const Vec3 turn = std::sin(0.5 * rate_) * axis_;
        rotation_ = glm::normalize(Quat(std::cos(0.5 * rate_), turn.x, turn.y, turn.z) * rotation_);
        // Turned about the mesh's own place, not about the distant origin of its coordinates.
        return {setting_.place + setting_.scale * offset_ - rotation_ * setting_.place, rotation_};
    }

private:
    RandomValues& random_;
    const StressSetting& setting_;
    double fastest_ = 0.0;
    Vec3 velocity_{0.0};
    Vec3 offset_{0.0};
    Vec3 axis_{0.0, 1.0, 0.0};
    double rate_ = 0.0;
    Quat rotation_{1.0, 0.0, 0.0, 0.0};
};

}  // namespace tactus::shared
