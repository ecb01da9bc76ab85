// What the audit sees on every system.
#include "support/realtime_audit.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <mutex>
#include <thread>
#include <vector>

namespace tactus::testing {
namespace {

TEST(AuditEverywhere, SeesWhatCppAllocatesAndFrees) {
    AuditScope audit;
    {
        const std::vector<double> values(100, 1.0);
        asm volatile("" : : "r"(values.data()) : "memory");
    }
    audit.finish();
    EXPECT_EQ(audit.allocations(), 1u) << audit.describe();
    EXPECT_EQ(audit.frees(), 1u);
}

TEST(AuditEverywhere, SeesAlignedMemory) {
    struct alignas(64) Wide {
        double values[8];
    };
    AuditScope audit;
    {
        const auto wide = std::make_unique<Wide>();
        asm volatile("" : : "r"(wide.get()) : "memory");
    }
    audit.finish();
    EXPECT_EQ(audit.allocations(), 1u);
    EXPECT_EQ(audit.frees(), 1u);
}

TEST(AuditEverywhere, SeesALockAndWhetherItIsShared) {
    std::mutex own, shared;
    const LockAudit locks;
    std::thread([&shared] { const std::lock_guard guard(shared); }).join();
    AuditScope audit;
    {
        const std::lock_guard first(own);
        const std::lock_guard second(shared);
    }
    audit.finish();
    EXPECT_EQ(audit.locks(), 2u) << audit.describe();
    EXPECT_EQ(locks.shared_locks().size(), 1u);
}

TEST(AuditEverywhere, AClosedScopeCountsNothing) {
    AuditScope audit;
    audit.finish();
    const auto value = std::make_unique<int>(1);
    asm volatile("" : : "r"(value.get()) : "memory");
    EXPECT_EQ(audit.allocations(), 0u);
}

}  // namespace
}  // namespace tactus::testing
