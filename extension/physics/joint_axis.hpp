// What acts along one axis of a joint: the drive or the motor of a hinge or a slider, and the way back of a
// body that stands beyond a limit, because that was moved. Private to physics/.
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
    // The axis of that index: 0 of a hinge and a slider; of six axes, those along come first.
    JointAxis(const JointDescription& joint, JPH::TwoBodyConstraint& constraint, int index);

    // Before a step.
    void drive();

    // It began beyond a limit, and has not been within since. All else is described, or Jolt's.
    bool returns() const { return returns_; }
    void set_returns(bool returns) { returns_ = returns; }

private:
    enum class Kind { none, hinge, along, about };

    bool turns() const { return kind_ == Kind::hinge || kind_ == Kind::about; }
    bool is_driven() const;
    double place() const;
    void limit(const JointRange& range);
    void move(JPH::EMotorState state, double velocity, double target) const;
    void set_motor(double stiffness, double damping, double strongest) const;
    void act(double at) const;
    JPH::HingeConstraint& hinge() const;
    JPH::SixDOFConstraint& six() const;

    Kind kind_ = Kind::none;
    int index_ = 0;                                 // of six axes
    JPH::TwoBodyConstraint* constraint_ = nullptr;  // the table's
    JointRange range_ = JointRange::free();
    JointRange limits_ = JointRange::free();  // that the constraint has
    double zero_ = 0.0;                       // where Jolt's zero is (unit: radians)
    JointDrive drive_;
    double motor_speed_ = 0.0;
    double motor_torque_ = 0.0;
    bool returns_ = true;
};

}  // namespace tactus
