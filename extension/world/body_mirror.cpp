#include "world/body_mirror.hpp"

#include <cmath>
#include <utility>

namespace tactus {

namespace {

bool is_finite(const SceneSpeed& speed) {
    const Vec3 both = speed.linear + speed.angular;
    return std::isfinite(both.x + both.y + both.z);
}

}  // namespace

void BodyMirror::remember() {
    frame_ = body_->frame();
    speed_ = shown_ = body_->speed();
}

BodyPlace BodyMirror::remembered() const {
    return {pose_of(frame_), speed_.linear, speed_.angular};
}

// Reads the body as it is and has a twin of it built: at once where that takes no time. What the workers
// build is handed over where everybody's is, or the order of bodies, which physics computes in, would depend
// on how fast they are.
void BodyMirror::plan(const MirrorContext& context) {
    tried_ = true;
    place_problem_.clear();
    was_nowhere_ = !problem_of_place(body_->frame()).empty();
    key_ = body_->shape_key();
    mesh_changes_ = context.mesh_changes;
    body_->listen();
    if (handle() == no_handle) {
        remember();
    }
    BodyForm form = body_->form();
    if (form.touchable) {
        body_->hold_still();
    }
    BodyPlan plan{std::move(form), body_->values(context.defaults), body_->makings(), remembered(),
                  body_->can_be_thrown()};
    if (twin_.plan(std::move(plan), context.workers)) {
        hand_over(context);
    }
}

void BodyMirror::hand_over(const MirrorContext& context) {
    if (body_->is_there() && twin_.take_ready(context.session, context.takes_effect)) {
        body_->hold_still();
        remember();
        twin_.stand_at(context.session, remembered());
    }
}

void BodyMirror::take_ready(const MirrorContext& context) {
    hand_over(context);
    say_problems();
}

void BodyMirror::say_problems() const {
    if (body_->is_there()) {
        for (const std::string& problem : problems()) {
            body_->say(problem);
        }
    }
}

bool BodyMirror::needs_a_new_twin(const SceneFrame& frame, bool shapes_changed, std::uint64_t mesh_changes) {
    const bool is_back = was_nowhere_ && problem_of_place(frame).empty();
    if (!tried_ || is_back || !(body_->makings() == twin_.planned().makings) ||
        !(body_->shape_key() == key_)) {
        return true;
    }
    if (std::exchange(mesh_changes_, mesh_changes) == mesh_changes && !shapes_changed) {
        return false;
    }
    return !same_form(body_->form(), twin_.planned().form);
}

std::vector<std::string> BodyMirror::problems() const {
    std::vector<std::string> all = twin_.problems();
    if (!place_problem_.empty()) {
        all.push_back(place_problem_);
    }
    return all;
}

void BodyMirror::send_place(const SceneFrame& frame, const MirrorContext& context) {
    if (frame == frame_) {
        place_problem_.clear();
        return;
    }
    place_problem_ = problem_of_place(frame);
    if (place_problem_.empty()) {
        frame_ = frame;
        twin_.set_pose(context.session, pose_of(frame_), context.seconds, context.takes_effect);
    }
}

// One that is no number is none, and is written over.
bool BodyMirror::has_other_speed(const SceneSpeed& speed) const {
    return !(speed == speed_) && is_finite(speed);
}

void BodyMirror::send_speed(const MirrorContext& context) {
    if (!can_be_thrown() || twin_.values().motion != Motion::Dynamic) {
        return;
    }
    if (const SceneSpeed speed = body_->speed(); has_other_speed(speed)) {
        speed_ = shown_ = speed;
        twin_.set_velocity(context.session, speed.linear, speed.angular, context.takes_effect);
    }
}

void BodyMirror::synchronise(const MirrorContext& context, bool shapes_changed) {
    if (!body_->is_there()) {
        return;
    }
    const SceneFrame frame = body_->frame();
    if (needs_a_new_twin(frame, shapes_changed, context.mesh_changes)) {
        plan(context);
    }
    if (handle() != no_handle) {
        body_->hold_still();
        twin_.set_values(context.session, body_->values(context.defaults));
        send_place(frame, context);
        send_speed(context);
        if (twin_.values().motion != Motion::Dynamic) {
            come_to_rest();
        }
    }
    say_problems();
}

void BodyMirror::follow(const MirrorContext& context) {
    if (handle() != no_handle && body_->is_there()) {
        send_place(body_->frame(), context);
        send_speed(context);
        body_->say(place_problem_);
    }
}

void BodyMirror::follow_speed(const MirrorContext& context) {
    if (handle() != no_handle && body_->is_there()) {
        send_speed(context);
    }
}

// What moves is asked here whether a script has moved it: to be told of its place as well would cost as much
// again.
BodyMirror::Applied BodyMirror::apply(const BodyState& state, std::uint64_t tick) {
    if (!can_be_thrown() || !place_problem_.empty() || !body_->is_in_scene()) {
        return Applied::no;
    }
    const SceneSpeed now = body_->speed();
    if (has_other_speed(now) || !(body_->frame() == frame_)) {
        return Applied::elsewhere;
    }
    if (!twin_.takes(state, tick)) {
        return Applied::no;
    }
    if (!std::exchange(moves_, true)) {
        body_->tell_of_moves(false);
    }
    if (const SceneSpeed speed{state.linear_velocity, state.angular_velocity};
        !(speed == shown_) || !(now == speed_)) {
        shown_ = speed;
        speed_ = body_->set_speed(speed);
    }
    frame_ = body_->stand_at(state.pose, key_.scaling);
    return Applied::yes;
}

bool BodyMirror::is_elsewhere() const {
    return has_other_speed(body_->speed()) || !(body_->frame() == frame_);
}

bool BodyMirror::come_to_rest() {
    if (!std::exchange(moves_, false)) {
        return false;
    }
    body_->tell_of_moves(true);
    return body_->is_in_scene() && is_elsewhere();
}

void BodyMirror::release(Session& session) {
    twin_.remove(session);
    tried_ = false;
    moves_ = false;
    body_->let_go();
}

}  // namespace tactus
