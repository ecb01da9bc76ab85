#include "core/proxy/contact_gathering.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "shared/random_values.hpp"

namespace tactus::contact_gathering_test {
namespace {

using shared::RandomValues;

Contact contact_at(double gap) {
    Contact contact;
    contact.gap = gap;
    return contact;
}

constexpr double rest = 0.5;
constexpr Tolerances tolerances{1e-8, 5e-9, 1e-9, 1e-6, 1e-9, 1e-11};

// Some of them are as far as others, to the bit.
std::vector<double> some_gaps(RandomValues& random, int count) {
    std::vector<double> gaps;
    for (int i = 0; i < count; ++i) {
        const bool again = !gaps.empty() && random.below(4) == 0;
        gaps.push_back(again ? gaps[static_cast<std::size_t>(random.below(i))] : random.between(-0.1, 1.0));
    }
    return gaps;
}

std::vector<double> gaps_of(const ContactList& list) {
    std::vector<double> gaps;
    for (const Contact& contact : list.all()) {
        gaps.push_back(contact.gap);
    }
    std::ranges::sort(gaps);
    return gaps;
}

}  // namespace

TEST(ContactGathering, KeepsTheNearest) {
    RandomValues random(3);
    for (int round = 0; round < 200; ++round) {
        const int count = 1 + random.below(3 * ContactList::capacity);
        std::vector<double> gaps = some_gaps(random, count);
        ContactList list;
        ContactGathering gathering(list, rest, tolerances, 1.0, 0.0);
        for (const double gap : gaps) {
            gathering.add(contact_at(gap));
        }
        std::ranges::sort(gaps);
        gaps.resize(std::min(gaps.size(), std::size_t{ContactList::capacity}));
        ASSERT_EQ(gaps_of(list), gaps) << count;
        if (gathering.is_full()) {
            ASSERT_EQ(gathering.limit(), rest + gaps.back() - tolerances.same);
        }
    }
}

// What is ahead comes in any order, and what is within reach in between. A search that reads the limit takes
// in all that counts.
TEST(ContactGathering, OfWhatIsAheadTheFewNearestAreWithinTheLimit) {
    constexpr double ahead = 1e-3;
    RandomValues random(7);
    for (int round = 0; round < 200; ++round) {
        ContactList list;
        ContactGathering gathering(list, rest, tolerances, 0.0, ahead);
        std::vector<double> near, farther;
        for (int i = random.below(40); i > 0; --i) {
            const bool is_near = random.below(3) == 0;
            const double gap =
                is_near ? random.between(0.0, tolerances.reach) : random.between(2e-6, 0.9 * ahead);
            Contact contact = contact_at(gap);
            contact.state = random.below(4) == 0 ? ContactState::covered : ContactState::seen;
            if (rest + gap <= gathering.limit()) {
                gathering.heed(rest + gap);
                gathering.add(contact);
            }
            if (!is_near && contact.state != ContactState::covered) {
                farther.push_back(gap);
            }
        }
        std::ranges::sort(farther);
        const double expected = farther.size() < 4 ? tolerances.reach + ahead : farther[3];
        ASSERT_NEAR(gathering.limit(), rest + expected, 1e-12);
        gathering.heed(rest - 1e-9);
        ASSERT_NEAR(gathering.limit(), rest + expected, 1e-12);
    }
}

TEST(ContactGathering, TellsWhichAreAsFar) {
    RandomValues random(5);
    for (int round = 0; round < 200; ++round) {
        ContactList list;
        ContactGathering gathering(list, rest, tolerances, 1.0, 0.0);
        for (const double gap : some_gaps(random, 1 + random.below(200))) {
            gathering.add(contact_at(gap));
        }
        gathering.shorten(random.below(list.count));
        for (const double gap : some_gaps(random, random.below(9))) {
            gathering.add(contact_at(gap));
        }
        const double gap = random.between(-0.1, 1.0), same = random.magnitude(1e-4, 0.3);
        std::vector<const Contact*> expected, visited;
        for (const Contact& contact : list.all()) {
            if (contact.gap - gap <= same && contact.gap - gap >= -same) {
                expected.push_back(&contact);
            }
        }
        gathering.visit_as_far(gap, same, [&](const Contact& contact) { visited.push_back(&contact); });
        ASSERT_EQ(visited, expected);
    }
}

}  // namespace tactus::contact_gathering_test
