#include "world/body_twin.hpp"

#include <utility>

#include "core/math/body_motion.hpp"
#include "core/soft/soft_model.hpp"
#include "world/same_shapes.hpp"

namespace tactus {

namespace {

// Building a tree over so many takes about a millisecond.
constexpr std::size_t max_triangles_at_once = 2000;

BodyMotion motion_of(const BodyPlace& place) {
    return {place.pose, place.linear_velocity, place.angular_velocity};
}

// Unlike any that another body has had: handles are given again.
std::uint64_t next_revision() {
    static std::uint64_t last = 0;
    return ++last;
}

bool is_other_form_of_same(const BodyAddition& now, const BodyAddition& before) {
    return now.soft && before.soft ? same_structure(*now.soft, *before.soft)
                                   : !now.soft && !before.soft && is_deformation(*before.touch, *now.touch);
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
    take_out(session);
    if (!job->built.buildable) {
        return false;
    }
    AddResult added = session.add_body(std::move(job->built.body));
    handle_ = added.handle;
    found_no_place_ = added.is_full;
    if (handle_ == no_handle) {
        problems_.push_back(std::move(added.error));
        return false;
    }
    shown_from_ = takes_effect;
    pending_.clear();
    asked_ = 0;
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
        write_place(session, now.pose, Session::all_of_pose, false);
    }
    if (now.linear_velocity != place_.linear_velocity || now.angular_velocity != place_.angular_velocity) {
        write_velocity(session, now.linear_velocity, now.angular_velocity, Session::all_of_velocity);
    }
}

// Where only corners of its meshes have moved, or a soft body is of another material, the twin stays and
// takes the new form: proxies that touch it are taken along.
bool BodyTwin::deform(Session& session, Job& job) {
    const BodyAddition& now = job.built.addition;
    if (handle_ == no_handle || !job.built.buildable || !job.built.body.error.empty() ||
        !(job.plan.makings == made_of_) || !is_other_form_of_same(now, addition_)) {
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

void BodyTwin::move_to(Session& session, const Pose& pose, double seconds) {
    place_.pose = pose;
    if (seconds > 0.0) {
        session.move_body(handle_, pose, seconds);
    } else if (session.teleport_body(handle_, pose)) {
        ++asked_;
    }
}

void BodyTwin::pend(Pending::What what, const BodyPlace& place, std::uint32_t axes) {
    pending_.push_back({++asked_, what, place, axes});
}

void BodyTwin::write_place(Session& session, const Pose& pose, std::uint32_t axes, bool is_relative) {
    const Pose now = written(place_.pose, pose, axes);
    const Vec3 by = now.position - place_.pose.position;
    const bool turns = (axes >> 3 & 1u) != 0;
    const Quat turn = turns ? glm::normalize(now.rotation * glm::conjugate(place_.pose.rotation))
                            : Quat(1.0, 0.0, 0.0, 0.0);
    if (is_relative && session.shift_body(handle_, by, turn)) {
        pend(Pending::What::shift, {.pose = {by, turn}}, axes);
        place_.pose = now;
    } else if (!is_relative && session.teleport_body(handle_, pose, axes)) {
        pend(Pending::What::place, {.pose = pose}, axes);
        place_.pose = now;
    }
}

void BodyTwin::write_velocity(Session& session, const Vec3& linear, const Vec3& angular, std::uint32_t axes) {
    session.set_body_velocity(handle_, linear, angular, axes);
    pend(Pending::What::velocity, {{}, linear, angular}, axes);
    const BodyMotion now = with_velocity(motion_of(place_), {{}, linear, angular}, axes);
    place_ = {now.pose, now.linear_velocity, now.angular_velocity};
}

bool BodyTwin::has_news(const BodyState& state, std::uint64_t tick) const {
    return state.changed_at != shown_change_ && values_.motion == Motion::Dynamic && tick >= shown_from_;
}

const BodyPlace& BodyTwin::take(const BodyState& state) {
    shown_change_ = state.changed_at;
    std::erase_if(pending_, [&](const Pending& one) { return one.number <= state.asked; });
    BodyMotion now{state.pose, state.linear_velocity, state.angular_velocity};
    for (const Pending& one : pending_) {
        const BodyPlace& place = one.place;
        switch (one.what) {
            case Pending::What::place:
                now.pose = written(now.pose, place.pose, one.axes);
                break;
            case Pending::What::shift:
                now.pose = shifted(now.pose, place.pose.position, place.pose.rotation);
                break;
            case Pending::What::velocity:
                now = with_velocity(now, motion_of(place), one.axes);
                break;
        }
    }
    place_ = {now.pose, now.linear_velocity, now.angular_velocity};
    return place_;
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
