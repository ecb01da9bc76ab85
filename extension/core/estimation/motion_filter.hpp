// Where a body is and how it moves, from poses that are seen with known chance.
//
// Two accounts are kept of what is seen. One holds that the body moves on as it did, pushed by chance of
// known strength: Kalman's filter of place and velocity. The other holds that it rests: the mean of all that
// was seen since. Rest is believed when chance explains enough poses in succession, and no longer than it
// does: a single pose far off ends it, and so does a mean of the last ones that leans to one side. Else noise
// would become velocity, and velocity a model that creeps.
//
// At rest the place that is told follows the mean no faster than a hand can feel. Velocities are zero there,
// not small.
//
// Covariances are whole matrices: a turn about a symmetry's axis, which nobody can see, counts for nothing,
// and what is seen across it for all it is worth.
#pragma once

#include "core/math/pose.hpp"
#include "core/math/small_matrix.hpp"

namespace tactus {

struct MotionFilterSettings {
    double push = 0.1;            // of chance, spectral density of acceleration (unit: m^2/s^3), > 0
    double twist = 5.0;           // and of angular acceleration (unit: rad^2/s^3), > 0
    int poses_at_rest = 10;       // in succession that chance explains: it rests, >= 2
    double contradicted = 4.0;    // standard deviations that chance does not explain, > 0
    double elsewhere = 5.0;       // so many, and no motion explains it either: it was put there, > 0
    int poses_to_settle = 150;    // at rest, until it has settled
    double settling = 2e-4;       // until then the told place moves no faster (unit: m/s), > 0
    double settling_turn = 2e-3;  // (unit: rad/s), > 0
    double creep = 8e-6;          // and from then on (unit: m/s), > 0
    double creep_turn = 8e-5;     // (unit: rad/s), > 0
    double longest_gap = 0.5;     // without a pose: what is known of the motion is old (unit: seconds), > 0
};

// A vector that is seen with chance, by both accounts. Turns are vectors about the last estimate.
class SeenVector {
public:
    struct Innovation {
        Vec3 moving{0.0}, resting{0.0};  // what is seen off the moving account's estimate, and off the mean
        Mat3 covariance{1.0};            // of what is seen
    };
    // What both estimates have to be moved by.
    struct Change {
        Vec3 moving{0.0}, resting{0.0};
        bool rest_contradicted = false;  // the mean has to begin anew where it is seen
        bool elsewhere = false;          // all has to begin anew there: nothing was changed
    };

    void begin(const Mat3& covariance, double push);
    void begin_rest(const Mat3& covariance);
    // `seconds` pass.
    void pass(double seconds, double push);
    Change see(const Innovation& innovation, const MotionFilterSettings& settings);

    Vec3 velocity() const { return velocity_; }
    int poses() const { return poses_; }
    const Mat3& covariance_moving() const { return pp_; }
    const Mat3& covariance_resting() const { return mean_; }

private:
    Vec3 velocity_{0.0};
    Mat3 pp_{1.0}, pv_{0.0}, vv_{1.0};  // covariances of place, place and velocity, velocity
    int poses_ = 0;                     // that make the mean
    Mat3 mean_{1.0};                    // covariance of the mean
    Vec3 leaning_{0.0};                 // mean of the last ones off the mean
};

class MotionFilter {
public:
    // A pose with its covariance: of place and turn, in the world (unit: meters, radians). Poses come in the
    // order of their times; one that is not finite, or not later than the last, changes nothing.
    void see(const MotionFilterSettings& settings, const Pose& pose, const Matrix6& covariance,
             Nanoseconds time);

    // Where it will be at a time, or is: nothing is known before the first pose. Velocities end with the
    // longest gap.
    Pose at(const MotionFilterSettings& settings, Nanoseconds time) const;

    bool is_known() const { return known_; }
    bool rests() const { return rests_; }
    const Pose& pose() const { return told_; }
    Vec3 linear_velocity() const { return rests_ ? Vec3(0.0) : place_.velocity(); }
    Vec3 angular_velocity() const { return rests_ ? Vec3(0.0) : turn_.velocity(); }
    // Of what is told (unit: square meters, square radians).
    const Mat3& place_covariance() const {
        return rests_ ? place_.covariance_resting() : place_.covariance_moving();
    }
    const Mat3& turn_covariance() const {
        return rests_ ? turn_.covariance_resting() : turn_.covariance_moving();
    }
    void forget() { *this = {}; }

private:
    void begin(const MotionFilterSettings& settings, const Pose& pose, const Mat3& place, const Mat3& turn);
    void tell(const MotionFilterSettings& settings, double seconds);

    bool known_ = false, rests_ = false;
    Nanoseconds time_ = 0;
    Pose moving_, mean_, told_;
    SeenVector place_, turn_;
};

}  // namespace tactus
