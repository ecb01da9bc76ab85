// What the motion of the far side's bodies teaches about their mass and friction, and of what else acts on
// them (residual_motion.hpp).
//
// A body that touches another one that moves teaches nothing by itself: what it gets from there belongs to
// both. Bodies that touch each other are one: what they do to each other leaves their common momentum as it
// is, so that the mean of their motions, weighted by mass, is that of one body that only hands and what
// stands still act on. What it tells holds for each of them that moves along, and makes it as certain as its
// share of the mass.
#include <algorithm>
#include <cmath>

#include "session/operator_side.hpp"

namespace tactus {

namespace {

// Of stiffness, friction or mass: nobody feels less (share of it).
constexpr double little = 0.02;

// Half of what is just noticed of a weight (7 %) in 100 ms (share of it).
constexpr double unnoticed_a_second = 0.35;

// Where there is none, friction grows from here on.
constexpr double least_friction = 0.1;

}  // namespace

void OperatorSide::learn(SessionLoop& loop) {
    const ResidualSettings& residual = settings().residual;
    gather_pupils(loop);
    for (const Pupil& pupil : pupils_) {
        if (pupil.has_lesson) {
            BodyResidual& learnt = residuals_[pupil.place];
            learnt.linear.learn(residual, pupil.residual, residual.largest_error, residual.largest);
            learnt.turn.learn(residual, pupil.residual_turn, residual.largest_turn_error,
                              residual.largest_turn);
        }
    }
    if (!(settings().estimate.gain > 0.0)) {
        return;
    }
    for (std::size_t i = 0; i < pupils_.size(); ++i) {
        if (pupils_[i].group == i) {
            teach(loop, i);
        }
    }
}

void OperatorSide::gather_pupils(SessionLoop& loop) {
    pupils_.clear();
    for (std::uint32_t place = 0; place < truths_.places(); ++place) {
        const SessionHandle body = truths_.body_at(place);
        const SessionLoop::Body* const known = body == no_handle ? nullptr : loop.body(body);
        if (!known || known->motion != Motion::Dynamic || loop.asleep(body)) {
            continue;
        }
        Pupil pupil{body, place, pupils_.size(), loop.mass(body), false, no_sample, no_sample, {}, {}, {}};
        pupil.has_lesson = truths_.of(body).fresh && lesson_for(loop, pupil);
        pupil.from = truths_.of(body).sample_before;
        pupil.to = truths_.of(body).sample;
        pupils_.push_back(pupil);
    }
    for (std::size_t i = 0; i < pupils_.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            if (!loop.touching(pupils_[i].body, pupils_[j].body)) {
                continue;
            }
            alone_since_[pupils_[i].place] = alone_since_[pupils_[j].place] = sample_;
            const auto [first, second] = std::minmax(pupils_[i].group, pupils_[j].group);
            for (Pupil& pupil : pupils_) {
                pupil.group = pupil.group == second ? first : pupil.group;
            }
        }
    }
}

// From one truth of a body to the next, the model's has come from nearly the same state.
bool OperatorSide::lesson_for(SessionLoop& loop, Pupil& pupil) const {
    const Truth& truth = truths_.of(pupil.body);
    const std::uint32_t place = pupil.place;
    MotionLesson& lesson = pupil.lesson;
    const BodyMotion* const start = past_.motion(place, truth.sample_before);
    const BodyMotion* const end = past_.motion(place, truth.sample);
    if (!start || !end || truth.sample <= truth.sample_before ||
        truth.sample - truth.sample_before >= past_.samples()) {
        return false;
    }
    const bool from_truth = resimulator_.goes_on_from(pupil.body) == truth.sample_before;
    lesson.truth_before = truth.before.linear_velocity;
    lesson.truth = truth.motion.linear_velocity;
    lesson.model_before = from_truth ? truth.before.linear_velocity : start->linear_velocity;
    const ModelPast::Given helped = past_.helped(place, truth.sample_before, truth.sample);
    lesson.model = end->linear_velocity - helped.linear;
    lesson.pushed = past_.pushed(place, truth.sample_before, truth.sample);
    lesson.seconds = static_cast<double>(truth.sample - truth.sample_before) * seconds_;
    lesson.fell = loop.gravity() * lesson.seconds;
    pupil.residual = {lesson.truth - lesson.truth_before, lesson.model - lesson.model_before, lesson.seconds};
    const Vec3& turned_before = from_truth ? truth.before.angular_velocity : start->angular_velocity;
    pupil.residual_turn = {truth.motion.angular_velocity - truth.before.angular_velocity,
                           end->angular_velocity - helped.angular - turned_before, lesson.seconds};
    return true;
}

