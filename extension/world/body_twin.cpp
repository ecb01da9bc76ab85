#include "world/body_twin.hpp"

#include <utility>

#include "world/same_shapes.hpp"

namespace tactus {

namespace {

// Building a tree over so many takes about a millisecond.
constexpr std::size_t max_triangles_at_once = 2000;

// Unlike any that another body has had: handles are given again.
std::uint64_t next_revision() {
    static std::uint64_t last = 0;
    return ++last;
}

}  // namespace

bool BodyTwin::plan(BodyPlan plan, Workers& workers) {
    plan_ = std::move(plan);
    narrowed_.forget_body();
    if (handle_ == no_handle) {
        place_ = plan_.place;
    }
    workers_ = &workers;
    const bool is_small = triangle_count(plan_.form) <= max_triangles_at_once;
    is_waiting_ = !is_small && job_ != nullptr;
    if (is_small) {
        job_ = std::make_shared<Job>();
        job_->plan = plan_;
        job_->built = build_body(job_->plan, run_serially);
        job_->done = true;
    } else if (!is_waiting_) {
        begin();
    }
    return is_small;
}

void BodyTwin::begin() {
    is_waiting_ = false;
    job_ = std::make_shared<Job>();
    job_->plan = plan_;
    workers_->add([job = job_, run = workers_->runner()] {
        // Nobody else holds it: nobody waits for it any more.
        if (job.use_count() > 1) {
            job->built = build_body(job->plan, run);
        }
        job->done.store(true, std::memory_order_release);
    });
}

bool BodyTwin::take_ready(Session& session, std::uint64_t takes_effect) {
    if (job_ == nullptr || !job_->done.load(std::memory_order_acquire)) {
        return false;
    }
    const std::shared_ptr<Job> job = std::move(job_);
    job_.reset();
    if (is_waiting_) {
        begin();
    }
    problems_ = std::move(job->built.problems);
    if (deform(session, *job)) {
        return false;
    }
    const SessionHandle former = handle_;
    const bool goes_on = job->built.buildable && job->built.body.soft != nullptr && former != no_handle;
    AddResult added;
    if (goes_on) {
        added = session.add_body(std::move(job->built.body), {former});
    }
    take_out(session);
    if (!job->built.buildable) {
        return false;
    }
    // Where there was no room for both.
    if (added.handle == no_handle) {
        added = session.add_body(std::move(job->built.body));
    }
    handle_ = added.handle;
    if (handle_ == no_handle) {
        problems_.push_back(std::move(added.error));
        return false;
    }
    shown_from_ = takes_effect;
    values_ = job->plan.values;
    place_ = job->plan.place;
    addition_ = std::move(job->built.addition);
    made_of_ = job->plan.makings;
    revision_ = next_revision();
    can_be_narrowed_ =
        job->plan.form.soft == nullptr && triangle_count(job->plan.form) > max_triangles_at_once;
    if (!can_be_narrowed_) {
        narrowed_ = {};
    }
    send_rest(session, handle_, values_);
    return true;
}

void BodyTwin::stand_at(Session& session, const BodyPlace& now) {
    if (!same_pose(now.pose, place_.pose)) {
        session.teleport_body(handle_, now.pose);
    }
    if (now.linear_velocity != place_.linear_velocity || now.angular_velocity != place_.angular_velocity) {
        session.set_body_velocity(handle_, now.linear_velocity, now.angular_velocity);
    }
    place_ = now;
}

// Where only corners of its meshes have moved, the twin stays and takes the new form: whoever touches it is
// taken along.
bool BodyTwin::deform(Session& session, Job& job) {
    const BodyAddition& now = job.built.addition;
    if (handle_ == no_handle || !job.built.buildable || !job.built.body.error.empty() ||
        !(job.plan.makings == made_of_) || !is_deformation(*addition_.touch, *now.touch)) {
        return false;
    }
    session.deform_body(handle_, std::move(job.built.body));
    can_be_narrowed_ = false;
    narrowed_ = {};
    addition_ = std::move(job.built.addition);
    revision_ = next_revision();
    return true;
}

void BodyTwin::take_out(Session& session) {
    if (handle_ != no_handle) {
        session.remove_body(handle_);
        handle_ = no_handle;
        shown_change_ = 0;
        can_be_narrowed_ = false;
        narrowed_.forget_body();
    }
}

void BodyTwin::remove(Session& session) {
    take_out(session);
    job_.reset();
    is_waiting_ = false;
    narrowed_ = {};
}

void BodyTwin::narrow(double radius, NarrowedTrees& trees) {
    const bool is_smaller = narrowed_.radius() == 0.0 || radius < narrowed_.radius();
    if (can_be_narrowed_ && job_ == nullptr && !is_narrowing() && radius > 0.0 && is_smaller) {
        narrowed_.begin(*addition_.touch, radius, trees, *workers_);
    }
}

void BodyTwin::take_narrowed(Session& session) {
    if (!narrowed_.is_ready()) {
        return;
    }
    if (auto narrower = narrowed_.take(*addition_.touch)) {
        session.narrow_touch(handle_, narrower, narrowed_.radius());
        addition_.touch = std::move(narrower);
    }
}

void BodyTwin::set_values(Session& session, const BodyValues& values) {
    const BodyValues before = std::exchange(values_, values);
    if (send_changes(session, handle_, before, values_)) {
        revision_ = next_revision();
    }
}

void BodyTwin::set_pose(Session& session, const Pose& pose, double seconds, std::uint64_t takes_effect) {
    place_.pose = pose;
    if (values_.motion == Motion::Dynamic) {
        session.teleport_body(handle_, pose);
        shown_from_ = takes_effect;
    } else {
        session.move_body(handle_, pose, seconds);
    }
}

void BodyTwin::set_velocity(Session& session, const Vec3& linear, const Vec3& angular,
                            std::uint64_t takes_effect) {
    place_.linear_velocity = linear;
    place_.angular_velocity = angular;
    session.set_body_velocity(handle_, linear, angular);
    shown_from_ = takes_effect;
}

bool BodyTwin::takes(const BodyState& state, std::uint64_t tick) {
    if (state.changed_at == shown_change_ || values_.motion != Motion::Dynamic || tick < shown_from_) {
        return false;
    }
    shown_change_ = state.changed_at;
    place_ = {state.pose, state.linear_velocity, state.angular_velocity};
    return true;
}

BodyAddition BodyTwin::addition() const {
    BodyAddition now = addition_;
    put_into(now, values_);
    now.description.pose = place_.pose;
    now.description.linear_velocity = place_.linear_velocity;
    now.description.angular_velocity = place_.angular_velocity;
    return now;
}

}  // namespace tactus
