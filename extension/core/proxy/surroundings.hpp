// What one sphere touches where it is, and how far its way is free: the parts that the broad phase calls near
// are asked, each through what is remembered of its triangles, through its tree, or in closed form.
#pragma once

#include <cstdint>
#include <span>

#include "core/proxy/broad_phase.hpp"
#include "core/proxy/contact_gathering.hpp"
#include "core/proxy/contact_look.hpp"
#include "core/proxy/features_in_mind.hpp"
#include "core/proxy/passed_bodies.hpp"
#include "core/proxy/tree_memories.hpp"

namespace tactus {

// A sweep that takes longer than a tick has, through a part whose triangles are too many: the others are
// asked anew in each.
struct LongSweep {
    std::uint32_t part = 0;
    std::uint64_t lineage = 0;  // of the tree that was asked; 0: none so far
    SweepProgress progress{};
    bool is_done = false;
};

class Surroundings {
public:
    explicit Surroundings(std::size_t max_parts) : broad_phase_(max_parts) {}

    // Opens a tick, in which no more work is done than `work` has left. `center` is where the sphere is.
    // False where nothing near it has changed since the last tick.
    bool begin_tick(const TouchScene& scene, const Vec3& center, double radius, std::uint32_t mask,
                    const WorkBudget& work);

    void travelled(double length) { broad_phase_.travelled(length); }
    void jumped(double length) {
        broad_phase_.jumped(length);
        doubt();
    }

    // Where the sphere fits, what it can touch of a mesh answers for all of it (touchable.hpp). Sweeps and
    // moving bodies that push it ahead never bring it nearer to a surface than it rests; whatever else may
    // have is said here. Then it is asked once, of the whole mesh; as long as it does not fit, all questions
    // are.
    void doubt() { is_sure_ = false; }
    void make_sure(const Vec3& center) { is_sure_ = is_sure_ || fits_everywhere(center); }

    // True where nothing can be met within `length` of the centre, as far as is already known.
    bool is_clear(double length) const;

    // Contacts around the centre: those within reach of rest, or of the nearest surface where that is up to
    // `beyond` above rest, and the few nearest of what is up to `ahead` farther.
    void find_contacts(const Vec3& center, ContactList& out, double beyond = 0.0, double ahead = 0.0);
    // The same of what is in mind alone.
    void recall_contacts(const Vec3& center, ContactList& out, double beyond);

    // One contact for each part up to that gap: as near as any to 1e-4 of the radius, as far as a bounded
    // search tells. Where thousands of triangles are about as near, to find them all takes longer than a
    // tick.
    void find_nearest_contacts(const Vec3& center, double max_gap, ContactList& out);

    // False where the work did not suffice for everything that the sphere overlaps, when they were found
    // last.
    bool saw_all() const { return seen_gap_ >= 0.0; }
    // No surface that is not among the contacts found last is less far above rest; 0 says nothing (unit:
    // meters).
    double unseen_gap() const { return std::max(0.0, seen_gap_ - tolerances().same); }

    // For a close look at contacts around the centre.
    ContactLook look_from(const Vec3& center) { return {*scene_, center, rest(), tolerances().same, work_}; }

    // How far the sphere can go along the way from the centre. The body `except` is not in the way: the one
    // that causes the motion. `stopped_by` is what the way ends at, where something does.
    Hit sweep(const Vec3& center, const Vec3& motion, FeatureId& stopped_by, int except = -1);
    // The same over several ticks, as long as nothing moves: nothing is known until it is done.
    Hit sweep_on(const Vec3& center, const Vec3& motion, LongSweep& asked, FeatureId& stopped_by);
    // What counts as a contact in what is found next.
    FeaturesInMind& mind() { return mind_; }

    // The next part near the sphere, counting from `from`, that has run into it since the last tick; false
    // where there is none. `displacement` is what keeps the sphere from being passed. The body `carrier` does
    // not count: the sphere already moved with it.
    struct Push {
        int body = -1;
        Vec3 displacement{0.0};
    };
    bool next_push(std::size_t& from, const Vec3& center, int carrier, Push& push);

    // Bodies that are not in the way for now.
    PassedBodies& passed() { return passed_; }
    const PassedBodies& passed() const { return passed_; }

    // False where a surface is nearer to the centre than `room`, the sphere's radius at most, or the centre
    // is inside a solid.
    bool has_room(const Vec3& center, double room);

    // How far a sweep had best ask: about as far as the last ways were free (unit: meters).
    double first_stride() {
        return stride_ = std::clamp(stride_, least_stride * radius_, first_stride_max * radius_);
    }
    double next_stride(double length, bool free) { return stride_ = free ? 4.0 * stride_ : 2.0 * length; }

    WorkBudget& work() { return work_; }
    const Tolerances& tolerances() const { return broad_phase_.tolerances(); }

private:
    // Of the radius. Every sweep looks at what is near where it begins, and at what a disc as wide as its way
    // holds: at a fifth of the radius the two cost about the same over fine meshes.
    static constexpr double least_stride = 0.02;
    static constexpr double first_stride_max = 0.2;

    bool counts(std::uint32_t part, double length, int except) const;
    double rest() const { return radius_ + tolerances().skin; }
    const TriangleTree& tree_of(std::uint32_t part) const;
    // What touches is told by its slot in the tree of all triangles: one of the others names those.
    std::uint32_t slot_in_whole(std::uint32_t part, const TriangleTree& tree, std::uint32_t slot) const {
        return &tree == scene_->parts()[part].part->tree() ? slot : tree.triangle_at(slot);
    }
    std::span<const std::uint32_t> bring_near(double length, const Vec3& center);
    bool has_room_beside(std::uint32_t part, const Vec3& center, double room);
    bool fits(std::uint32_t part, const Vec3& center);
    bool fits_everywhere(const Vec3& center);
    double wanted_margin() const;
    PackMemory* memory_around(std::uint32_t part, const TriangleTree& tree, const Vec3& local, double way);
    SphereWay way_in(std::uint32_t part, const Vec3& center, const Vec3& motion) const;
    template <class MayBeMet>
    Hit sweep_parts(const Vec3& center, const Vec3& motion, FeatureId& stopped_by, MayBeMet&& may_be_met);
    void sweep_part(std::uint32_t part, const Vec3& center, const Vec3& motion, Hit& first,
                    FeatureId& stopped_by);
    Hit sweep_tree(std::uint32_t part, const SphereWay& way, double limit);
    void leave_out(std::uint32_t part);
    void drop_beyond(double max_gap, ContactList& out);
    void find_tree_contacts(std::uint32_t part, const Vec3& local, double ahead, ContactGathering& out);
    void find_solid_contact(std::uint32_t part, const Vec3& local, ContactGathering& out);
    void add_in_mind(const Vec3& center, double max_gap, ContactList& out);
    void make_room(ContactList& out);
    void add_insisted(const Vec3& center, ContactList& out);
    void add_seen(const Contact& contact, ContactGathering& out);

    const TouchScene* scene_ = nullptr;
    double radius_ = 0.0;
    double stride_ = 0.0;
    BroadPhase broad_phase_;
    WorkBudget work_{0};
    double seen_gap_ = 0.0;  // up to there above rest all is among the contacts found last (unit: meters)
    bool is_sure_ = false;   // no triangle is nearer than touchable_share of the radius
    PassedBodies passed_;
    FeaturesInMind mind_;
    TreeMemories memories_;
};

}  // namespace tactus
