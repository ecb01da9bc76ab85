#include "core/proxy/letting_out.hpp"

#include <algorithm>

namespace tactus {

namespace {

using Change = TouchScene::Change;

// A sphere that just touches has room enough: the first step lifts it off by what is missing.
constexpr double touching_share = 0.02;

bool is_form(Change::Kind kind) {
    return kind == Change::Kind::form || kind == Change::Kind::gives;
}

bool is_one_sided(const TouchShape& shape) {
    return std::ranges::any_of(shape.parts, &TouchPart::one_sided);
}

bool rests_on(const TouchingSphere& sphere, int body) {
    return std::ranges::any_of(sphere.touching, [&](const Touch& c) { return c.body == body; });
}

// Where a closed mesh that can be touched from inside was already around the point before it went elsewhere,
// it still is.
bool was_inside(const TouchBody& body, const Change* change, std::uint32_t mask, const Vec3& point,
                WorkBudget& work) {
    if (!change) {
        return true;
    }
    const bool known_before = change->kind == Change::Kind::elsewhere || change->kind == Change::Kind::layer;
    return known_before && (change->layer_from & mask) != 0 &&
           overlap_with(*body.shape, change->from, point, 0.0, 0.0, Insides::of_all, work).inside;
}

// `change`: what has happened to the body; null where the sphere is what has changed.
bool must_be_let_out_of(const TouchBody& body, int slot, const Change* change, const TouchingSphere& sphere,
                        WorkBudget& work) {
    const bool rides =
        change && is_form(change->kind) && body.former && is_deformation(*body.former, *body.shape);
    if (!body.shape || (body.layer & sphere.mask) == 0 || rides) {
        return false;
    }
    const bool known = rests_on(sphere, slot) && (!change || change->kind != Change::Kind::came);
    const double room = sphere.radius * (1.0 - (known ? max_overlap_share : touching_share));
    // From where it was a tick ago on it pushes the sphere ahead.
    const Overlap at =
        overlap_with(*body.shape, body.previous, sphere.center, room, room, Insides::of_all, work);
    if (at.distance < room) {
        return true;
    }
    return at.inside &&
           (is_one_sided(*body.shape) || !was_inside(body, change, sphere.mask, sphere.center, work));
}

// Of several changes of one body the first. Where it was narrowed, it is as it was.
bool counts(const TouchScene& scene, std::uint64_t since, std::uint64_t revision) {
    const Change& change = scene.change(revision);
    bool is_first = change.kind != Change::Kind::narrowed;
    for (std::uint64_t number = since + 1; is_first && number < revision; ++number) {
        const Change& earlier = scene.change(number);
        is_first = earlier.kind == Change::Kind::narrowed || earlier.body != change.body;
    }
    return is_first;
}

}  // namespace

bool let_out(const TouchScene& scene, std::uint64_t since, bool all, const TouchingSphere& sphere,
             PassedBodies& passed, WorkBudget& work) {
    bool every = true;
    const auto look_at = [&](int slot, const Change* change) {
        if (change && (change->kind == Change::Kind::came || change->kind == Change::Kind::went)) {
            passed.forget(slot);
        }
        if (!passed.contains(slot) && must_be_let_out_of(scene.body(slot), slot, change, sphere, work)) {
            every = passed.pass(slot, PassedBecause::overlaps) && every;
        }
    };
    // A sphere that has not seen the scene before knows of no change in it: revisions begin at 1.
    if (since > 0 && scene.revision() - since <= TouchScene::remembered_changes) {
        for (std::uint64_t revision = since + 1; revision <= scene.revision(); ++revision) {
            if (counts(scene, since, revision)) {
                look_at(scene.change(revision).body, &scene.change(revision));
            }
        }
    } else {
        all = true;
    }
    for (std::size_t slot = 0; all && slot < scene.slots(); ++slot) {
        look_at(static_cast<int>(slot), nullptr);
    }
    return every;
}

bool let_out_of_squeeze(const TouchScene& scene, const TouchingSphere& sphere, PassedBodies& passed,
                        WorkBudget& work) {
    bool every = true;
    const double room = sphere.radius * (1.0 - max_overlap_share);
    for (const int slot : scene.moved_bodies()) {
        const TouchBody& body = scene.body(slot);
        if ((body.layer & sphere.mask) != 0 && !passed.contains(slot) &&
            overlap_with(*body.shape, body.pose, sphere.center, room, room, Insides::of_solids, work)
                    .distance < room) {
            every = passed.pass(slot, PassedBecause::squeezes) && every;
        }
    }
    return every;
}

bool is_inside_one_sided(const TouchScene& scene, const Vec3& point, std::uint32_t mask, WorkBudget& work) {
    for (std::size_t slot = 0; slot < scene.slots(); ++slot) {
        const TouchBody& body = scene.body(static_cast<int>(slot));
        if (body.shape && (body.layer & mask) != 0 && is_one_sided(*body.shape) &&
            overlap_with(*body.shape, body.pose, point, 0.0, 0.0, Insides::of_one_sided, work).inside) {
            return true;
        }
    }
    return false;
}

}  // namespace tactus
