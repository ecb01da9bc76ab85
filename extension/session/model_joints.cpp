#include "session/model_joints.hpp"

#include <algorithm>

namespace tactus {

DiscoveryVerdict ModelJoints::describe(const ObjectJoint& joint) {
    remove(joint.object);
    if (!wrong_in(joint.joint).empty()) {
        return DiscoveryVerdict::refused;
    }
    Joint& made = joints_.emplace_back();
    made.described = joint;
    if (joint.second == no_object) {
        made.described.joint.second_frame = compose(frame_, *joint.joint.second_frame);
    }
    return DiscoveryVerdict::known;
}

void ModelJoints::remove(ObjectId object) {
    std::erase_if(joints_, [&](Joint& joint) {
        const bool goes = !joint.outdated && joint.described.object == object;
        if (goes) {
            release(joint);
        }
        return goes;
    });
}

void ModelJoints::outdate() {
    for (Joint& joint : joints_) {
        joint.outdated = true;
    }
}

void ModelJoints::remove_outdated() {
    std::erase_if(joints_, [this](Joint& joint) {
        if (joint.outdated) {
            release(joint);
        }
        return joint.outdated;
    });
}

void ModelJoints::clear() {
    outdate();
    remove_outdated();
}

void ModelJoints::join(const FindBody& body_of) {
    for (Joint& joint : joints_) {
        if (joint.outdated) {
            continue;
        }
        const bool to_scene = joint.described.second == no_object;
        const SessionHandle first = body_of(joint.described.first);
        const SessionHandle second = to_scene ? no_handle : body_of(joint.described.second);
        if (first == no_handle || (second == no_handle && !to_scene)) {
            release(joint);
        } else if (first != joint.first || second != joint.second) {
            join(joint, first, second);
        }
    }
}

void ModelJoints::join(Joint& joint, SessionHandle first, SessionHandle second) {
    release(joint);
    AddResult added = session_.add_joint(joint.described.joint, first, second);
    joint.handle = added.handle;
    joint.problem = std::move(added.error);
    joint.first = first;
    joint.second = second;
}

void ModelJoints::release(Joint& joint) {
    if (joint.handle != no_handle) {
        session_.remove_joint(joint.handle);
    }
    joint.handle = joint.first = joint.second = no_handle;
}

std::size_t ModelJoints::count() const {
    return static_cast<std::size_t>(std::ranges::count(joints_, false, &Joint::outdated));
}

std::vector<std::string> ModelJoints::problems() const {
    std::vector<std::string> all;
    for (const Joint& joint : joints_) {
        if (!joint.problem.empty()) {
            all.push_back("a joint of the other side: " + joint.problem);
        }
    }
    return all;
}

}  // namespace tactus
