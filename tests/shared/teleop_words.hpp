// Scenes and cases of teleoperation as lines of words, as tools/measuring/teleop_runs.py writes them; "#"
// begins a comment.
//     radius METERS | limit NEWTONS
//     path circle CX CY CZ RADIUS AMPLITUDE TURN_SECONDS WAVES
//     path linear|smooth SECONDS X Y Z  SECONDS X Y Z …
//     body NAME static|dynamic MASS FRICTION RESTITUTION  STIFFNESS DAMPING STATIC DYNAMIC
//          X Y Z  QW QX QY QZ  LINEAR_DAMPING ANGULAR_DAMPING
//     box HX HY HZ  X Y Z  QW QX QY QZ      (of the last body; half extents, then where in the body)
//     sphere R X Y Z
//     hinge NAME X Y Z AX AY AZ             (of a body above, to the world; where, and about which axis)
//     case NAME key=value …
// Among the keys of a case, event.ANYTHING=SECONDS,KIND[,BODY or AMOUNT], see TeleopEvent.
#pragma once

#include <iosfwd>
#include <string>

#include "shared/teleop_case.hpp"

namespace tactus::shared {

// False, with a word on stderr, where there is no scene in it.
bool read_scene(const std::string& path, TeleopScene& scene);

// What follows the word "case" in a line. False, with a word on stderr, where it is not understood.
bool read_case(std::istream& in, TeleopCase& experiment);

}  // namespace tactus::shared
