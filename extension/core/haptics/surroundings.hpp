// What one proxy knows about the scene around it: which parts could be touched soon, which not, and for how
// long that stays true. Answers the two questions of the motion: which surfaces are in contact, and how far
// is the way free.
//
// A part at distance D cannot be reached before proxy and part together have travelled D. So a far part is
// looked at again only when the odometer says so: in free space a tick looks at no part at all, however many
// there are.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/haptics/contact.hpp"
#include "core/haptics/near_triangles.hpp"
#include "core/haptics/neighbourhood.hpp"
#include "core/haptics/passed_bodies.hpp"
#include "core/haptics/tolerances.hpp"
#include "core/haptics/touch_scene.hpp"

namespace tactus {

class Surroundings {
public:
    explicit Surroundings(std::size_t most_parts);

    // Opens a tick: takes in what the scene says has changed. `center` is where the proxy is. False where
    // nothing near the proxy has changed since the last tick.
    bool begin_tick(const TouchScene& scene, const Vec3& center, double radius, std::uint32_t mask);

    // The proxy has moved by `length`.
    void travelled(double length) { odometer_ += length; }
    // The proxy has been put elsewhere, `length` away.
    void jumped(double length) {
        odometer_ += length;
        odometer_at_tick_ += length;
    }

    // True where nothing can be met within `length` of the centre, as far as is already known.
    bool is_clear(double length) const;

    // Contacts with a gap of at most `tolerances.reach + beyond` around the centre. `keep_all` also keeps
    // edges and corners that another triangle covers (see NearTriangles).
    void find_contacts(const Vec3& center, ContactList& out, double beyond = 0.0, bool keep_all = false);

    // The earliest t in [0, 1] at which the sphere moving from center to center + motion is stopped; above 1:
    // free. The body `except` is not in the way: the one that causes the motion.
    double sweep(const Vec3& center, const Vec3& motion, int except = -1);

    // The next part near the proxy, counting from `from`, that has run into it since the last tick; false
    // where there is none. `displacement` is what keeps the proxy from being passed. The body `carrier` does
    // not count: the proxy already moved with it.
    struct Push {
        int body = -1;
        Vec3 displacement{0.0};
    };
    bool next_push(std::size_t& from, const Vec3& center, int carrier, Push& push);

    // Bodies that are not in the way for now.
    PassedBodies& passed() { return passed_; }
    const PassedBodies& passed() const { return passed_; }

    // What this tick may still look at.
    Work& work_left() { return work_left_; }

    // False where this tick has looked at so much that it must end: what is still missing is for the next.
    bool may_go_on() const { return work_left_ > 0; }

    // False where a surface is nearer to the centre than `room`, or the centre is inside a solid.
    bool has_room(const Vec3& center, double room);

    const Tolerances& tolerances() const { return tolerances_; }

private:
    enum class Place : std::uint8_t { absent, far, near };

    struct Record {
        double clear_until = 0.0;  // odometer + slack reading before which the sphere cannot touch the part
        double slack = 0.0;        // how far the part itself has moved since it was first met
        double slack_until = 0.0;  // far: it stays so until it has moved that far
        Place place = Place::absent;
        std::int16_t hood = -1;   // its neighbourhood, -1: none
        std::uint32_t stamp = 0;  // tells entries of the far heap that are out of date
    };

    struct Far {
        double due;  // odometer reading at which to look again
        std::uint32_t part;
        std::uint32_t stamp;
    };

    bool take_in_changes(const TouchScene& scene, const Vec3& center, double radius, std::uint32_t mask);
    void forget_all(const Vec3& center);
    void forget(std::uint32_t part, const Vec3& center);
    void follow_moved_bodies();
    bool is_passed(std::uint32_t body) const { return passed_.contains(static_cast<int>(body)); }
    void bring_near(double length, const Vec3& center);
    void make_near(std::uint32_t part);
    void leave_near(std::uint32_t part);
    void send_far(std::uint32_t part, double distance);
    void push_far(const Far& far);
    static bool is_due_later(const Far& p, const Far& q);
    void retire_distant_parts();
    double odometer_for(const Record& record) const { return odometer_ + record.slack; }
    double distance_to_ball(std::uint32_t part, const Vec3& center) const;
    double distance_bound(std::uint32_t part, const Vec3& center) const;
    Neighbourhood* hood_around(std::uint32_t part, const Vec3& local, double way);
    double sweep_tree(std::uint32_t part, const Vec3& start, const Vec3& motion, double length, double limit);
    double sweep_hood(Neighbourhood& hood, const TriangleTree& tree, double now, const Vec3& start,
                      const Vec3& motion, double limit);
    void find_tree_contacts(std::uint32_t part, const Vec3& local, double beyond, ContactList& out,
                            bool keep_all);
    void find_solid_contact(std::uint32_t part, const Vec3& local, double beyond, ContactList& out);
    double look_around(Neighbourhood& hood, const TriangleTree& tree, double now, const Vec3& local,
                       double limit);
    double look_everywhere(const TriangleTree& tree, const Vec3& local, double limit);

    // What one tick may look at, in packs of four triangles: some 30 ns each, below half a millisecond.
    static constexpr Work most_work = 16'384;

    const TouchScene* scene_ = nullptr;
    std::uint64_t revision_ = 0;
    std::uint64_t ticks_ = 0;
    std::uint32_t mask_ = 0;
    double radius_ = 0.0;
    Tolerances tolerances_{};
    double magnitude_ = 0.0;  // largest coordinate that the tolerances are good for (unit: meters)
    double odometer_ = 0.0;
    double odometer_at_tick_ = 0.0;
    double pace_ = 0.0;         // recent travel per tick (unit: meters)
    Vec3 center_at_tick_{0.0};  // in the world
    Vec3 last_way_{0.0};        // of the tick before, in the world (unit: meters)
    std::vector<Record> records_;
    std::vector<Far> far_;  // a heap, soonest due on top
    std::vector<std::uint32_t> near_;
    PassedBodies passed_;
    Work work_left_ = 0;
    std::unique_ptr<Neighbourhood[]> hoods_;
    std::vector<std::int16_t> free_hoods_;
    std::unique_ptr<NearTriangles>
        near_triangles_;  // scratch of find_tree_contacts, too large to make anew each time
};

}  // namespace tactus
