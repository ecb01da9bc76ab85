#include <algorithm>
#include <atomic>
#include <cstdlib>

#include "support/realtime_audit_system.hpp"

namespace tactus::testing {

namespace {

// Open addressing, never emptied but as a whole: an address stays where it was put. Writers from any thread.
class LockTable {
public:
    // Notes that `thread` took `lock`, inside a scope or not.
    void note(const void* lock, std::uintptr_t thread, bool in_scope) {
        Entry* entry = find_or_insert(reinterpret_cast<std::uintptr_t>(lock));
        if (entry == nullptr) {
            overflow_.store(true);
            return;
        }
        std::uintptr_t nobody = 0;
        if (!entry->first_thread.compare_exchange_strong(nobody, thread) && nobody != thread) {
            entry->by_several.store(true);
        }
        if (in_scope) {
            entry->in_scope.store(true);
        }
    }

    void clear() {
        for (Entry& entry : entries_) {
            entry.lock.store(0);
            entry.first_thread.store(0);
            entry.by_several.store(false);
            entry.in_scope.store(false);
        }
        overflow_.store(false);
    }

    std::vector<const void*> taken_in_scope(bool and_by_another_thread) const {
        std::vector<const void*> locks;
        for (const Entry& entry : entries_) {
            if (entry.in_scope.load() && (entry.by_several.load() || !and_by_another_thread)) {
                locks.push_back(reinterpret_cast<const void*>(entry.lock.load()));
            }
        }
        return locks;
    }

    bool overflowed() const { return overflow_.load(); }

private:
    struct Entry {
        std::atomic<std::uintptr_t> lock{0};
        std::atomic<std::uintptr_t> first_thread{0};
        std::atomic<bool> by_several{false};
        std::atomic<bool> in_scope{false};
    };

    Entry* find_or_insert(std::uintptr_t lock) {
        const std::size_t home = (lock >> 3) * 0x9E3779B97F4A7C15u >> 50;
        for (std::size_t probe = 0; probe < entries_.size(); ++probe) {
            Entry& entry = entries_[(home + probe) % entries_.size()];
            std::uintptr_t found = 0;
            if (entry.lock.compare_exchange_strong(found, lock) || found == lock) {
                return &entry;
            }
        }
        return nullptr;
    }

    std::array<Entry, 1u << 14> entries_;
    std::atomic<bool> overflow_{false};
};

LockTable lock_table;
std::atomic<bool> lock_audit_runs{false};

}  // namespace

void Recorder::count(std::size_t AuditCounts::* figure) {
    AuditScope* const scope = watch().scope;
    if (scope == nullptr) {
        return;
    }
    ++(scope->counts_.*figure);
    if (scope->first_offence_frames_ == 0) {
        const Unwatched unwatched;
        scope->first_offence_frames_ = back_trace(scope->first_offence_.data(), AuditScope::max_frames);
    }
}

void Recorder::lock(const void* address) {
    if (lock_audit_runs.load(std::memory_order_relaxed)) {
        lock_table.note(address, thread_number(), watch().scope != nullptr);
    }
    count(&AuditCounts::locks);
}

void Recorder::system_call(long number) {
    AuditScope* const scope = watch().scope;
    if (scope == nullptr) {
        return;
    }
    if (scope->counts_.system_calls < AuditScope::max_numbers) {
        scope->numbers_[scope->counts_.system_calls] = number;
    }
    count(&AuditCounts::system_calls);
}

AuditScope::AuditScope() {
    prepare_audit();
    if (watch().scope != nullptr) {
        std::abort();
    }
    set_watch({this, watches_system_calls()});
}

void AuditScope::finish() {
    if (watching_) {
        set_watch({});
        watching_ = false;
    }
}

std::vector<long> AuditScope::system_call_numbers() const {
    const Unwatched unwatched;
    const std::size_t kept = std::min(counts_.system_calls, max_numbers);
    return {numbers_.begin(), numbers_.begin() + static_cast<std::ptrdiff_t>(kept)};
}

std::string AuditScope::describe() const {
    const Unwatched unwatched;
    std::string text = std::to_string(counts_.allocations) + " allocations, " +
                       std::to_string(counts_.frees) + " frees, " + std::to_string(counts_.locks) +
                       " locks, " + std::to_string(counts_.waits) + " waits, " +
                       std::to_string(counts_.system_calls) + " system calls";
    for (const long number : system_call_numbers()) {
        text += " " + std::to_string(number);
    }
    return text + names_of(first_offence_.data(), first_offence_frames_);
}

LockAudit::LockAudit() {
    lock_table.clear();
    lock_audit_runs.store(true);
}

LockAudit::~LockAudit() {
    lock_audit_runs.store(false);
}

std::vector<const void*> LockAudit::shared_locks() const {
    if (lock_table.overflowed()) {
        std::abort();
    }
    return lock_table.taken_in_scope(true);
}

std::size_t LockAudit::locks_in_scopes() const {
    return lock_table.taken_in_scope(false).size();
}

}  // namespace tactus::testing
