#include "core/teleop/pose_filter.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/math/body_motion.hpp"

namespace tactus {

namespace {

// So many states tell how much chance there is, or that there is none. What others have taught counts for as
// many.
constexpr double states_to_tell = 8.0;

// A body jumps once. What jumps so often in succession is chance that has grown.
constexpr int jumps_of_chance = 3;

// What is seen off a belief is averaged over about so many states, to find out that it leans to one side.
constexpr double leaning_share = 1.0 / 30.0;

// The gain that a belief gets which leans: it is right again within some ten states.
constexpr double gain_of_doubt = 0.1;

double square(const Vec3& v) {
    return glm::dot(v, v);
}

double square(double v) {
    return v * v;
}

Quat turn_of(const Vec3& vector) {
    const double angle = glm::length(vector);
    return angle > 0.0 ? glm::angleAxis(angle, vector / angle) : Quat(1.0, 0.0, 0.0, 0.0);
}

// Neither the step nor what it leaves open is more than a deviation that counts as none.
bool is_still(const PoseFilterSettings& settings, const PoseStep& step) {
    return glm::length(step.way) + step.open_way <= settings.place &&
           glm::length(turn_vector(step.turn)) + step.open_turn <= settings.turn;
}

}  // namespace

void Chance::note(const Vec3& e, const Vec3& before, bool before_known, double left_open, double states) {
    ++count;
    const double weight = std::max(1.0 / states, 1.0 / count);
    squares += weight * (square(e) - squares);
    open += weight * (square(left_open) - open);
    lagged += before_known ? weight * (glm::dot(e, before) - lagged) : 0.0;
}

double Chance::variance() const {
    return std::min(std::max(0.0, -lagged) / 3.0, std::max(0.0, squares - open) / 6.0);
}

// Two deviations of the mean are added. A square |e_k|^2 of three axes has a variance of 24 R^2, half as much
// again for those that share an n_k, where its mean is 6 R; a product e_k . e_(k-1) one of 15 R^2.
double Chance::variance_at_most() const {
    const double states = std::max(1.0, count);
    const double by_squares = std::max(0.0, squares - open) / 6.0;
    const double by_lagged =
        std::max(0.0, -lagged) / 3.0 + 2.0 * by_squares * std::sqrt(5.0 / (3.0 * states));
    return std::min(by_squares * (1.0 + 2.0 / std::sqrt(states)), by_lagged);
}

Chance together(const Chance& own, const Chance& others) {
    const double theirs = std::min(others.count, states_to_tell);
    const double count = own.count + theirs;
    const double share = count > 0.0 ? theirs / count : 0.0;
    return {count, std::lerp(own.squares, others.squares, share), std::lerp(own.lagged, others.lagged, share),
            std::lerp(own.open, others.open, share)};
}

void RoughVector::note(const PoseFilterSettings& settings, const Vec3& e, double open, Chance& others) {
    const bool before_known = chance_.count > 0.0;
    chance_.note(e, before_, before_known, open, settings.states);
    others.note(e, before_, before_known, open, settings.states);
    before_ = e;
}

// Until it is known how much chance there is, what has been seen so far counts, on average. A still body has
// time to wait.
Vec3 RoughVector::believed(const PoseFilterSettings& settings, const Chance& chance, bool still) {
    if (chance.count < states_to_tell) {
        return still ? trusting_.off : seeing_.off;
    }
    const double most = square(settings.contradicted) * chance.variance_at_most();
    const double apart = seeing_.gain - trusting_.gain;  // variance of their difference
    if (apart > 0.0 && square(seeing_.off - trusting_.off) > most * apart) {
        trusting_ = seeing_;
        leaning_ = Vec3(0.0);
    }
    if (square(leaning_) > most * 0.5 * leaning_share * (1.0 + trusting_.gain)) {
        trusting_.gain = seeing_.gain = std::max(trusting_.gain, gain_of_doubt);
        leaning_ = Vec3(0.0);
    }
    return trusting_.off;
}

double RoughVector::doubt(double none, const Chance& others) const {
    const Chance chance = together(chance_, others);
    const double variance = chance.variance();
    const double gain = chance.count < states_to_tell ? seeing_.gain : trusting_.gain;
    return variance <= square(none) ? 0.0 : 3.0 * gain * variance;
}

Vec3 RoughVector::begin(const PoseFilterSettings& settings, double none, const Off& off, bool still,
                        const Chance& others) {
    trusting_.off = off.trusting;
    const Chance chance = together(chance_, others);
    return chance.variance() <= square(none) ? Vec3(0.0) : believed(settings, chance, still);
}

Vec3 RoughVector::see(const PoseFilterSettings& settings, double none, const Vec3& e, const Off& off,
                      double open, bool still, Chance& others) {
    const Chance known = together(chance_, others);
    const double usual = 2.0 * known.variance_at_most() + square(open) / 3.0 + square(none);  // of an axis
    const bool jumped = known.count >= states_to_tell && square(e) > square(settings.contradicted) * usual;
    jumps_ = jumped ? jumps_ + 1 : 0;
    if (jumps_ >= jumps_of_chance) {
        chance_ = others = {};
        jumps_ = 0;
    }
    if (!jumped) {
        note(settings, e, open, others);
    }
    const Chance chance = together(chance_, others);
    if (jumped || (chance.count >= states_to_tell && chance.variance_at_most() <= square(none))) {
        trusting_ = seeing_ = {Vec3(0.0), 1.0};
        leaning_ = Vec3(0.0);
        return Vec3(0.0);
    }
    trusting_.off = off.trusting;
    seeing_.off = off.seeing;
    leaning_ -= leaning_share * (trusting_.off + leaning_);
    const double variance = chance.variance();
    const bool honest = variance <= square(none);
    const double left_open = honest ? 0.0 : square(open) / (3.0 * variance);
    for (Belief* const belief : {&trusting_, &seeing_}) {
        const double before = belief->gain + left_open;
        belief->gain = before / (before + 1.0);
        belief->off *= 1.0 - belief->gain;
    }
    return honest ? Vec3(0.0) : believed(settings, chance, still);
}

void FarEyes::note_forbidden(const PoseFilterSettings& settings, const Pose& seen, const Pose& allowed) {
    const auto note = [&settings](Chance& chance, const Vec3& n) {
        if (chance.count < states_to_tell) {
            chance.note(std::sqrt(2.0) * n, -std::sqrt(0.5) * n, true, 0.0, settings.states);
        }
    };
    note(place, seen.position - allowed.position);
    note(turn, turn_vector(seen.rotation * glm::conjugate(allowed.rotation)));
}

Pose PoseFilter::filter(const PoseFilterSettings& settings, const Pose& seen, const Pose& model,
                        const PoseStep& step, FarEyes& eyes) {
    const auto moved = [&step](const Pose& pose) {
        return Pose{pose.position + step.way, step.turn * pose.rotation};
    };
    const auto turned_off = [&seen](const Pose& pose) {
        return turn_vector(pose.rotation * glm::conjugate(seen.rotation));
    };
    const auto placed_off = [&seen](const Vec3& place, const Vec3& turn) {
        return Pose{seen.position + place, glm::normalize(turn_of(turn) * seen.rotation)};
    };
    Vec3 place(0.0), turn(0.0);
    const bool still = is_still(settings, step);
    if (!known_) {
        known_ = true;
        place = place_.begin(settings, settings.place, {model.position - seen.position, Vec3(0.0)}, still,
                             eyes.place);
        turn = turn_.begin(settings, settings.turn, {turned_off(model), Vec3(0.0)}, still, eyes.turn);
    } else {
        const Pose led = moved(seen_), trusting = moved(trusting_), seeing = moved(seeing_);
        place = place_.see(settings, settings.place, seen.position - led.position,
                           {trusting.position - seen.position, seeing.position - seen.position},
                           step.open_way, still, eyes.place);
        turn = turn_.see(settings, settings.turn, -turned_off(led),
                         {turned_off(trusting), turned_off(seeing)}, step.open_turn, still, eyes.turn);
    }
    seen_ = seen;
    trusting_ = placed_off(place_.off().trusting, turn_.off().trusting);
    seeing_ = placed_off(place_.off().seeing, turn_.off().seeing);
    Pose believed = placed_off(place, turn);
    if (turn == Vec3(0.0)) {
        believed.rotation = seen.rotation;
    }
    return believed;
}

Pose PoseFilter::unless_said(const PoseFilterSettings& settings, const Pose& believed, const Pose& model,
                             const FarEyes& eyes) const {
    const double said = square(settings.unsaid);
    const double place = said * place_.doubt(settings.place, eyes.place);
    const Vec3 apart = believed.position - model.position;
    const Vec3 turn = turn_vector(believed.rotation * glm::conjugate(model.rotation));
    Pose result = believed;
    if (square(apart) <= place) {
        result.position = model.position;
    }
    if (square(turn) <= said * turn_.doubt(settings.turn, eyes.turn)) {
        result.rotation = model.rotation;
    }
    return result;
}

}  // namespace tactus
