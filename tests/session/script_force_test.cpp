// Forces that scripts compute, on an arm in a whole session: what depends on the place alone makes no energy.
#include <gtest/gtest.h>

#include "shared/script_forces.hpp"

namespace tactus::script_force_test {
namespace {

using shared::ScriptFigures;
using shared::ScriptForm;
using shared::ScriptFrames;

ScriptFigures played(ScriptForm form, const ScriptFrames& frames = {}, std::uint64_t seeds = 20) {
    ScriptFigures all;
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
        all.add(shared::play_script(form, seed, frames));
    }
    return all;
}

TEST(ScriptForce, ALeapARampAndACliffMakeNoEnergyAndDoNotShake) {
    for (const ScriptForm form : {ScriptForm::leap, ScriptForm::ramp, ScriptForm::cliff}) {
        const ScriptFigures figures = played(form);
        EXPECT_LE(figures.energy_made_max, 0.01) << name_of(form);
        EXPECT_LE(figures.shake_max, 3e-3) << name_of(form);
        EXPECT_GE(figures.limited, figures.steep) << name_of(form) << ": and it is said where it is";
    }
}

TEST(ScriptForce, ASpringHoweverSteepMakesNoEnergy) {
    const ScriptFigures figures = played(ScriptForm::spring);
    EXPECT_LE(figures.energy_made_max, 0.01);
    EXPECT_LE(figures.shake_max, 3e-3);
}

// They made 0.12 and 0.22 J, and 0.7 J where the hand snaps from one to the next.
TEST(ScriptForce, DetentsASawAndTeethMakeNoEnergy) {
    for (const ScriptForm form : {ScriptForm::detents, ScriptForm::saw, ScriptForm::teeth}) {
        const ScriptFigures figures = played(form);
        EXPECT_LE(figures.energy_made_max, 0.01) << name_of(form);
        EXPECT_GE(figures.limited, figures.steep) << name_of(form) << ": and it is said where it is";
    }
}

TEST(ScriptForce, TexturesNotchesAndTwoEffectsAtOnceMakeNoEnergy) {
    for (const ScriptForm form :
         {ScriptForm::texture, ScriptForm::notches, ScriptForm::square, ScriptForm::pair}) {
        const ScriptFigures figures = played(form);
        EXPECT_LE(figures.energy_made_max, 0.01) << name_of(form);
        EXPECT_GE(figures.limited, figures.steep) << name_of(form);
    }
}

TEST(ScriptForce, ASpringThatIsMuchTooSteepGivesNothingAndSaysSo) {
    const ScriptFigures figures = played(ScriptForm::stiff);
    EXPECT_LE(figures.energy_made_max, 0.01);
    EXPECT_LE(figures.shake_max, 3e-3);
    EXPECT_EQ(figures.limited, figures.runs);
}

TEST(ScriptForce, NoneMakesEnergyAtThirtyOrAtAHundredAndFortyFourFrames) {
    for (const double rate : {30.0, 144.0}) {
        for (const ScriptForm form : shared::script_forms) {
            EXPECT_LE(played(form, {rate, 0.0}, 8).energy_made_max, 0.01) << name_of(form) << ", " << rate;
        }
    }
}

TEST(ScriptForce, NoneMakesEnergyWhereFramesHiccup) {
    for (const ScriptForm form : shared::script_forms) {
        EXPECT_LE(played(form, {0.0, 0.1}).energy_made_max, 0.01) << name_of(form);
    }
}

TEST(ScriptForce, AWindIsNotLimited) {
    const ScriptFigures figures = played(ScriptForm::wind);
    EXPECT_LE(figures.energy_made_max, 0.01);
    EXPECT_EQ(figures.limited, 0);
}

}  // namespace
}  // namespace tactus::script_force_test
