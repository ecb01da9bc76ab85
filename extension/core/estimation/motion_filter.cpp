#include "core/estimation/motion_filter.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "core/math/body_motion.hpp"
#include "core/math/shortened.hpp"

namespace tactus {

namespace {

// The mean of the last ones is taken over about so many.
constexpr double leaning_share = 1.0 / 30.0;
// That mean is asked seldom, beside single poses: less is allowed (share of the square).
constexpr double leaning_most = 0.6;

// Poses in succession err alike: a mean of any number is no surer than that of so many (share of a pose's
// covariance).
constexpr double surest_mean = 1.0 / 3000.0;

// Of place and turn: no camera tells better (unit: meters, radians).
constexpr double least_place = 2e-5;
constexpr double least_turn = 2e-4;

double square(const Vec3& v) {
    return glm::dot(v, v);
}

// A block of the diagonal as it is used: never singular; where it is no covariance at all, that of eyes that
// see well.
Mat3 block(const Matrix6& covariance, std::size_t first, double least) {
    Mat3 of(least * least);
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
            of[static_cast<int>(i)][static_cast<int>(j)] += covariance[first + i][first + j];
        }
    }
    const bool sound =
        std::isfinite(square(of[0]) + square(of[1]) + square(of[2])) && glm::determinant(of) > 0.0;
    return sound ? of : Mat3(least * least);
}

// How unlikely a deviation is: 3 on average by chance alone.
double deviation(const Vec3& of, const Mat3& covariance) {
    return glm::dot(of, glm::inverse(covariance) * of);
}

Vec3 turn_between(const Quat& from, const Quat& to) {
    return turn_vector(to * glm::conjugate(from));
}

Pose moved(const Pose& pose, const Vec3& way, const Vec3& turn) {
    return carried_on(pose, way, turn, 1.0);
}

bool is_finite(const Pose& pose) {
    const Quat& q = pose.rotation;
    return std::isfinite(square(pose.position)) && std::abs(glm::dot(q, q) - 1.0) < 1e-3;
}

}  // namespace

void SeenVector::begin(const Mat3& covariance, double push) {
    *this = {};
    pp_ = covariance;
    // How fast it may be is not known: as fast as chance makes it in a second.
    vv_ = Mat3(push);
    begin_rest(covariance);
}

void SeenVector::begin_rest(const Mat3& covariance) {
    poses_ = 1;
    mean_ = covariance;
    leaning_ = Vec3(0.0);
}

void SeenVector::pass(double seconds, double push) {
    const double t = seconds;
    pp_ += t * (pv_ + glm::transpose(pv_)) + t * t * vv_ + Mat3(push * t * t * t / 3.0);
    pv_ += t * vv_ + Mat3(push * t * t / 2.0);
    vv_ += Mat3(push * t);
}

// Kalman's update with all of the place seen: gains Ppp inverse(S) and transpose(Ppv) inverse(S), S = Ppp +
// R.
SeenVector::Change SeenVector::see(const Innovation& innovation, const MotionFilterSettings& settings) {
    const Mat3& r = innovation.covariance;
    if (!(deviation(innovation.moving, pp_ + r) < 3.0 * settings.elsewhere * settings.elsewhere)) {
        Change begins_anew;
        begins_anew.elsewhere = true;
        return begins_anew;
    }
    const Mat3 sum = glm::inverse(pp_ + r);
    const Mat3 of_place = pp_ * sum, of_velocity = glm::transpose(pv_) * sum;
    velocity_ += of_velocity * innovation.moving;
    vv_ -= of_velocity * pv_;
    pv_ -= of_place * pv_;
    pp_ -= of_place * pp_;
    // Rounding would part what is symmetric, and grow.
    pp_ = 0.5 * (pp_ + glm::transpose(pp_));
    vv_ = 0.5 * (vv_ + glm::transpose(vv_));
    Change change{of_place * innovation.moving, Vec3(0.0), false};

    leaning_ += leaning_share * (innovation.resting - leaning_);
    // Of three axes; a mean over the share s of a sequence has s / 2 of its covariance.
    const double most = 3.0 * settings.contradicted * settings.contradicted;
    if (deviation(innovation.resting, r + mean_) > most ||
        deviation(leaning_, 0.5 * leaning_share * r + mean_) > leaning_most * most) {
        change.rest_contradicted = true;
        return change;
    }
    ++poses_;
    const Mat3 of_mean = mean_ * glm::inverse(mean_ + r);
    mean_ = mean_ - of_mean * mean_ + (surest_mean * surest_mean) * r;
    mean_ = 0.5 * (mean_ + glm::transpose(mean_));
    change.resting = of_mean * innovation.resting;
    return change;
}

void MotionFilter::begin(const MotionFilterSettings& settings, const Pose& pose, const Mat3& place,
                         const Mat3& turn) {
    known_ = true;
    rests_ = false;
    moving_ = mean_ = told_ = pose;
    place_.begin(place, settings.push);
    turn_.begin(turn, settings.twist);
}

void MotionFilter::see(const MotionFilterSettings& settings, const Pose& pose, const Matrix6& covariance,
                       Nanoseconds time) {
    if (!is_finite(pose) || (known_ && time <= time_)) {
        return;
    }
    const Mat3 place = block(covariance, 0, least_place);
    const Mat3 turn = block(covariance, 3, least_turn);
    const double seconds = to_seconds(time - time_);
    time_ = time;
    if (!known_ || seconds > settings.longest_gap) {
        begin(settings, pose, place, turn);
        return;
    }
    moving_ = moved(moving_, seconds * place_.velocity(), seconds * turn_.velocity());
    place_.pass(seconds, settings.push);
    turn_.pass(seconds, settings.twist);
    const SeenVector::Change of_place =
        place_.see({pose.position - moving_.position, pose.position - mean_.position, place}, settings);
    const SeenVector::Change of_turn = turn_.see(
        {turn_between(moving_.rotation, pose.rotation), turn_between(mean_.rotation, pose.rotation), turn},
        settings);
    if (of_place.elsewhere || of_turn.elsewhere) {
        begin(settings, pose, place, turn);
        return;
    }
    moving_ = moved(moving_, of_place.moving, of_turn.moving);
    if (of_place.rest_contradicted || of_turn.rest_contradicted) {
        // What turns also moves, or soon will.
        place_.begin_rest(place);
        turn_.begin_rest(turn);
        mean_ = pose;
    } else {
        mean_ = moved(mean_, of_place.resting, of_turn.resting);
    }
    tell(settings, seconds);
}

void MotionFilter::tell(const MotionFilterSettings& settings, double seconds) {
    const bool rested = rests_;
    rests_ = std::min(place_.poses(), turn_.poses()) >= settings.poses_at_rest;
    if (!rests_) {
        told_ = moving_;
    } else if (!rested) {
        told_ = mean_;
    } else {
        const bool settled = std::min(place_.poses(), turn_.poses()) >= settings.poses_to_settle;
        const double way = seconds * (settled ? settings.creep : settings.settling);
        const double turn = seconds * (settled ? settings.creep_turn : settings.settling_turn);
        told_ = moved(told_, shortened(mean_.position - told_.position, way),
                      shortened(turn_between(told_.rotation, mean_.rotation), turn));
    }
}

Pose MotionFilter::at(const MotionFilterSettings& settings, Nanoseconds time) const {
    const double seconds = std::clamp(to_seconds(time - time_), 0.0, settings.longest_gap);
    return moved(told_, seconds * linear_velocity(), seconds * angular_velocity());
}

}  // namespace tactus
