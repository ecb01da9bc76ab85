// The joints of a world: private to physics/.
#pragma once

#include <vector>

#include "physics/joint.hpp"
#include "physics/joint_axis.hpp"
#include "physics/joint_swing.hpp"
#include "physics/jolt.hpp"

#include <Jolt/Physics/Body/Body.h>
#include <Jolt/Physics/Collision/CollisionGroup.h>
#include <Jolt/Physics/Collision/GroupFilter.h>
#include <Jolt/Physics/Constraints/TwoBodyConstraint.h>

namespace JPH {
class PhysicsSystem;
}

namespace tactus {

class JointTable final : public JPH::GroupFilter {
public:
    JointTable(JPH::PhysicsSystem& system, std::size_t most);

    // The bodies are different and at least one of them can move; the description has nothing wrong.
    // `first_pose`, `second_pose`: where they are.
    JointId add(const JointDescription& description, JPH::Body& first, JPH::Body& second,
                const Pose& first_pose, const Pose& second_pose);
    bool remove(JointId id);
    void remove_all_of(const JPH::Body& body);
    void forget_impulses_of(const JPH::Body& body);  // of the last step, which the next would begin with

    // The centre of mass of a body moved within it.
    void shape_changed(const JPH::Body& body, JPH::Vec3Arg way);

    // Before a step: drives all joints, and notes the points that some hold.
    void begin_step(JointSwing& swing);

    // Nearest to `pose` that the joints of the body to what does not move allow, one after the other.
    // `pose_of`: of a body that does not move.
    template <typename PoseOf>
    Pose on_joints(const JPH::Body& body, Pose pose, const PoseOf& pose_of) const {
        for (const Joint& joint : joints_) {
            if (!joint.holds(body))
                continue;
            const JPH::Body& first = *joint.constraint->GetBody1();
            const JPH::Body& second = *joint.constraint->GetBody2();
            if (&first == &body && second.IsStatic())
                pose = first_allowed(joint.described, pose, pose_of(second));
            else if (&second == &body && first.IsStatic())
                pose = second_allowed(joint.described, pose_of(first), pose);
        }
        return pose;
    }

    std::size_t count() const { return count_; }

    // What the joints themselves do not hold of their state, of the same joints.
    void save(JPH::StateRecorder& writer) const;
    void restore(JPH::StateRecorder& reader);

    // Bodies of a joint have the group of their index; those that may not collide are looked up here.
    bool CanCollide(const JPH::CollisionGroup& a, const JPH::CollisionGroup& b) const override;

private:
    struct Joint {
        JPH::Ref<JPH::TwoBodyConstraint> constraint;  // null: vacant
        JPH::CollisionGroup::GroupID first = 0;
        JPH::CollisionGroup::GroupID second = 0;
        bool bodies_collide = true;
        bool holds_point = false;  // of both bodies, the same one
        std::array<JointAxis, 6> axes;
        JointDescription described;  // its frames in those of the bodies
        std::uint32_t generation = 0;

        bool holds(const JPH::Body& body) const {
            return constraint != nullptr &&
                   (constraint->GetBody1() == &body || constraint->GetBody2() == &body);
        }
    };

    void remove(Joint& joint);
    void join_group(JPH::Body& body);

    JPH::PhysicsSystem& system_;
    std::vector<Joint> joints_;
    std::size_t count_ = 0;
};

}  // namespace tactus
