// A small share of what the bench teleop_stress throws at both sides, and silence.
#include <gtest/gtest.h>

#include "shared/attack.hpp"

namespace tactus::shared {
namespace {

AttackFigures expect_nothing_has_happened(const AttackSettings& settings) {
    const AttackFigures figures = run_attack(settings);
    SCOPED_TRACE(kind_name(settings.kind) + " from " + name_of(settings.attacker));
    EXPECT_GE(figures.packets, settings.packets);
    EXPECT_EQ(figures.moved_objects, 0u);
    EXPECT_EQ(figures.force_steps, 0u) << figures.largest_unmoved_step << " N";
    EXPECT_EQ(figures.not_recovered, 0u);
    return figures;
}

TEST(TeleopStress, APeerThatSaysWhatNoHonestOneWouldDoesNoHarm) {
    for (std::size_t kind = 0; kind < kind_count(); ++kind) {
        const AttackFigures figures = expect_nothing_has_happened({kind, Attacker::with_key, 20'000, 7});
        if (kind_name(kind) == "bodies" || kind_name(kind) == "joints") {
            EXPECT_GT(figures.model_changes, 3u) << "or nothing of it was believed";
        }
    }
}

// Bodies that vanish from under the hand, are torn away and put back, pull or are thrown: each seed is
// another.
TEST(TeleopStress, APeerThatDescribesWhatNoHonestOneWouldDoesNoHarm) {
    for (const std::size_t kind : {kind_count() - 2, kind_count() - 1}) {
        std::uint64_t model_changes = 0;
        for (const std::uint64_t seed : {3, 9, 10, 13, 20, 22, 50, 56, 73, 86, 106}) {
            SCOPED_TRACE(seed);
            model_changes +=
                expect_nothing_has_happened({kind, Attacker::with_key, 20'000, seed}).model_changes;
        }
        EXPECT_GT(model_changes, 33u) << "or nothing of it was believed";
    }
}

TEST(TeleopStress, WhoHasNoKeyDoesNoHarm) {
    for (const std::size_t kind : {std::size_t{0}, std::size_t{8}, kind_count() - 2}) {
        expect_nothing_has_happened({kind, Attacker::stranger, 20'000, 8});
        expect_nothing_has_happened({kind, Attacker::without_key, 20'000, 9});
    }
}

TEST(TeleopStress, AfterSilenceTheFarHandIsBackWithinHalfASecond) {
    for (const double silence : {0.4, 0.7, 5.0}) {
        const BlackoutFigures figures = run_blackout(silence);
        EXPECT_LE(figures.recovery_s, 0.5) << silence;
        EXPECT_LE(figures.max_speed, 1.01) << silence;
    }
}

}  // namespace
}  // namespace tactus::shared
