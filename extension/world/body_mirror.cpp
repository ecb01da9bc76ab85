#include "world/body_mirror.hpp"

#include <cmath>
#include <utility>

namespace tactus {

namespace {

// Those of `now` that are others: see Session::teleport_body() and set_body_velocity(). One that is no number
// is none.
std::uint32_t written_axes(const SceneFrame& before, const SceneFrame& now) {
    std::uint32_t axes = before.axes == now.axes ? 0u : 1u << 3;
    for (int i = 0; i < 3; ++i) {
        axes |= before.origin[i] == now.origin[i] ? 0u : 1u << i;
    }
    return axes;
}

std::uint32_t written_axes(const SceneSpeed& before, const SceneSpeed& now) {
    std::uint32_t axes = 0;
    for (int i = 0; i < 3; ++i) {
        axes |= before.linear[i] == now.linear[i] ? 0u : 1u << i;
        axes |= before.angular[i] == now.angular[i] ? 0u : 1u << (i + 3);
    }
    return axes;
}

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
    seen_ = key_.scaling;
    mesh_changes_ = context.mesh_changes;
    body_->listen();
    if (handle() == no_handle) {
        remember();
    }
    BodyForm form = body_->form(key_.scaling);
    if (form.touchable) {
        body_->hold_still();
    }
    BodyPlan plan{std::move(form), body_->values(context.defaults), body_->makings(key_.scaling),
                  remembered(), body_->can_be_thrown()};
    const bool is_new = handle() == no_handle;
    if (twin_.plan(std::move(plan), context.workers) && !(is_new && context.together)) {
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
    if (body_->is_there() && !twin_.found_no_place()) {  // that is said once, for all of them
        for (const std::string& problem : problems()) {
            body_->say(problem);
        }
    }
}

bool BodyMirror::needs_a_new_twin(const SceneFrame& frame, bool shapes_changed, std::uint64_t mesh_changes) {
    const bool is_back = was_nowhere_ && problem_of_place(frame).empty();
    if (!tried_ || is_back) {
        return true;
    }
    const ShapeKey now = body_->shape_key();
    const bool is_same = now.shapes == key_.shapes && now.is_out == key_.is_out &&
                         has_only_drifted(key_.scaling, seen_, now.scaling);
    seen_ = now.scaling;
    if (!is_same || !(body_->makings(key_.scaling) == twin_.planned().makings)) {
        return true;
    }
    if (std::exchange(mesh_changes_, mesh_changes) == mesh_changes && !shapes_changed) {
        return false;
    }
    return !same_form(body_->form(key_.scaling), twin_.planned().form);
}

std::vector<std::string> BodyMirror::problems() const {
    std::vector<std::string> all = twin_.problems();
    if (!place_problem_.empty()) {
        all.push_back(place_problem_);
    }
    return all;
}

void BodyMirror::send_place(const SceneFrame& frame, Session& session, double seconds, bool is_thrown) {
    if (frame == frame_) {
        place_problem_.clear();
        return;
    }
    place_problem_ = problem_of_place(frame);
    if (!place_problem_.empty()) {
        return;
    }
    const SceneFrame before = std::exchange(frame_, frame);
    if (twin_.values().motion == Motion::Dynamic) {
        twin_.write_place(session, pose_of(frame), written_axes(before, frame), !is_thrown);
    } else {
        twin_.move_to(session, pose_of(frame), seconds);
    }
}

// One that is no number is none, and is written over.
bool BodyMirror::has_other_speed(const SceneSpeed& speed) const {
    return !(speed == speed_) && is_finite(speed);
}

void BodyMirror::send(const SceneFrame& frame, Session& session, double seconds) {
    const bool is_dynamic = can_be_thrown() && twin_.values().motion == Motion::Dynamic;
    const SceneSpeed speed = is_dynamic ? body_->speed() : speed_;
    const bool is_thrown = is_dynamic && has_other_speed(speed);
    send_place(frame, session, seconds, is_thrown);
    if (is_thrown) {
        const SceneSpeed before = std::exchange(speed_, speed);
        shown_ = speed;
        twin_.write_velocity(session, speed.linear, speed.angular, written_axes(before, speed));
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
        const bool was_paused = twin_.values().is_paused;
        twin_.set_values(context.session, body_->values(context.defaults));
        if (was_paused && !twin_.values().is_paused && can_be_thrown() && is_finite(speed_)) {
            twin_.write_velocity(context.session, speed_.linear, speed_.angular, Session::all_of_velocity);
        }
        send(frame, context.session, context.ticks ? context.seconds : 0.0);
        if (twin_.values().motion != Motion::Dynamic) {
            come_to_rest();
        }
    }
    say_problems();
}

void BodyMirror::follow(const MirrorContext& context) {
    if (handle() != no_handle && body_->is_there()) {
        send(body_->frame(), context.session, context.ticks ? context.seconds : 0.0);
        body_->say(place_problem_);
    }
}

void BodyMirror::follow_speed(const MirrorContext& context) {
    if (handle() != no_handle && body_->is_there()) {
        send(body_->frame(), context.session, context.ticks ? context.seconds : 0.0);
    }
}

// What moves is asked here whether a script has moved it: to be told of its place as well would cost as much
// again.
bool BodyMirror::apply(const BodyState& state, std::uint64_t tick, Session& session) {
    if (!can_be_thrown() || !place_problem_.empty() || !body_->is_in_scene()) {
        return false;
    }
    const SceneSpeed now = body_->speed();
    const SceneFrame frame = body_->frame();
    if (has_other_speed(now) || !(frame == frame_)) {
        send(frame, session, 0.0);
        body_->say(place_problem_);
    }
    if (!place_problem_.empty() || !twin_.has_news(state, tick)) {
        return false;
    }
    if (!std::exchange(moves_, true)) {
        body_->tell_of_moves(false);
    }
    const BodyPlace& place = twin_.take(state);
    if (const SceneSpeed speed{place.linear_velocity, place.angular_velocity};
        !(speed == shown_) || !(now == speed_)) {
        shown_ = speed;
        speed_ = body_->set_speed(speed);
    }
    frame_ = body_->stand_at(place.pose, key_.scaling);
    return true;
}

BodyMirror::Staying BodyMirror::hold_on() const {
    if (handle() == no_handle || twin_.values().motion != Motion::Dynamic || !body_->is_in_scene()) {
        return {};
    }
    return {body_->frame(), true};
}

// What a script has written meanwhile stays written.
void BodyMirror::stay(const Staying& staying) {
    if (staying.stays && body_->is_in_scene()) {
        const SceneFrame now = body_->put_back(staying.frame);
        frame_ = staying.frame == frame_ ? now : frame_;
    }
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
