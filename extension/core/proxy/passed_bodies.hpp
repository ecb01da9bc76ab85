// Bodies that the proxy goes through for now: one whose surface broke under the hand, and one that stands
// where the proxy is, because it appeared there, was put there, grew, or left it no room between itself and
// others. Such a body is not touched until the sphere is clear of it again; one that broke, until the sphere
// is out on the side where it went in, since a shaft is through it until then. So touch always begins with a
// sphere that overlaps nothing, and without a kick.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

#include "core/haptics/touch_scene.hpp"
#include "core/tree/work.hpp"

namespace tactus {

enum class PassedBecause : std::uint8_t {
    broken,    // its surface gave way: it is open until the sphere has come out as it went in
    overlaps,  // it stands where the sphere is: the sphere has to be let out first
    squeezes,  // likewise, and moving bodies have left no room
};

// How a sphere stands to a body.
struct Overlap {
    // From the centre to the nearest surface, or to any that is near enough, negative inside a solid; `far`
    // of the question where it is farther (unit: meters).
    double distance = 0.0;
    bool inside = false;  // a solid, or a closed mesh
    bool known = true;    // false: the work ran out before that of a mesh was clear
};

// What is asked whether the centre is inside of it, beside how far it is: solids tell anyway; of closed
// meshes all, none, or those that are touched from one side.
enum class Insides { of_solids, of_one_sided, of_all };
// `pose`: of the body, in the world. Where a surface is nearer than `enough`, no nearer one is looked for
// (unit: meters).
Overlap overlap_with(const TouchShape& shape, const Pose& pose, const Vec3& center, double far, double enough,
                     Insides insides, WorkBudget& work);

// Where a surface gave way, in its body's frame.
struct BrokenAt {
    Vec3 point{0.0};             // (unit: meters)
    Vec3 normal{0.0, 1.0, 0.0};  // unit, out of the body
    double force = 0.0;          // that broke it (unit: newtons)
};

class PassedBodies {
public:
    static constexpr std::size_t capacity = 8;

    struct Passed {
        int body = -1;
        PassedBecause reason = PassedBecause::overlaps;
        bool entered = false;  // the sphere has been within its surface since
        BrokenAt broken{};     // of that reason alone
    };

    // False where there are too many already.
    bool pass(int body, PassedBecause reason, const BrokenAt& broken = {});
    std::span<const Passed> all() const { return {passed_.data(), count_}; }
    bool contains(int body) const {
        return std::ranges::any_of(all(), [&](const Passed& p) { return p.body == body; });
    }
    bool empty() const { return count_ == 0; }
    std::size_t count() const { return count_; }
    bool any(PassedBecause reason) const {
        return std::ranges::any_of(all(), [&](const Passed& p) { return p.reason == reason; });
    }

    // Takes out those that a sphere of that radius around `center` is clear of (unit: meters): by `room`, and
    // outside where it has to be.
    void update(const TouchScene& scene, const Vec3& center, double room, WorkBudget& work);
    // Another body has its slot now, or none.
    void forget(int body);

private:
    std::array<Passed, capacity> passed_{};
    std::size_t count_ = 0;
};

}  // namespace tactus
