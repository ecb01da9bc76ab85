#include "shared/unexplained_steps.hpp"

#include <gtest/gtest.h>

namespace tactus::unexplained_steps_test {
namespace {

using namespace shared;

constexpr double most = 0.5 + 1e-9;  // (unit: newtons)

// At other delays: ./run experiment kicks.
TEST(UnexplainedSteps, AHandThatHoldsStillFeelsNoKick) {
    int cases = 0, pressing = 0;
    for (const StillCase& one : still_cases()) {
        if (one.delay != 0.05) {
            continue;
        }
        SCOPED_TRACE(one.name);
        const StillFigures figures = run_still(one);
        ++cases;
        pressing += figures.pressed > 1.0 ? 1 : 0;
        EXPECT_LE(figures.near_step, most);
        EXPECT_LE(figures.far_step, 0.51);
        EXPECT_EQ(figures.far_alone, 0.0);
    }
    EXPECT_GT(cases, 40);
    EXPECT_GE(pressing, cases - 4);
}

}  // namespace
}  // namespace tactus::unexplained_steps_test
