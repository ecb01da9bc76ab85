// What acts along the one free axis of a hinge or a slider: its drive, its motor, and the way back of a body
// that stands beyond a limit, because that was moved. Private to physics/.
//
// Springs are implicit (Jolt's soft constraints), and stable at any stiffness. Where the joint begins beyond
// a limit, the body is led back at a bounded speed, which is its velocity meanwhile: a limit that is raised
// under a hand pushes it by the way of one tick at a time.
#pragma once

#include "physics/joint.hpp"
#include "physics/jolt.hpp"

#include <Jolt/Physics/Constraints/MotorSettings.h>

namespace JPH {
class HingeConstraint;
class SixDOFConstraint;
class TwoBodyConstraint;
}  // namespace JPH

namespace tactus {

class JointAxis {
public:
    JointAxis() = default;  // drives nothing
    JointAxis(const JointDescription& joint, JPH::TwoBodyConstraint& constraint);

    // Before a step.
    void drive();

private:
    enum class Kind { none, hinge, slider };

    double place() const;
    void limit(const JointRange& range) const;
    void move(JPH::EMotorState state, double velocity, double target) const;
    void set_motor(double stiffness, double damping, double strongest) const;
    void act(double at) const;
    JPH::HingeConstraint& hinge() const;
    JPH::SixDOFConstraint& slider() const;

    Kind kind_ = Kind::none;
    JPH::TwoBodyConstraint* constraint_ = nullptr;  // the table's
    JointRange range_ = JointRange::free();
    double zero_ = 0.0;  // where Jolt's zero is (unit: radians)
    JointDrive drive_;
    double motor_speed_ = 0.0;
    double motor_torque_ = 0.0;
    bool returns_ = true;  // it began beyond a limit, and has not been within since
};

}  // namespace tactus
