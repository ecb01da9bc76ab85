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
    texture,  // a sine of 0.5 to 5 mm
    notches,  // narrow detents with nothing in between
    teeth,    // a saw of 1 to 10 mm that leaps the other way
    square,   // leaps to and fro
    pair,     // two effects at once: a wall that leaps, and detents
    stiff,    // to the origin, 2,000 to 10,000 N/m
};
inline constexpr ScriptForm script_forms[] = {
    ScriptForm::leap,   ScriptForm::ramp, ScriptForm::cliff,   ScriptForm::spring,  ScriptForm::detents,
    ScriptForm::saw,    ScriptForm::wind, ScriptForm::texture, ScriptForm::notches, ScriptForm::teeth,
    ScriptForm::square, ScriptForm::pair, ScriptForm::stiff};
std::string_view name_of(ScriptForm form);

// When a script is asked.
struct ScriptFrames {
    double rate = 0.0;     // frames a second; 0: 30 to 144 of them, by the seed
    double hiccups = 0.0;  // share of frames that take 30 to 100 ms
};

struct ScriptFigures {
    // Beyond the work of the force itself, at any time of 4 s, from when the effect has faded in. A spring
    // that is steeper than any is felt (HandField::stiffest) is one as stiff as that (unit: joules).
    double energy_made_max = 0.0;
    double shake_max = 0.0;  // of an arm that is held still, in the last two of them (unit: meters)
    int limited = 0;         // runs in which it was said that the force was made weaker
    int steep = 0;           // runs in which it is steeper than any is felt: there it has to be said
    int runs = 0;

    void add(const ScriptFigures& other);
};

// One seeded run: how large the force is, how heavy and how well damped the arm, how many frames a second,
// and how old the place is of which the script is asked.
ScriptFigures play_script(ScriptForm form, std::uint64_t seed, const ScriptFrames& frames = {});

}  // namespace tactus::shared
