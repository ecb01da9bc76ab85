#include "session/truth_store.hpp"

#include <gtest/gtest.h>

namespace tactus::truth_store_test {
namespace {

BodyMotion at(double x) {
    BodyMotion made;
    made.pose.position.x = x;
    return made;
}

TEST(TruthStore, NewestWinsForEachBodyByThePacketThatBroughtIt) {
    TruthStore truths(8, 2);
    EXPECT_TRUE(truths.take(3, 10, 100, at(0.1)));
    EXPECT_FALSE(truths.take(3, 11, 99, at(0.2)));
    EXPECT_FALSE(truths.take(3, 11, 100, at(0.2)));
    EXPECT_TRUE(truths.take(4, 9, 99, at(0.3)));
    EXPECT_TRUE(truths.take(3, 12, 101, at(0.4)));
    EXPECT_EQ(truths.of(3).sample, 12u);
    EXPECT_EQ(truths.of(3).sample_before, 10u);
    EXPECT_EQ(truths.of(3).before.pose.position.x, 0.1);
    EXPECT_EQ(truths.fresh().size(), 2u);
    truths.settle();
    EXPECT_TRUE(truths.fresh().empty());
    EXPECT_FALSE(truths.of(3).fresh);
}

TEST(TruthStore, TheNearestToAHandHaveAPlaceWhereThereAreTooFew) {
    TruthStore truths(100, 3);
    const Vec3 hands[] = {Vec3(0.0)};
    SessionHandle evicted = no_handle;
    for (SessionHandle body = 0; body < 100; ++body) {
        truths.take(body, 1, body + 1, at(1.0 + static_cast<double>((body * 37) % 100)));
        truths.give_place(body, hands, evicted);
    }
    for (SessionHandle body = 0; body < 100; ++body) {
        const bool near = (body * 37) % 100 < 3;
        EXPECT_EQ(truths.place_of(body) != TruthStore::no_place, near) << body;
    }
}

TEST(TruthStore, AForgottenBodyGivesItsPlaceBack) {
    TruthStore truths(8, 1);
    SessionHandle evicted = no_handle;
    truths.take(2, 1, 1, at(0.0));
    EXPECT_EQ(truths.give_place(2, {}, evicted), 0u);
    truths.take(5, 1, 1, at(0.0));
    EXPECT_EQ(truths.give_place(5, {}, evicted), TruthStore::no_place);
    truths.forget(2);
    EXPECT_EQ(truths.give_place(5, {}, evicted), 0u);
    EXPECT_EQ(truths.body_at(0), 5u);
    EXPECT_EQ(truths.fresh().size(), 1u);
}

}  // namespace
}  // namespace tactus::truth_store_test
