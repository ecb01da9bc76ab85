#include "world/body_mirrors.hpp"

#include <algorithm>
#include <glm/geometric.hpp>
#include <unordered_set>
#include <utility>

#include "core/soft/soft_model.hpp"

namespace tactus {

namespace {

// Of all the bodies: no more than cost a tenth of a millisecond, in a large scene.
constexpr Turns looks{.frames_a_round = 128, .min = 4, .max = 32};

// Speeds are cheaper to ask for, and a throw should not wait.
constexpr Turns looks_at_speeds{.frames_a_round = 16, .min = 12, .max = 256};

// Whether a body that gives can lie on it: on solids alone, not on another one of its kind.
bool bears(const BodyForm& form) {
    return form.soft == nullptr && form.meshes.empty() && form.touched.empty() &&
           std::ranges::all_of(form.shapes, [](const PlacedShape& placed) {
               return !std::holds_alternative<ConvexHullShape>(placed.shape) &&
                      !std::holds_alternative<HeightFieldShape>(placed.shape);
           });
}

bool are_near(const BodyTwin& a, const BodyTwin& b) {
    return glm::distance(a.pose().position, b.pose().position) < a.reach() + b.reach();
}

// Calls come(id) for what has come, in the order of `there`; what has gone is let go.
template <class Mirror, class Come>
void match_to(const std::vector<std::uint64_t>& there, std::vector<std::unique_ptr<Mirror>>& mirrors,
              Session& session, const Come& come) {
    std::unordered_set<std::uint64_t> missing(there.begin(), there.end());
    std::erase_if(mirrors, [&](const auto& mirror) {
        const bool is_gone = !missing.contains(mirror->id());
        if (is_gone) {
            mirror->release(session);
        }
        return is_gone;
    });
    for (const auto& mirror : mirrors) {
        missing.erase(mirror->id());
    }
    for (const std::uint64_t id : there) {
        if (missing.contains(id)) {
            come(id);
        }
    }
}

}  // namespace

void BodyMirrors::match(const std::vector<std::uint64_t>& bodies, const MakeBody& make_body,
                        const std::vector<std::uint64_t>& joints, const MakeJoint& make_joint,
                        Session& session) {
    match_to(joints, joints_, session,
             [&](std::uint64_t id) { joints_.push_back(std::make_unique<JointMirror>(make_joint(id))); });
    ++arrivals_;
    match_to(bodies, bodies_, session, [&](std::uint64_t id) {
        bodies_.push_back(std::make_unique<BodyMirror>(make_body(id), arrivals_));
        news_->changed.push_back(id);
    });
    by_body_.clear();
    building_.clear();
    narrowing_.clear();
    thrown_.clear();
    close_.clear();
    arrived_.clear();
    std::ranges::fill(by_handle_, Shown{});
    for (const auto& mirror : bodies_) {
        by_body_[mirror->id()] = mirror.get();
        if (mirror->can_be_thrown()) {
            thrown_.push_back(mirror.get());
        }
        if (mirror->twin().is_narrowing()) {
            narrowing_.push_back(mirror.get());
        }
        if (mirror->is_close()) {
            close_.push_back(mirror.get());
            arrived_.push_back(mirror.get());
        }
    }
    std::ranges::sort(close_, {}, &BodyMirror::id);
    find_carried(bodies);
    for (const auto& mirror : bodies_) {
        take_handle(*mirror, no_handle);
    }
    handles_changed_ = true;
}

// `bodies`: all there are, parents first.
void BodyMirrors::find_carried(const std::vector<std::uint64_t>& bodies) {
    carried_.clear();
    for (const std::uint64_t id : bodies) {
        BodyMirror* const mirror = by_body_[id];
        if (!mirror->can_be_thrown()) {
            continue;
        }
        for (const BodyMirror* above = of(mirror->carrier()); above != nullptr;
             above = of(above->carrier())) {
            carried_[above->id()].push_back(mirror);
        }
    }
}

const BodyMirror* BodyMirrors::of(std::uint64_t body) const {
    const auto found = by_body_.find(body);
    return found != by_body_.end() ? found->second : nullptr;
}

SessionHandle BodyMirrors::body_of(std::uint64_t node) const {
    const BodyMirror* mirror = of(node);
    return mirror != nullptr ? mirror->handle() : no_handle;
}

std::uint64_t BodyMirrors::node_of(SessionHandle body) const {
    const BodyMirror* mirror = body < by_handle_.size() ? by_handle_[body].mirror : nullptr;
    return mirror != nullptr ? mirror->id() : 0;
}

void BodyMirrors::take_handle(BodyMirror& mirror, SessionHandle before) {
    if (mirror.handle() != before) {
        handles_changed_ = true;
        if (before != no_handle && by_handle_[before].mirror == &mirror) {
            by_handle_[before] = {};
        }
        if (mirror.handle() != no_handle) {
            by_handle_[mirror.handle()] = {&mirror, mirror.twin().shown_change(), mirror.moves(),
                                           carried_.contains(mirror.id())};
        }
    }
    std::erase(building_, &mirror);
    if (mirror.twin().is_building()) {
        building_.push_back(&mirror);
    }
}

// Whoever changes a mirror may have given it another handle.
template <class Change>
void BodyMirrors::change(BodyMirror& mirror, const Change& change) {
    const SessionHandle before = mirror.handle();
    change(mirror);
    take_handle(mirror, before);
}

void BodyMirrors::look_at_bodies(const MirrorContext& context) {
    moved_.clear();
    changed_.clear();
    std::swap(moved_, news_->moved);
    std::swap(changed_, news_->changed);
    const bool meshes_changed = std::exchange(mesh_changes_, context.mesh_changes) != context.mesh_changes;
    const auto look_at = [&](BodyMirror& mirror, bool shapes_changed = false) {
        change(mirror, [&](BodyMirror& one) { one.synchronise(context, shapes_changed); });
    };
    const auto each = [this](const std::vector<std::uint64_t>& ids, const auto& look) {
        for (const std::uint64_t id : ids) {
            if (const auto found = by_body_.find(id); found != by_body_.end()) {
                look(*found->second);
            }
        }
    };
    const std::vector<BodyMirror*> arrived = std::exchange(arrived_, {});
    if (!in_turn_ || std::exchange(all_changed_, false)) {
        for (const auto& mirror : bodies_) {
            if (!mirror->is_far() || !changed_.empty()) {
                look_at(*mirror, !changed_.empty());
            }
        }
        return;
    }
    std::ranges::for_each(arrived, [&](BodyMirror* mirror) { look_at(*mirror); });
    each(changed_, [&](BodyMirror& mirror) { look_at(mirror, true); });
    each(moved_, [&](BodyMirror& mirror) { mirror.follow(context); });
    for (const auto& mirror : bodies_) {
        if (meshes_changed && mirror->has_touched_mesh()) {
            look_at(*mirror);
        }
    }
    each(touched_, look_at);
    body_turns_.take(looks, bodies_, [&](const auto& mirror) {
        if (!mirror->is_far()) {
            look_at(*mirror);
        }
    });
    speed_turns_.take(looks_at_speeds, thrown_, [&](BodyMirror* mirror) { mirror->follow_speed(context); });
}

void BodyMirrors::look_at_joints(const MirrorContext& context) {
    const auto look_at = [&](const std::unique_ptr<JointMirror>& joint) {
        joint->synchronise(context.session, [this](std::uint64_t body) { return of(body); });
    };
    if (std::exchange(handles_changed_, false) || !in_turn_) {
        std::ranges::for_each(joints_, look_at);
    } else {
        joint_turns_.take(looks, joints_, look_at);
    }
}

void BodyMirrors::synchronise(const MirrorContext& context) {
    look_at_bodies(context);
    // Stepped time waits, so that every run has the same bodies in the same ticks.
    if (!in_turn_ && !building_.empty()) {
        context.workers.wait();
    }
    const std::vector<BodyMirror*> built = building_;
    for (BodyMirror* mirror : built) {
        if (context.together && has_to_wait(*mirror)) {
            continue;
        }
        change(*mirror, [&](BodyMirror& one) { one.take_ready(context); });
    }
    narrow(context, built);
    look_at_joints(context);
}

// What came together is there together: a body does not fall through a floor whose tree takes longer.
bool BodyMirrors::has_to_wait(const BodyMirror& mirror) const {
    return mirror.is_awaited() && std::ranges::any_of(building_, [&](const BodyMirror* other) {
               return other->is_awaited() && other->arrival() == mirror.arrival() &&
                      !other->twin().is_ready();
           });
}

// Another fingertip may be a smaller one.
void BodyMirrors::narrow(const MirrorContext& context, const std::vector<BodyMirror*>& built) {
    const auto begin = [&](BodyMirror& mirror) {
        mirror.narrow(context, narrowed_trees_);
        if (mirror.twin().is_narrowing()) {
            narrowing_.push_back(&mirror);
        }
    };
    if (std::exchange(touch_radius_, context.touch_radius) == context.touch_radius) {
        std::ranges::for_each(built, [&](BodyMirror* mirror) { begin(*mirror); });
    } else {
        narrowing_.clear();
        std::ranges::for_each(bodies_, [&](const auto& mirror) { begin(*mirror); });
    }
    if (!in_turn_ && !narrowing_.empty()) {
        context.workers.wait();
    }
    std::erase_if(narrowing_, [&](BodyMirror* mirror) {
        mirror->take_narrowed(context);
        mirror->narrow(context, narrowed_trees_);
        return !mirror->twin().is_narrowing();
    });
}

void BodyMirrors::show(const BodyState& state, std::uint64_t tick, Session& session) {
    BodyMirror* const mirror = state.handle < by_handle_.size() ? by_handle_[state.handle].mirror : nullptr;
    if (mirror == nullptr) {
        return;
    }
    Shown& shown = by_handle_[state.handle];
    if (shown.change != state.changed_at) {
        std::vector<std::pair<BodyMirror*, BodyMirror::Staying>> below;
        if (shown.carries) {
            for (BodyMirror* const carried : carried_[mirror->id()]) {
                below.emplace_back(carried, carried->hold_on());
            }
        }
        if (mirror->apply(state, tick, session)) {
            shown = {mirror, state.changed_at, true, shown.carries};
        }
        for (const auto& [carried, staying] : below) {
            carried->stay(staying);
        }
    } else if (std::exchange(shown.moves, false) && mirror->come_to_rest()) {
        news_->moved.push_back(mirror->id());
    }
}

void BodyMirrors::find_close(const PhysicsFrame& frame) {
    for (const std::uint64_t id : frame.close) {
        const auto found = by_body_.find(id);
        if (found == by_body_.end() || !found->second->may_be_far()) {
            continue;
        }
        if (!found->second->is_close()) {
            close_.push_back(found->second);
            arrived_.push_back(found->second);
        }
        found->second->come_close(frame.session);
    }
    std::erase_if(close_, [&frame](BodyMirror* mirror) { return !mirror->stays_close(frame); });
    std::ranges::sort(close_, {}, &BodyMirror::id);
}

void BodyMirrors::exchange(const PhysicsFrame& frame) {
    find_close(frame);
    std::size_t led = 0;
    for (BodyMirror* const mirror : close_) {
        led += mirror->can_be_thrown() && mirror->exchange(frame, led < max_led) ? 1 : 0;
    }
}

double BodyMirrors::widest_led() const {
    double widest = 0.0;
    for (const BodyMirror* const mirror : close_) {
        widest = mirror->is_led() ? std::max(widest, mirror->twin().reach()) : widest;
    }
    return widest;
}

std::vector<std::pair<SceneBody*, std::string>> BodyMirrors::fallen_through() const {
    std::vector<std::pair<SceneBody*, std::string>> all;
    for (const auto& soft : bodies_) {
        const BodyForm& form = soft->twin().planned().form;
        SceneBody* const body = soft->body();
        const auto model = form.soft != nullptr ? form.soft->built_so_far().model : nullptr;
        if (model == nullptr || !model->is_free() || body == nullptr) {
            continue;
        }
        for (const auto& other : bodies_) {
            const bool meets = (soft->twin().values().layers.mask & other->twin().values().layers.layer) != 0;
            const bool is_apart =
                other->twin().planned().form.soft != nullptr && !are_near(soft->twin(), other->twin());
            if (other != soft && meets && !is_apart && other->body() != nullptr &&
                !bears(other->twin().planned().form)) {
                all.emplace_back(body,
                                 "it falls through '" + other->body()->name() +
                                     "', whose shape bears no body that gives: give that one boxes, spheres, "
                                     "capsules, cylinders or a plane, or hold this one by 'held'");
                break;
            }
        }
    }
    return all;
}

std::size_t BodyMirrors::in_session() const {
    return static_cast<std::size_t>(
        std::ranges::count_if(bodies_, [](const auto& mirror) { return mirror->handle() != no_handle; }));
}

std::size_t BodyMirrors::without_place() const {
    return static_cast<std::size_t>(
        std::ranges::count_if(bodies_, [](const auto& mirror) { return mirror->twin().found_no_place(); }));
}

SceneFacts BodyMirrors::facts() const {
    SceneFacts facts;
    for (const auto& mirror : bodies_) {
        if (mirror->handle() != no_handle) {
            facts.add(mirror->layers().layer, mirror->twin().reach());
        }
    }
    return facts;
}

std::vector<QueriedBody> BodyMirrors::touchable(std::uint32_t mask) const {
    std::vector<QueriedBody> touchable;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        const BodyMirror& mirror = *bodies_[i];
        if (mirror.twin().touch() != nullptr && (mirror.layers().layer & mask) != 0) {
            touchable.push_back({mirror.twin().touch(), mirror.pose(), i});
        }
    }
    return touchable;
}

std::vector<std::string> BodyMirrors::problems() const {
    std::vector<std::string> all;
    if (const std::size_t left_out = without_place(); left_out > 0) {
        all.push_back(std::to_string(left_out) + " of " + std::to_string(bodies_.size()) +
                      " bodies are left out, because the world takes " + std::to_string(by_handle_.size()) +
                      ": raise its 'max_bodies'");
    }
    for (const auto& mirror : bodies_) {
        const SceneBody* body = mirror->body();
        if (mirror->twin().found_no_place()) {
            continue;
        }
        for (const std::string& problem : mirror->problems()) {
            all.push_back((body != nullptr ? body->name() : "a body") + ": " + problem);
        }
    }
    for (const auto& [body, problem] : fallen_through()) {
        all.push_back(body->name() + ": " + problem);
    }
    for (const auto& mirror : joints_) {
        if (const SceneJoint* joint = mirror->joint(); joint != nullptr && !mirror->problem().empty()) {
            all.push_back(joint->name() + ": " + mirror->problem());
        }
    }
    return all;
}

void BodyMirrors::release(Session& session) {
    for (const auto& mirror : bodies_) {
        mirror->release(session);
    }
}

}  // namespace tactus
