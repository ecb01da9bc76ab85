// A body that gives, in the loop: its two last forms as they are touched, what presses it in this tick, and
// what it lies on. Made off the loop, private to session/.
#pragma once

#include <array>
#include <memory>
#include <span>

#include "core/geometry/touch_shape.hpp"
#include "core/soft/soft_body.hpp"
#include "physics/physics_world.hpp"
#include "session/session_types.hpp"
#include "session/soft_view.hpp"

namespace tactus {

// What is touched of one at rest.
std::shared_ptr<TouchShape> soft_touch_shape(const SoftModel& model, const ParallelRunner& run);

class SoftSlot {
public:
    static constexpr std::size_t max_obstacles = 16;
    struct Obstacle {
        int body = -1;         // slot in the touch scene
        std::size_t part = 0;  // of its shape

        bool operator==(const Obstacle&) const = default;
    };

    // `view` may be null: nobody draws it. `mask`: layers that it lies on.
    SoftSlot(std::shared_ptr<const SoftModel> model, std::shared_ptr<SoftView> view, std::uint32_t mask,
             const ParallelRunner& run);

    SoftBody body;
    std::uint32_t mask;

    // Goes on as the other is made, in its own shape and motion, and is shown where the other was. The other
    // gets what it had. False, and nothing happens, where the two differ in more than what they are made of.
    bool exchange_make(SoftSlot& other);

    // Its form as it was touched last, and the one that it takes next: true where that is another one.
    const TouchShape& form() const { return forms_[shown_]; }
    bool take_form();
    // No corner went farther from the one to the other (unit: meters).
    double gave_by() const { return gave_by_; }

    // Something presses it where it is touched, in this tick: at spring.point on that triangle. `at` is the
    // body's place.
    void press(const Pose& at, const FeatureId& feature, const SpringForce& spring);
    bool is_pressed() const { return push_count_ > 0; }
    // In this tick it is stepped, or left as it is.
    void begin_step(std::uint64_t tick) { tick_ = tick; }
    void skip(std::uint64_t tick) {
        tick_ = tick;
        push_count_ = 0;
    }
    bool was_stepped(std::uint64_t tick) const { return tick_ == tick; }
    // What presses it does so in one step from here. `gravity` in the world.
    std::uint32_t step(const Pose& at, const Vec3& gravity);

    // What it lies on, or may soon. Where that is another one, all of it is new to the body, which wakes.
    std::span<const Obstacle> near() const { return std::span(near_).first(near_count_); }
    std::span<SoftObstacle> obstacles() { return std::span(obstacles_).first(near_count_); }
    void set_near(std::span<const Obstacle> found);

private:
    std::array<Obstacle, max_obstacles> near_{};
    std::array<SoftObstacle, max_obstacles> obstacles_{};  // one each, as in the last step
    std::size_t near_count_ = 0;
    std::array<TouchShape, 2> forms_;
    std::array<std::shared_ptr<TriangleTree>, 2> trees_;  // of the forms
    std::size_t shown_ = 0;
    bool moved_ = false;  // since the form that is shown
    double gave_by_ = 0.0;
    TriangleMesh surface_;
    std::shared_ptr<SoftView> view_;
    std::array<SoftPush, SoftBody::max_pushes> pushes_;
    std::size_t push_count_ = 0;
    std::uint64_t tick_ = 0;  // the last that it was stepped in, or left out
};

}  // namespace tactus
