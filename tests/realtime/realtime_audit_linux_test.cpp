// The audit has to see every kind of offence, or its silence would prove nothing.
#include "support/realtime_audit.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <malloc.h>
#include <pthread.h>
#include <semaphore.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <shared_mutex>
#include <thread>
#include <vector>

#include "platform/clock.hpp"

namespace tactus::testing {
namespace {

// Keeps the compiler from removing what only the audit is interested in.
void keep(const void* pointer) {
    asm volatile("" : : "r"(pointer) : "memory");
}

template <typename Code>
AuditCounts audited(Code&& code) {
    AuditScope audit;
    code();
    audit.finish();
    return audit.counts();
}

TEST(RealtimeAudit, PlainArithmeticIsClean) {
    std::array<double, 64> values{};
    const AuditCounts counts = audited([&] {
        for (double& value : values) {
            value = value * 2.0 + 1.0;
        }
        keep(values.data());
    });
    EXPECT_EQ(counts.allocations, 0u);
    EXPECT_EQ(counts.frees, 0u);
    EXPECT_EQ(counts.locks, 0u);
    EXPECT_EQ(counts.waits, 0u);
    EXPECT_EQ(counts.system_calls, 0u);
}

TEST(RealtimeAudit, SeesMallocAndFree) {
    const AuditCounts counts = audited([] {
        void* block = std::malloc(10);
        keep(block);
        std::free(block);
    });
    EXPECT_EQ(counts.allocations, 1u);
    EXPECT_EQ(counts.frees, 1u);
}

TEST(RealtimeAudit, SeesCalloc) {
    void* block = nullptr;
    EXPECT_EQ(audited([&] { keep(block = std::calloc(3, 5)); }).allocations, 1u);
    std::free(block);
}

TEST(RealtimeAudit, SeesRealloc) {
    void* block = std::malloc(8);
    const AuditCounts counts = audited([&] { keep(block = std::realloc(block, 800)); });
    EXPECT_EQ(counts.allocations, 1u);
    EXPECT_EQ(counts.frees, 1u);
    std::free(block);
}

TEST(RealtimeAudit, SeesAlignedAllocations) {
    std::array<void*, 3> blocks{};
    const AuditCounts counts = audited([&] {
        blocks[0] = std::aligned_alloc(64, 128);
        blocks[1] = memalign(64, 128);
        if (posix_memalign(&blocks[2], 64, 128) != 0) {
            std::abort();
        }
    });
    EXPECT_EQ(counts.allocations, 3u);
    for (void* block : blocks) {
        EXPECT_EQ(reinterpret_cast<std::uintptr_t>(block) % 64, 0u);
        std::free(block);
    }
}

TEST(RealtimeAudit, SeesOperatorNewAndDelete) {
    struct alignas(64) Wide {
        char bytes[64];
    };
    const AuditCounts counts = audited([] {
        const auto narrow = std::make_unique<int>(1);
        keep(narrow.get());
        const auto wide = std::make_unique<Wide>();
        keep(wide.get());
        std::vector<int> numbers(100);
        keep(numbers.data());
    });
    EXPECT_EQ(counts.allocations, 3u);
    EXPECT_EQ(counts.frees, 3u);
}

TEST(RealtimeAudit, SeesAnUncontendedMutex) {
    std::mutex mutex;
    const AuditCounts counts = audited([&] { const std::lock_guard guard(mutex); });
    EXPECT_EQ(counts.locks, 1u);
}

TEST(RealtimeAudit, SeesATriedMutex) {
    std::mutex mutex;
    mutex.lock();
    std::thread([&] { EXPECT_EQ(audited([&] { (void)mutex.try_lock(); }).locks, 1u); }).join();
    mutex.unlock();
}

TEST(RealtimeAudit, SeesReadWriteLocks) {
    std::shared_mutex mutex;
    const AuditCounts counts = audited([&] {
        mutex.lock();
        mutex.unlock();
        mutex.lock_shared();
        mutex.unlock_shared();
    });
    EXPECT_EQ(counts.locks, 2u);
}

TEST(RealtimeAudit, SeesAConditionVariable) {
    std::mutex mutex;
    std::condition_variable never;
    const AuditCounts counts = audited([&] {
        std::unique_lock lock(mutex);
        never.wait_for(lock, std::chrono::microseconds(1));
    });
    EXPECT_EQ(counts.waits, 1u);
}

TEST(RealtimeAudit, SeesASemaphore) {
    sem_t semaphore;
    sem_init(&semaphore, 0, 1);
    EXPECT_EQ(audited([&] { sem_wait(&semaphore); }).waits, 1u);
    sem_destroy(&semaphore);
}

TEST(RealtimeAudit, SeesAJoin) {
    std::thread other([] {});
    EXPECT_EQ(audited([&] { other.join(); }).waits, 1u);
}

class SystemCallAudit : public ::testing::Test {
protected:
    void SetUp() override {
        if (!AuditScope::watches_system_calls()) {
            GTEST_SKIP() << "this kernel cannot intercept system calls";
        }
    }

