// Limits of a joint as an engine counts them, in ours: its angles are how far the first body has turned
// against the second, about the joint's axis; its lengths count as ours do, the second against the first.
#pragma once

#include "physics/joint.hpp"

namespace tactus {

// Lower above upper means free, there as here.
inline JointRange limits(bool are_used, double lower, double upper) {
    return are_used ? JointRange{lower, upper} : JointRange::free();
}

// Of angles that are counted so.
inline JointRange turned(const JointRange& of_first) {
    return of_first.lower > of_first.upper ? JointRange::free()
                                           : JointRange{-of_first.upper, -of_first.lower};
}

}  // namespace tactus
