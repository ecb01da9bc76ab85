// Which parts of the scene can matter to one sphere, and for how long the others cannot.
//
// Theorem of the odometer. Let s be the length of the sphere's path so far and m that of a bound on the way
// of every point of a part. If sphere and part were D apart when s + m read R, they do not touch while
// s + m < R + D: distance is Lipschitz with constant 1 in the place of either. So a part at distance D needs
// no look until its reading has grown by D: in free space a tick looks at no part at all, however many there
// are.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "core/haptics/touch_scene.hpp"
#include "core/proxy/tolerances.hpp"
#include "core/tree/work.hpp"

namespace tactus {

class BroadPhase {
public:
    explicit BroadPhase(std::size_t max_parts);

    // Opens a tick: takes in what the scene says has changed. `center` is where the sphere is. False where
    // nothing that it remembers has become void.
    bool begin_tick(const TouchScene& scene, const Vec3& center, double radius, std::uint32_t mask);

    // Whether something that it remembers has become void in this tick: bodies have come, gone or changed.
    bool has_forgotten() const { return has_forgotten_; }

    // The sphere has moved by `length`.
    void travelled(double length) { odometer_ += length; }
    // The sphere has been put elsewhere, `length` away.
    void jumped(double length) {
        odometer_ += length;
        odometer_at_tick_ += length;
    }

    // Makes sure that every part within `length` of the sphere is in near(): with the work gone, only up to
    // far_clearance().
    void bring_near(double length, const Vec3& center, WorkBudget& work);
    std::span<const std::uint32_t> near() const { return near_; }
    // How far the sphere can go at least before it touches a part that is not near.
    double far_clearance() const {
        return far_.empty() ? std::numeric_limits<double>::infinity() : far_.front().due - odometer_;
    }

    // s + m for one part (unit: meters).
    double reading(std::uint32_t part) const { return odometer_ + records_[part].own_way; }
    // True where the sphere cannot touch the part before it has gone `length`.
    bool is_clear(std::uint32_t part, double length) const {
        return records_[part].clear_until > reading(part) + length;
    }
    // How far it can go at least before it touches the part.
    double clearance(std::uint32_t part) const {
        return std::max(0.0, records_[part].clear_until - reading(part));
    }
    // No surface of the part is nearer to the sphere than `distance` now.
    void set_clear(std::uint32_t part, double distance) {
        records_[part].clear_until = reading(part) + distance;
    }
    // Changes whenever what is remembered of the part's surface becomes void.
    std::uint32_t stamp(std::uint32_t part) const { return records_[part].stamp; }

    double pace() const { return pace_; }               // recent travel a tick (unit: meters)
    const Vec3& last_way() const { return last_way_; }  // of the tick before, in the world (unit: meters)
    const Tolerances& tolerances() const { return tolerances_; }

private:
    enum class Place : std::uint8_t { absent, far, near };

    struct Record {
        double clear_until = 0.0;    // reading before which the sphere cannot touch the part
        double own_way = 0.0;        // m: how far the part itself has moved since it was first met
        double own_way_until = 0.0;  // far: it stays so until it has moved that far
        Place place = Place::absent;
        std::uint32_t stamp = 0;  // tells entries of the far heap, and memories, that are out of date
        std::uint32_t index = 0;  // near: in near_
    };

    struct Far {
        double due;  // odometer reading at which to look again
        std::uint32_t part;
        std::uint32_t stamp;
    };

    bool take_in_changes(const TouchScene& scene, const Vec3& center, double radius, std::uint32_t mask);
    double magnitude_near(const Vec3& center, double radius) const;
    bool needs_other_tolerances(double magnitude);
    void forget_all(const Vec3& center);
    void forget(std::uint32_t part, const Vec3& center);
    void follow_moved(const TouchBody& body);
    bool is_distant(std::uint32_t part, double distance) const;
    void retire_distant_parts();
    void make_near(std::uint32_t part);
    void leave_near(std::uint32_t part);
    void send_far(std::uint32_t part, double distance);
    void push_far(const Far& far);
    static bool is_due_later(const Far& p, const Far& q) { return p.due > q.due; }
    double margin() const { return radius_ + 2.0 * tolerances_.reach + tolerances_.skin; }
    double distance_to_ball(std::uint32_t part, const Vec3& center) const;
    double distance_bound(std::uint32_t part, const Vec3& center, WorkBudget& work) const;
    void check_theorem(const Vec3& center) const;

    const TouchScene* scene_ = nullptr;
    bool has_forgotten_ = false;
    std::uint64_t revision_ = 0;
    std::uint64_t ticks_ = 0;
    std::uint32_t mask_ = 0;
    double radius_ = 0.0;
    Tolerances tolerances_{};
    double magnitude_ = 0.0;           // largest coordinate that the tolerances are good for (unit: meters)
    std::uint32_t smaller_ticks_ = 0;  // since it was needed
    double odometer_ = 0.0;            // s (unit: meters)
    double odometer_at_tick_ = 0.0;
    double pace_ = 0.0;
    Vec3 center_at_tick_{0.0};  // in the world
    Vec3 last_way_{0.0};
    std::vector<Record> records_;
    std::vector<Far> far_;  // a heap, soonest due on top
    std::vector<std::uint32_t> near_;
};

}  // namespace tactus
