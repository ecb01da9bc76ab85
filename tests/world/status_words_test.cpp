#include "world/status_words.hpp"

#include <gtest/gtest.h>

#include "session/session_types.hpp"

namespace tactus::status_words_test {
namespace {

TEST(StatusWords, NothingIsSaidOfNothing) {
    EXPECT_EQ(status_words(0), "");
}

TEST(StatusWords, EveryBitOfASessionAndOfTheLoopHasWords) {
    for (const TickStatus bit :
         {TickStatus{session_step_pairs_full}, TickStatus{session_step_contacts_full},
          TickStatus{session_step_memory_full}, TickStatus{session_full}, TickStatus{session_force_limited},
          TickStatus{session_proxy_unfinished}, TickStatus{session_record_lost},
          TickStatus{session_body_lost}, TickStatus{session_commands_waiting}, TickStatus{tick_late},
          TickStatus{tick_rebased}}) {
        EXPECT_NE(status_words(bit), "") << bit;
    }
}

TEST(StatusWords, SeveralAreSaidOneAfterTheOther) {
    EXPECT_EQ(status_words(session_record_lost | tick_late),
              status_words(session_record_lost) + "; " + status_words(tick_late));
}

}  // namespace
}  // namespace tactus::status_words_test
