#include "world/body_mirror.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
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
    const bool is_first = !std::exchange(tried_, true);
    place_problem_.clear();
    was_nowhere_ = !problem_of_place(body_->frame()).empty();
    key_ = body_->shape_key();
    seen_ = key_.scaling;
    mesh_changes_ = context.mesh_changes;
    body_->listen();
    const BodyValues now = values(context);
    body_->tell_of_moves(!is_far() && !moves_);
    if (handle() == no_handle) {
        remember();
    }
    BodyForm form = body_->form(key_.scaling);
    if ((form.touchable || is_first) && !context.engine_moves) {
        body_->hold_still(form.touchable);
    }
    BodyPlan plan{std::move(form), now, body_->makings(key_.scaling), remembered(), body_->can_be_thrown()};
    const bool is_new = handle() == no_handle;
    if (twin_.plan(std::move(plan), context.workers) && !(is_new && context.together)) {
        hand_over(context);
    }
}

void BodyMirror::hand_over(const MirrorContext& context) {
    if (body_->is_there() && twin_.take_ready(context.session, context.takes_effect)) {
        if (!context.engine_moves) {
            body_->hold_still(true);
        }
        is_near_ = false;
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
        const bool was_paused = twin_.values().is_paused;
        twin_.set_values(context.session, values(context));
        if (context.engine_moves) {
            if (is_near_ && !is_moved_by_engine_) {
                come_near(context.session, context.seconds, false);
            }
            go_along(frame, context);
            say_problems();
            return;
        }
        body_->hold_still(true);
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
    if (handle() != no_handle && body_->is_there() && context.engine_moves) {
        go_along(body_->frame(), context);
        body_->say(place_problem_);
    } else if (handle() != no_handle && body_->is_there()) {
        send(body_->frame(), context.session, context.ticks ? context.seconds : 0.0);
        body_->say(place_problem_);
    }
}

void BodyMirror::follow_speed(const MirrorContext& context) {
    if (handle() != no_handle && body_->is_there() && !context.engine_moves) {
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

// --- where the engine's own physics moves it

// Close to a hand it is kinematic, and goes exactly where the engine has it; far from all it is not there.
BodyValues BodyMirror::values(const MirrorContext& context) {
    BodyValues values = body_->values(context.defaults);
    layers_ = values.layers;
    may_be_far_ = context.engine_moves && values.motion != Motion::Static;
    if (is_far()) {
        values.layers = {0, 0};
    }
    is_moved_by_engine_ = context.engine_moves && values.motion == Motion::Dynamic;
    if (is_moved_by_engine_ && !is_near_) {
        values.motion = Motion::Kinematic;
    }
    return values;
}

void BodyMirror::go_along(const SceneFrame& frame, const MirrorContext& context) {
    if (twin_.values().motion != Motion::Dynamic) {
        send_place(frame, context.session, context.ticks ? context.seconds : 0.0, false);
        return;
    }
    frame_ = frame;
    place_problem_ = problem_of_place(frame);
    if (place_problem_.empty()) {
        twin_.goes_to(pose_of(frame));
    }
}

// It is put there: how it came there is nothing that a hand could have felt. What else there is of it is read
// when it is synchronised next.
void BodyMirror::come_close(Session& session) {
    constexpr int frames_close = 30;
    const bool was_far = is_far();
    frames_close_ = frames_close;
    if (was_far && body_->is_in_scene()) {
        body_->tell_of_moves(true);
        if (handle() != no_handle) {
            send_place(body_->frame(), session, 0.0, false);
        }
    }
}

bool BodyMirror::stays_close(const PhysicsFrame& frame) {
    frames_close_ = std::max(0, frames_close_ - 1);
    if (!is_far()) {
        return frames_close_ > 0;
    }
    exchange(frame, false);
    if (body_->is_there()) {
        body_->tell_of_moves(false);
        BodyValues values = twin_.values();
        values.layers = {0, 0};
        twin_.set_values(frame.session, values);
    }
    return false;
}

Pose BodyMirror::pose() const {
    return is_far() && body_->is_there() ? pose_of(body_->frame()) : twin_.pose();
}

bool BodyMirror::exchange(const PhysicsFrame& frame, bool may_be_led) {
    if (handle() == no_handle || !body_->is_in_scene()) {
        return false;
    }
    if (is_near_) {
        exchange_led(frame);
    }
    // Far enough that a hand of 5 m/s does not arrive within a frame; what leaves does not come and go.
    constexpr double near = 0.2, far = 0.4;  // of its surface (unit: meters)
    const double within = twin_.reach() + (is_near_ ? far : near);
    const CollisionLayers& in_session = twin_.values().layers;
    const bool is_looked_at =  // since it came close
        in_session.layer == layers_.layer && in_session.mask == layers_.mask;
    // In slow motion a body would answer a push as a much heavier one: hands then feel it and push it not.
    const bool is_near = may_be_led && frame.keeps_time && is_looked_at && is_moved_by_engine_ &&
                         place_problem_.empty() && std::ranges::any_of(frame.hands, [&](const Vec3& hand) {
                             return glm::distance(hand, twin_.pose().position) < within;
                         });
    if (is_near != is_near_) {
        come_near(frame.session, frame.seconds, is_near);
    }
    return is_near_;
}

void BodyMirror::exchange_led(const PhysicsFrame& frame) {
    const SessionSnapshot& snapshot = frame.session.snapshot();
    const LedState* const model = state_of(snapshot.led, snapshot.led_count, handle());
    if (model == nullptr) {
        return;  // it is on its way to the loop
    }
    const BodyMotion truth = body_->true_motion();
    const LedMotion::Frame step = led_.frame(truth, *model, frame.seconds, frame.tick);
    if (step.corrects) {
        frame.session.correct_body(handle(), step.correction);
    }
    if (step.impulse != Vec3(0.0) || step.turn != Vec3(0.0)) {
        body_->push(step.impulse, step.turn);
    }
}

void BodyMirror::come_near(Session& session, double seconds, bool is_near) {
    is_near_ = is_near;
    BodyValues values = twin_.values();
    if (is_moved_by_engine_) {
        values.motion = is_near ? Motion::Dynamic : Motion::Kinematic;
    }
    twin_.set_values(session, values);
    if (is_near) {
        const BodyMotion truth = body_->true_motion();
        session.set_body_velocity(handle(), truth.linear_velocity, truth.angular_velocity);
        led_ = {};
    } else if (values.motion != Motion::Dynamic) {
        twin_.move_to(session, pose_of(frame_), seconds);
    }
    session.lead_body(handle(), is_near);
}

void BodyMirror::release(Session& session) {
    twin_.remove(session);
    tried_ = false;
    moves_ = false;
    body_->let_go();
}

}  // namespace tactus