    static long first_call_of(const AuditScope& audit) {
        const std::vector<long> numbers = audit.system_call_numbers();
        return numbers.empty() ? -1 : numbers.front();
    }
};

TEST_F(SystemCallAudit, SeesASleep) {
    AuditScope audit;
    const timespec moment{0, 1};
    clock_nanosleep(CLOCK_MONOTONIC, 0, &moment, nullptr);
    audit.finish();
    EXPECT_EQ(audit.system_calls(), 1u);
    EXPECT_EQ(first_call_of(audit), SYS_clock_nanosleep);
}

TEST_F(SystemCallAudit, SeesAFutexBehindAnAtomic) {
    std::atomic<int> value{0};
    AuditScope audit;
    syscall(SYS_futex, &value, 0 /* FUTEX_WAIT */, 1, nullptr, nullptr, 0);
    audit.finish();
    EXPECT_EQ(first_call_of(audit), SYS_futex);
}

TEST_F(SystemCallAudit, SeesMappingMemory) {
    AuditScope audit;
    void* block = mmap(nullptr, 4096, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    munmap(block, 4096);
    audit.finish();
    EXPECT_EQ(audit.system_call_numbers(), (std::vector<long>{SYS_mmap, SYS_munmap}));
}

TEST_F(SystemCallAudit, SeesMovingTheBreak) {
    AuditScope audit;
    keep(sbrk(4096));
    audit.finish();
    EXPECT_EQ(first_call_of(audit), SYS_brk);
}

TEST_F(SystemCallAudit, SeesALogLineAndLetsItThrough) {
    std::array<int, 2> ends{};
    ASSERT_EQ(pipe(ends.data()), 0);
    std::FILE* log = fdopen(ends[1], "w");
    std::setvbuf(log, nullptr, _IONBF, 0);
    AuditScope audit;
    std::fputs("hot", log);
    audit.finish();
    EXPECT_EQ(first_call_of(audit), SYS_write);

    std::array<char, 3> arrived{};
    EXPECT_EQ(read(ends[0], arrived.data(), arrived.size()), 3);
    EXPECT_EQ(std::string(arrived.data(), arrived.size()), "hot");
    std::fclose(log);
    close(ends[0]);
}

TEST_F(SystemCallAudit, SeesAThreadBeingStarted) {
    AuditScope audit;
    std::thread other([] {});
    audit.finish();
    other.join();
    EXPECT_GT(audit.allocations(), 0u);
    EXPECT_GT(audit.system_calls(), 0u);
}

TEST_F(SystemCallAudit, ReadingTheClockIsAllowed) {
    AuditScope audit;
    const Nanoseconds now = monotonic_now();
    syscall(SYS_clock_gettime, CLOCK_MONOTONIC, nullptr);
    audit.finish();
    EXPECT_GT(now, 0);
    EXPECT_EQ(audit.system_calls(), 0u);
}

TEST(RealtimeAudit, OtherThreadsAreNotThisScopesBusiness) {
    std::atomic<bool> go{false};
    std::atomic<bool> done{false};
    std::thread other([&] {
        while (!go) {
        }
        void* block = std::malloc(100);
        keep(block);
        std::free(block);
        done = true;
    });
    AuditScope audit;
    go = true;
    while (!done) {
    }
    audit.finish();
    other.join();
    EXPECT_EQ(audit.allocations(), 0u);
}

TEST(RealtimeAudit, NothingCountsAfterTheEnd) {
    AuditScope audit;
    audit.finish();
    void* block = std::malloc(10);
    keep(block);
    std::free(block);
    EXPECT_EQ(audit.allocations(), 0u);
}

TEST(RealtimeAudit, DescribesWhereTheFirstOffenceCameFrom) {
    AuditScope audit;
    void* block = std::malloc(10);
    keep(block);
    audit.finish();
    std::free(block);
    EXPECT_EQ(audit.describe().find("1 allocations, 0 frees"), 0u);
    EXPECT_NE(audit.describe().find('\n'), std::string::npos);
}

TEST(LockAudit, NamesALockThatBothSidesTake) {
    std::mutex contested;
    std::mutex own;
    const LockAudit audit;
    {
        const AuditScope scope;
        const std::lock_guard one(contested);
        const std::lock_guard two(own);
    }
    std::thread([&] { const std::lock_guard guard(contested); }).join();
    EXPECT_EQ(audit.locks_in_scopes(), 2u);
    EXPECT_EQ(audit.shared_locks(), std::vector<const void*>{&contested});
}

TEST(LockAudit, TheOrderDoesNotMatter) {
    std::mutex contested;
    const LockAudit audit;
    std::thread([&] { const std::lock_guard guard(contested); }).join();
    {
        const AuditScope scope;
        const std::lock_guard guard(contested);
    }
    EXPECT_EQ(audit.shared_locks(), std::vector<const void*>{&contested});
}

TEST(LockAudit, TwoThreadsOutsideAnyScopeMayShareALock) {
    std::mutex ordinary;
    const LockAudit audit;
    {
        const std::lock_guard guard(ordinary);
    }
    std::thread([&] { const std::lock_guard guard(ordinary); }).join();
    EXPECT_TRUE(audit.shared_locks().empty());
}

}  // namespace
}  // namespace tactus::testing
