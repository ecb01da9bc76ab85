#include "shared/agreement.hpp"

#include <gtest/gtest.h>

namespace tactus::agreement_test {
namespace {

using namespace shared;

TEST(Agreement, SidesThatDifferPressNothingAndBothSayWhy) {
    int differing = 0;
    for (const AgreementCase& one : agreement_cases()) {
        SCOPED_TRACE(one.name);
        const AgreementFigures figures = run_agreement(one);
        if (one.alike) {
            EXPECT_GT(figures.near_force, 1.0);
            EXPECT_GT(figures.far_force, 1.0);
            EXPECT_FALSE(figures.near_says || figures.far_says);
            continue;
        }
        ++differing;
        EXPECT_EQ(figures.near_force, 0.0);
        EXPECT_EQ(figures.far_force, 0.0);
        EXPECT_TRUE(figures.near_says);
        EXPECT_TRUE(figures.far_says);
    }
    EXPECT_GE(differing, 40);
}

}  // namespace
}  // namespace tactus::agreement_test
