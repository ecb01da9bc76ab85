// Forces that scripts compute, on an arm in a whole session: what depends on the place alone makes no energy.
#include <gtest/gtest.h>

#include "shared/script_forces.hpp"

namespace tactus::script_force_test {
namespace {

using shared::ScriptFigures;
using shared::ScriptForm;

ScriptFigures played(ScriptForm form) {
    ScriptFigures all;
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        all.add(shared::play_script(form, seed));
    }
    return all;
}

TEST(ScriptForce, ALeapARampAndACliffMakeNoEnergyAndDoNotShake) {
    for (const ScriptForm form : {ScriptForm::leap, ScriptForm::ramp, ScriptForm::cliff}) {
        const ScriptFigures figures = played(form);
        EXPECT_LE(figures.energy_made_max, 0.01) << name_of(form);
        EXPECT_LE(figures.shake_max, 3e-3) << name_of(form);
        EXPECT_GE(figures.limited, figures.runs * 3 / 4) << name_of(form) << ": and it is said where it is";
    }
}

TEST(ScriptForce, ASpringHoweverSteepMakesNoEnergy) {
    const ScriptFigures figures = played(ScriptForm::spring);
    EXPECT_LE(figures.energy_made_max, 0.01);
    EXPECT_LE(figures.shake_max, 3e-3);
}

TEST(ScriptForce, AWindIsNotLimited) {
    const ScriptFigures figures = played(ScriptForm::wind);
    EXPECT_LE(figures.energy_made_max, 0.01);
    EXPECT_EQ(figures.limited, 0);
}

}  // namespace
}  // namespace tactus::script_force_test