// Nothing where somebody of the group has not been heard of, or where a body alone was in a group within the
// time that its lesson is about.
void OperatorSide::teach(SessionLoop& loop, std::size_t group) {
    MotionLesson common;
    double mass = 0.0;
    std::size_t count = 0;
    for (const Pupil& pupil : pupils_) {
        if (pupil.group != group) {
            continue;
        }
        if (!pupil.has_lesson || pupil.from != pupils_[group].from || pupil.to != pupils_[group].to) {
            return;
        }
        const MotionLesson& own = pupil.lesson;
        ++count;
        mass += pupil.mass;
        common.truth_before += pupil.mass * own.truth_before;
        common.truth += pupil.mass * own.truth;
        common.model_before += pupil.mass * own.model_before;
        common.model += pupil.mass * own.model;
        common.pushed += pupil.mass * own.pushed;
        common.fell = own.fell;
        common.seconds = own.seconds;
    }
    if (!(mass > 0.0) || (count == 1 && pupils_[group].from < alone_since_[pupils_[group].place])) {
        return;
    }
    for (Vec3* const v :
         {&common.truth_before, &common.truth, &common.model_before, &common.model, &common.pushed}) {
        *v /= mass;
    }
    const auto moves_along = [&](const Pupil& pupil) {
        return glm::dot(pupil.lesson.truth, common.truth) >= 0.5 * glm::dot(common.truth, common.truth);
    };
    for (const Pupil& pupil : pupils_) {
        if (pupil.group == group && moves_along(pupil)) {
            ParameterEstimate& estimate = estimates_[pupil.place];
            estimate.learn(settings().estimate, count == 1 ? pupil.lesson : common, pupil.mass / mass);
            set_factors(loop, pupil.body, estimate);
        }
    }
}

void OperatorSide::set_factors(SessionLoop& loop, SessionHandle body, const ParameterEstimate& estimate) {
    const BodyFactors factors{estimate.mass_factor(), estimate.friction_factor()};
    loop.set_factors(body, factors);
    if (SessionLoop* const twin = resimulator_.twin()) {
        twin->set_factors(body, factors);
    }
}

// Once a tick: the present and the past that is replayed have the same.
void OperatorSide::set_residuals(SessionLoop& loop) {
    SessionLoop* const twin = resimulator_.twin();
    loop.clear_residuals();
    if (!twin) {
        return;
    }
    twin->clear_residuals();
    const bool replays = settings().derivation == Derivation::resimulate &&
                         settings().correction != Correction::none && !settings().traditional;
    const ResidualSettings& residual = settings().residual;
    for (std::uint32_t place = 0; place < truths_.places(); ++place) {
        const SessionHandle body = truths_.body_at(place);
        if (body == no_handle || truths_.of(body).sample == no_sample) {
            continue;
        }
        BodyResidual& learnt = residuals_[place];
        learnt.linear.tick(residual, seconds_);
        learnt.turn.tick(residual, seconds_);
        if (!replays) {
            continue;
        }
        const Truth& truth = truths_.of(body);
        const Residual linear =
            learnt.linear.residual(residual, truth.motion.linear_velocity, residual.least);
        const Residual turn =
            learnt.turn.residual(residual, truth.motion.angular_velocity, residual.least_turn);
        loop.set_residual(body, linear, turn);
        twin->set_residual(body, linear, turn);
    }
}

// --- what touch has taught at the far side

void OperatorSide::take_over_found(SessionLoop& loop) {
    std::erase_if(news_, [&](SessionHandle body) {
        const bool is_done = !loop.body(body) || take_over(loop, body, found_[body].estimate);
        found_[body].is_new = !is_done;
        return is_done;
    });
}

// At once where nobody touches it, else so slowly that no change has to be let go of, each tick's hidden like
// any other. True when all is taken over.
bool OperatorSide::take_over(SessionLoop& loop, SessionHandle body, const ObjectEstimate& estimate) {
    const double share = loop.is_touched(body) ? unnoticed_a_second * seconds_ : 1e9;
    bool is_done = true, is_other = false;
    const auto towards = [&](double now, const TouchValue& told, double least) {
        const double left = told.value - now;
        if (!told.known || std::abs(left) <= little * told.value) {
            return now;
        }
        const double most = share * std::max(now, least);
        is_done = is_done && std::abs(left) <= most;
        is_other = true;
        return now + std::clamp(left, -most, most);
    };
    TouchMaterial material = loop.scene().body(loop.body(body)->slot).material;
    material.stiffness = towards(material.stiffness, estimate.stiffness, 0.0);
    material.dynamic_friction = towards(material.dynamic_friction, estimate.friction, least_friction);
    // What holds it still is known to be no less.
    material.static_friction = std::max(material.static_friction, material.dynamic_friction);
    if (is_other) {
        loop.set_touch(body, material);
        if (SessionLoop* const twin = resimulator_.twin(); twin != nullptr && twin->body(body)) {
            twin->set_touch(body, material);
        }
    }
    const std::uint32_t place = truths_.place_of(body);
    const double mass = loop.mass(body);
    if (place != TruthStore::no_place && mass > 0.0) {
        if (const double next = towards(mass, estimate.mass, 0.0); next != mass) {
            ParameterEstimate& learnt = estimates_[place];
            const double described = mass / learnt.mass_factor();
            learnt.take_over_mass(settings().estimate, next / described,
                                  estimate.mass.deviation / estimate.mass.value);
            set_factors(loop, body, learnt);
            is_done = is_done || loop.mass(body) == mass;  // no factor goes farther
        }
    }
    changed_ = changed_ || is_other;
    return is_done;
}

}  // namespace tactus
