#include "network/terms.hpp"

#include <gtest/gtest.h>

namespace tactus::terms_test {
namespace {

Terms alike() {
    Terms terms;
    terms.bodies = 64;
    terms.hands[0] = {HandTerms::Kind::fingertip, 0.01, 0};
    terms.hands[16] = {HandTerms::Kind::tool, 0.0, 77};
    return terms;
}

// Neither side can do without the other's word of what differs: both say it.
void expect_differs(const Terms& of_operator, const Terms& of_teleoperator, Term term, bool whole) {
    const Disagreement found = compare(of_operator, of_teleoperator);
    EXPECT_TRUE(found.any());
    EXPECT_EQ(found.whole, whole);
    EXPECT_TRUE(found.has(term));
    EXPECT_NE(explain(found, of_operator, of_teleoperator, Side::operator_side), "");
    EXPECT_NE(explain(found, of_teleoperator, of_operator, Side::teleoperator_side), "");
}

TEST(Terms, AlikeSidesWorkTogether) {
    EXPECT_FALSE(compare(alike(), alike()).any());
    EXPECT_EQ(explain({}, alike(), alike(), Side::operator_side), "");
}

TEST(Terms, EachPropertyThatDiffersIsFound) {
    for (std::uint8_t here = 2; here <= 5; ++here) {
        for (std::uint8_t there = 2; there <= 5; ++there) {
            if (here != there) {
                Terms a = alike(), b = alike();
                a.scenario = here;
                b.scenario = there;
                expect_differs(a, b, Term::scenario, true);
            }
        }
    }
    for (const bool swapped : {false, true}) {
        Terms a = alike(), b = alike();
        a.scenario = b.scenario = 2;
        (swapped ? a : b).passivity = 2;
        expect_differs(a, b, Term::passivity, true);
        a.passivity = b.passivity = Terms::with_waves;
        a.impedance = b.impedance = 20.0;
        EXPECT_FALSE(compare(a, b).any());
        (swapped ? a : b).impedance = 21.0;
        expect_differs(a, b, Term::impedance, true);
        a = b = alike();
        (swapped ? a : b).hands[0].radius = 0.02;
        expect_differs(a, b, Term::radius, false);
        a = b = alike();
        (swapped ? a : b).hands[16].shape = 78;
        expect_differs(a, b, Term::tool, false);
    }
    Terms few = alike();
    few.bodies = 8;
    expect_differs(few, alike(), Term::bodies, true);
    EXPECT_FALSE(compare(alike(), few).any()) << "more room than is needed";
}

TEST(Terms, OnlyTheHandThatDiffersRests) {
    Terms here = alike(), there = alike();
    here.hands[3] = {HandTerms::Kind::fingertip, 0.01, 0};
    expect_differs(here, there, Term::missing_hand, false);
    const Disagreement found = compare(here, there);
    EXPECT_FALSE(found.works(3));
    EXPECT_TRUE(found.works(0));
    EXPECT_TRUE(found.works(16));
    EXPECT_FALSE(compare(there, here).any()) << "the teleoperator may have more";
}

TEST(Terms, WithAModelThePassivityMeansNothing) {
    Terms here = alike();
    here.passivity = 3;
    EXPECT_FALSE(compare(here, alike()).any());
}

}  // namespace
}  // namespace tactus::terms_test
