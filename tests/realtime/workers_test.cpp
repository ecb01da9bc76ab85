#include "realtime/workers.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <future>
#include <numeric>
#include <thread>

#include "platform/atomic_wait.hpp"

namespace tactus::workers_test {

namespace {

TEST(Workers, JobsAreDoneByTheEndOfWait) {
    Workers workers;
    std::atomic<int> done{0};
    for (int i = 0; i < 50; ++i) {
        workers.add([&done] { ++done; });
    }
    workers.wait();
    EXPECT_EQ(done, 50);
}

TEST(Workers, ATaskIsCalledOnceForEachNumberAlsoFromInsideAJob) {
    Workers workers;
    std::vector<std::atomic<int>> calls(1000);
    workers.add([&] {
        const ParallelRunner run = workers.runner();
        run(calls.size(), [&calls](std::size_t i) { ++calls[i]; });
    });
    workers.wait();
    for (const std::atomic<int>& count : calls) {
        EXPECT_EQ(count, 1);
    }
}

// What a job owns may take long to destroy: that is done by its thread as well.
TEST(Workers, WhatAJobOwnsGoesWithItOnItsThread) {
    struct Owned {
        explicit Owned(std::thread::id* place) : destroyed_on(place) {}
        ~Owned() { *destroyed_on = std::this_thread::get_id(); }
        std::thread::id* destroyed_on;
    };
    Workers workers;
    std::thread::id on;
    workers.add([owned = std::make_shared<Owned>(&on)] {});
    workers.wait();
    EXPECT_NE(on, std::thread::id());
    EXPECT_NE(on, std::this_thread::get_id());
}

TEST(Workers, WhatIsForLaterGivesWayToWhatIsAddedMeanwhile) {
    Workers workers;
    std::promise<void> begun;
    std::atomic<int> tasks{0}, jobs{0}, at_once{0}, most_at_once{0};
    std::atomic<bool> goes_on{false};
    for (int i = 0; i < 3; ++i) {
        workers.add_later([&, i] {
            most_at_once = std::max<int>(most_at_once, ++at_once);
            if (i == 0) {
                begun.set_value();
                wait_while(goes_on, false);
            }
            workers.runner_later()(100, [&](std::size_t) { ++tasks; });
            --at_once;
        });
    }
    begun.get_future().wait();
    std::promise<void> done;
    if (std::thread::hardware_concurrency() > 1) {
        workers.add([&] { done.set_value(); });
        done.get_future().wait();
    }
    for (int i = 0; i < 10; ++i) {
        workers.add([&] { ++jobs; });
    }
    goes_on = true;
    wake_all(goes_on);
    workers.wait();
    EXPECT_EQ(jobs, 10);
    EXPECT_EQ(tasks, 300);
    EXPECT_EQ(most_at_once, 1);
}

// With no threads there is nobody to wait for, and nothing is kept.
TEST(Workers, WhatIsFreedAsideIsFreedAtOnceWhereNoThreadRuns) {
    struct Counted {
        explicit Counted(int* count) : freed(count) {}
        Counted(Counted&& other) noexcept : freed(std::exchange(other.freed, nullptr)) {}
        ~Counted() {
            if (freed != nullptr) {
                ++*freed;
            }
        }
        int* freed;
    };
    int freed = 0;
    Workers::freed_aside(Counted(&freed)).reset();
    EXPECT_EQ(freed, 1);
    Workers::shared().add([] {});
    std::shared_ptr<Counted> kept = Workers::freed_aside(Counted(&freed));
    kept.reset();
    Workers::end_shared();
    EXPECT_EQ(freed, 2);
}

// No more wait than are allowed, whatever keeps the threads busy.
TEST(Workers, WhatIsDiscardedFasterThanItIsDestroyedIsDestroyedAtOnce) {
    std::promise<void> busy;
    const std::shared_future<void> until = busy.get_future();
    for (unsigned i = 0; i < std::max(std::thread::hardware_concurrency(), 1u); ++i) {
        Workers::shared().add([until] { until.wait(); });
    }
    BoundedDiscard discard(2);
    std::atomic<int> destroyed{0};
    for (int i = 0; i < 5; ++i) {
        discard([&destroyed] { ++destroyed; });
    }
    EXPECT_EQ(destroyed, 3);
    busy.set_value();
    Workers::shared().wait();
    EXPECT_EQ(destroyed, 5);
    discard([&destroyed] { ++destroyed; });
    Workers::end_shared();
    EXPECT_EQ(destroyed, 6);
}

}  // namespace

}  // namespace tactus::workers_test
