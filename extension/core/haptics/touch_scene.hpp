// Every body that can be touched, where it is now and where it was a tick ago. Owned by one session; proxies
// read it.
//
// Slots are reserved at set-up: add, move and remove allocate nothing. The scene does not own the shapes:
// whoever adds a body keeps its shape alive until the body is removed.
#pragma once

#include <array>
#include <cassert>
#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry/touch_shape.hpp"
#include "core/haptics/touch_material.hpp"

namespace tactus {

struct TouchBody {
    const TouchShape* shape = nullptr;  // null: the slot is free
    Pose pose;                          // in the world, now
    Pose previous;                      // in the world, one tick ago
    TouchMaterial material;
    std::uint32_t layer = 1;  // bits; a proxy touches it where its mask has one of them
    bool moved = false;       // since the last tick
    double moved_by = 0.0;    // no point of the body moved farther since the last tick (unit: meters)
    double gave_by = 0.0;     // no corner of it gave farther, likewise
    const TouchShape* former = nullptr;  // its form one tick ago; null: it has not deformed since
    std::uint32_t first_part =
        0;  // its parts are scene parts first_part … first_part + shape->parts.size() - 1
};

// One part of one body, placed in the world.
struct ScenePart {
    const TouchPart* part = nullptr;  // null: the slot is free
    std::uint32_t body = 0;
    Pose pose;
    Pose previous;
};

class TouchScene {
public:
    TouchScene(std::size_t max_bodies, std::size_t max_parts);

    // Returns the body's slot, or -1 where the scene is full.
    int add(const TouchShape& shape, const Pose& pose, const TouchMaterial& material, std::uint32_t layer);
    void remove(int body);

    // Call once at the start of a tick, before the poses of that tick are set.
    void begin_tick();
    // Where the body is this tick. Proxies sweep along the way it took; `teleport` says that it took none.
    void set_pose(int body, const Pose& pose, bool teleport = false);
    // The body, and the way it took this tick, is rigidly moved elsewhere: a correction, not a motion.
    void displace(int body, const Pose& motion);
    void set_material(int body, const TouchMaterial& material) {
        body_at(body).material = material;
        ++material_changes_;
    }
    void set_layer(int body, std::uint32_t layer);
    // The body takes another form, its parts one by one; the former must live until the next tick has begun.
    // Proxies sweep along the way of the triangles that are refits of those before. False, and nothing
    // happens, where the parts are not as many.
    bool deform(int body, const TouchShape& shape);
    // The same for a body that gives under what touches it, in every tick, no corner by more than `by`: no
    // change to what is felt. False, and nothing happens, where the triangles are not refits of those before.
    bool give(int body, const TouchShape& shape, double by);
    // The same form with more, or less, known of what can be touched of it (see narrowed()): no change to
    // what is felt. False, and nothing happens, where a part is of another tree, or of none where it had one.
    bool narrow(int body, const TouchShape& shape);

    std::size_t slots() const { return bodies_.size(); }
    std::size_t slots_in_use() const { return used_; }  // all bodies are below
    const TouchBody& body(int slot) const {
        assert(slot >= 0 && static_cast<std::size_t>(slot) < bodies_.size());
        return bodies_[static_cast<std::size_t>(slot)];
    }
    std::span<const ScenePart> parts() const { return parts_; }
    std::span<const int> moved_bodies() const { return moved_; }
    std::span<const int> deformed_bodies() const { return deformed_; }
    // Nothing has moved or deformed since the last tick.
    bool is_still() const { return moved_.empty() && deformed_.empty(); }
    std::uint64_t ticks() const { return ticks_; }  // begun so far

    // Parts of a body that was added, removed, teleported, deformed, narrowed or changed its layer: what a
    // proxy remembers of them is void.
    struct Change {
        enum class Kind : std::uint8_t {
            came,
            went,
            elsewhere,
            layer,
            form,
            gives,
            narrowed
        } kind = Kind::came;
        std::uint32_t first_part = 0;
        std::uint32_t part_count = 0;
        int body = -1;
        Pose from;                     // its pose before; the same as now where that did not change
        std::uint32_t layer_from = 0;  // its layer before
    };
    // Counts the changes. The last `remembered_changes` can be asked for by their number.
    static constexpr std::uint64_t remembered_changes = 64;
    std::uint64_t revision() const { return revision_; }
    const Change& change(std::uint64_t revision) const { return changes_[revision % remembered_changes]; }
    // Nothing has happened since that revision but that bodies give, or were narrowed.
    bool only_gives_since(std::uint64_t revision) const;
    // Counts materials that were set.
    std::uint64_t material_changes() const { return material_changes_; }

private:
    TouchBody& body_at(int slot) { return bodies_[static_cast<std::size_t>(slot)]; }
    int find_parts(std::size_t count) const;
    void take_form(int body, const TouchShape& shape, Change::Kind kind);
    void note_change(int body, Change::Kind kind, const Pose& from, std::uint32_t layer_from);

    std::vector<TouchBody> bodies_;
    std::vector<ScenePart> parts_;
    std::vector<int> moved_;
    std::vector<int> deformed_;
    std::size_t bodies_full_below_ = 0, parts_full_below_ = 0;  // no slot is free before these
    std::size_t used_ = 0;                                      // every slot from here on is free
    std::array<Change, remembered_changes> changes_;
    std::uint64_t revision_ = 1;
    std::uint64_t material_changes_ = 0;
    std::uint64_t ticks_ = 0;
};

// Where a point fixed to the body was one tick ago, given where it is now.
inline Vec3 previous_place(const TouchBody& body, const Vec3& point) {
    return body.moved ? to_parent(body.previous, to_local(body.pose, point)) : point;
}

}  // namespace tactus
