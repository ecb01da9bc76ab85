// Proves that a piece of code is fit for the haptic thread: that it allocates nothing, waits for nobody and
// makes no blocking system call. What is linked into the test program with it stands in front of the C
// library's functions.
//
//     AuditScope audit;
//     session.tick(now);
//     EXPECT_EQ(audit.allocations(), 0u) << audit.describe();
//
// A scope watches the thread that made it, from construction to the end of the block or finish(). One at a
// time per thread. Watched: malloc and its family (what operator new, mmap and brk rest on), free, pthread
// locks (what std::mutex, std::shared_mutex rest on), condition variables, semaphores, joins, and every
// system call of the thread, whoever makes it, where the kernel can intercept them (Linux ≥ 5.11 on x86-64).
// On Windows: what the program itself and the libraries that are linked into it allocate, free and lock; its
// system calls are not seen.
// Under the address and the thread sanitizer the same is watched: memory through their hooks, and what they
// ask of the kernel for themselves does not count.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace tactus::testing {

struct AuditCounts {
    std::size_t allocations = 0;   // malloc, calloc, realloc, aligned_alloc, posix_memalign, memalign …
    std::size_t frees = 0;         // free and realloc of what is not null
    std::size_t locks = 0;         // mutexes and read-write locks, tried or taken, contended or not
    std::size_t waits = 0;         // condition variables, semaphores, joins, barriers
    std::size_t system_calls = 0;  // but for those that only ask for the time or for an own number
};

class AuditScope {
public:
    AuditScope();
    ~AuditScope() { finish(); }
    AuditScope(const AuditScope&) = delete;
    AuditScope& operator=(const AuditScope&) = delete;

    // Stops watching; the figures stay. Must happen in the thread that made the scope.
    void finish();

    const AuditCounts& counts() const { return counts_; }
    std::size_t allocations() const { return counts_.allocations; }
    std::size_t frees() const { return counts_.frees; }
    std::size_t locks() const { return counts_.locks; }
    std::size_t waits() const { return counts_.waits; }
    std::size_t system_calls() const { return counts_.system_calls; }

    // The numbers (SYS_…) of the first system calls, in their order.
    std::vector<long> system_call_numbers() const;

    // What happened, and from where the first offence came: addresses for addr2line. Call it after finish()
    // or as the message of a failed expectation.
    std::string describe() const;

    // Whether that is the number of the call by which a loop sleeps until its next tick.
    static bool is_sleep(long number);

    // Whether this kernel lets system calls be intercepted; where it does not, system_calls() stays 0.
    static bool watches_system_calls();

private:
    friend struct Recorder;

    static constexpr std::size_t max_numbers = 32;
    static constexpr int max_frames = 24;

    AuditCounts counts_;
    std::array<long, max_numbers> numbers_{};
    std::array<void*, max_frames> first_offence_{};
    int first_offence_frames_ = 0;
    bool watching_ = true;
};

// Which locks the code in AuditScopes takes and other code takes as well. A lock in both sets is one that the
// haptic thread might have to wait for. From construction to destruction, one at a time in a program.
class LockAudit {
public:
    LockAudit();
    ~LockAudit();
    LockAudit(const LockAudit&) = delete;
    LockAudit& operator=(const LockAudit&) = delete;

    // Addresses of the locks taken inside a scope by one thread and, at any time during this audit, by
    // another one.
    std::vector<const void*> shared_locks() const;

    // How many locks were taken inside scopes.
    std::size_t locks_in_scopes() const;
};

}  // namespace tactus::testing
