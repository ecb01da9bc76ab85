// What a force that a script computes, some dozens of times a second, does to an arm that is led into it: a
// whole session in virtual time. A force that depends on the place alone makes no energy; what is felt of it
// may make a little.
#pragma once

#include <cstdint>
#include <string_view>

namespace tactus::shared {

// Along x: newtons over meters.
enum class ScriptForm {
    leap,     // so many newtons for x <= 0, else none
    ramp,     // the same within a millimeter
    cliff,    // the same and a spring behind it
    spring,   // to the origin
    detents,  // a sine
    saw,      // a sine's leaping sister
    wind,     // everywhere the same
};
inline constexpr ScriptForm script_forms[] = {ScriptForm::leap,   ScriptForm::ramp,    ScriptForm::cliff,
                                              ScriptForm::spring, ScriptForm::detents, ScriptForm::saw,
                                              ScriptForm::wind};
std::string_view name_of(ScriptForm form);

struct ScriptFigures {
    double energy_made_max = 0.0;  // beyond that of the force itself, at any time of 4 s (unit: joules)
    double shake_max = 0.0;        // of an arm that is held still, in the last two of them (unit: meters)
    int limited = 0;               // runs in which it was said that the force was made weaker
    int runs = 0;

    void add(const ScriptFigures& other);
};

// One seeded run: how large the force is, how heavy and how well damped the arm, how many frames a second,
// and how old the place is of which the script is asked.
ScriptFigures play_script(ScriptForm form, std::uint64_t seed);

}  // namespace tactus::shared
