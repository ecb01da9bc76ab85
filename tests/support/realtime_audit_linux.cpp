#include <dlfcn.h>
#include <execinfo.h>
#include <link.h>
#include <malloc.h>
#include <pthread.h>
#include <semaphore.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "support/realtime_audit_system.hpp"

namespace tactus::testing {

namespace {

thread_local AuditScope* watching = nullptr;  // the scope of this thread
thread_local char syscall_selector = 0;       // read by the kernel: let system calls pass, or intercept them

constexpr char let_pass = 0;   // SYSCALL_DISPATCH_FILTER_ALLOW
constexpr char intercept = 1;  // SYSCALL_DISPATCH_FILTER_BLOCK

}  // namespace

}  // namespace tactus::testing

using tactus::testing::Recorder;

// What stands in front of the C library has to be seen by the other libraries too, however the rest is
// compiled.
#pragma GCC visibility push(default)

// --- Memory ---

#if TACTUS_SANITIZE_ADDRESS || TACTUS_SANITIZE_THREAD

// These stand in front of the C library themselves and say what passes through them; from behind a malloc of
// our own they would see nothing.
extern "C" int __sanitizer_install_malloc_and_free_hooks(void (*after_malloc)(const volatile void*,
                                                                              std::size_t),
                                                         void (*before_free)(const volatile void*));

namespace {

void watch_memory() {
    static const int hooks = __sanitizer_install_malloc_and_free_hooks(
        [](const volatile void*, std::size_t) { Recorder::allocation(); },
        [](const volatile void*) { Recorder::release(); });
    if (hooks == 0) {
        std::abort();
    }
}

}  // namespace

#else

namespace {

void watch_memory() {}

}  // namespace

extern "C" {

void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* block, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
void __libc_free(void* block);

void* malloc(std::size_t size) noexcept {
    Recorder::allocation();
    return __libc_malloc(size);
}

void* calloc(std::size_t count, std::size_t size) noexcept {
    Recorder::allocation();
    return __libc_calloc(count, size);
}

void* realloc(void* block, std::size_t size) noexcept {
    Recorder::allocation();
    if (block != nullptr) {
        Recorder::release();
    }
    return __libc_realloc(block, size);
}

void* memalign(std::size_t alignment, std::size_t size) noexcept {
    Recorder::allocation();
    return __libc_memalign(alignment, size);
}

void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
    Recorder::allocation();
    return __libc_memalign(alignment, size);
}

int posix_memalign(void** block, std::size_t alignment, std::size_t size) noexcept {
    Recorder::allocation();
    const bool power_of_two = alignment != 0 && (alignment & (alignment - 1)) == 0;
    if (!power_of_two || alignment % sizeof(void*) != 0) {
        return EINVAL;
    }
    void* const memory = __libc_memalign(alignment, size);
    if (memory == nullptr) {
        return ENOMEM;
    }
    *block = memory;
    return 0;
}

void free(void* block) noexcept {
    if (block != nullptr) {
        Recorder::release();
    }
    __libc_free(block);
}

}  // extern "C"

#endif

// --- Locks and waits ---

namespace {

// The C library's own function behind one that stands in front of it here.
template <typename Function>
Function* next(const char* name, std::atomic<void*>& known) {
    void* function = known.load(std::memory_order_relaxed);
    if (function == nullptr) {
        const tactus::testing::Unwatched unwatched;
        function = dlsym(RTLD_NEXT, name);
        known.store(function, std::memory_order_relaxed);
    }
    return reinterpret_cast<Function*>(function);
}

}  // namespace

#if TACTUS_SANITIZE_THREAD

// Its hooks say nothing of these.
extern "C" {

void* memalign(std::size_t alignment, std::size_t size) noexcept {
    static std::atomic<void*> known{nullptr};
    Recorder::allocation();
    return next<void*(std::size_t, std::size_t)>("memalign", known)(alignment, size);
}

void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
    static std::atomic<void*> known{nullptr};
    Recorder::allocation();
    return next<void*(std::size_t, std::size_t)>("aligned_alloc", known)(alignment, size);
}

int posix_memalign(void** block, std::size_t alignment, std::size_t size) noexcept {
    static std::atomic<void*> known{nullptr};
    Recorder::allocation();
    return next<int(void**, std::size_t, std::size_t)>("posix_memalign", known)(block, alignment, size);
}

}  // extern "C"

#endif

#define TACTUS_INTERPOSE(name, parameters, arguments, report) \
    extern "C" int name parameters noexcept {                 \
        static std::atomic<void*> known{nullptr};             \
        report;                                               \
        return next<int parameters>(#name, known) arguments;  \
    }

#define TACTUS_INTERPOSE_CANCELLABLE(name, parameters, arguments, report) \
    extern "C" int name parameters {                                      \
        static std::atomic<void*> known{nullptr};                         \
        report;                                                           \
        return next<int parameters>(#name, known) arguments;              \
    }

TACTUS_INTERPOSE(pthread_mutex_lock, (pthread_mutex_t * m), (m), Recorder::lock(m))
TACTUS_INTERPOSE(pthread_mutex_trylock, (pthread_mutex_t * m), (m), Recorder::lock(m))
TACTUS_INTERPOSE(pthread_mutex_timedlock, (pthread_mutex_t * m, const timespec* t), (m, t), Recorder::lock(m))
TACTUS_INTERPOSE(pthread_mutex_clocklock, (pthread_mutex_t * m, clockid_t c, const timespec* t), (m, c, t),
                 Recorder::lock(m))
TACTUS_INTERPOSE(pthread_rwlock_rdlock, (pthread_rwlock_t * l), (l), Recorder::lock(l))
TACTUS_INTERPOSE(pthread_rwlock_wrlock, (pthread_rwlock_t * l), (l), Recorder::lock(l))
TACTUS_INTERPOSE(pthread_rwlock_tryrdlock, (pthread_rwlock_t * l), (l), Recorder::lock(l))
TACTUS_INTERPOSE(pthread_rwlock_trywrlock, (pthread_rwlock_t * l), (l), Recorder::lock(l))
TACTUS_INTERPOSE(pthread_spin_lock, (pthread_spinlock_t * l), (l), Recorder::lock(const_cast<const int*>(l)))
TACTUS_INTERPOSE(pthread_barrier_wait, (pthread_barrier_t * b), (b), Recorder::wait())
TACTUS_INTERPOSE_CANCELLABLE(pthread_cond_wait, (pthread_cond_t * c, pthread_mutex_t* m), (c, m),
                             Recorder::wait())
TACTUS_INTERPOSE_CANCELLABLE(pthread_cond_timedwait,
                             (pthread_cond_t * c, pthread_mutex_t* m, const timespec* t), (c, m, t),
                             Recorder::wait())
TACTUS_INTERPOSE_CANCELLABLE(pthread_cond_clockwait,
                             (pthread_cond_t * c, pthread_mutex_t* m, clockid_t k, const timespec* t),
                             (c, m, k, t), Recorder::wait())
TACTUS_INTERPOSE_CANCELLABLE(pthread_join, (pthread_t t, void** r), (t, r), Recorder::wait())
TACTUS_INTERPOSE_CANCELLABLE(sem_wait, (sem_t * s), (s), Recorder::wait())
TACTUS_INTERPOSE_CANCELLABLE(sem_timedwait, (sem_t * s, const timespec* t), (s, t), Recorder::wait())
TACTUS_INTERPOSE(sem_trywait, (sem_t * s), (s), Recorder::wait())

#pragma GCC visibility pop

// --- System calls ---
//
// Syscall user dispatch: while the selector says so, the kernel turns every system call of the thread into a
// SIGSYS. The handler counts it and makes it after all. Calls from within the code between the two labels
// below are exempt: the one that the handler makes, and the return from the handler.

#if defined(__x86_64__)

asm(R"(
    .text
    .globl tactus_audit_exempt_begin
tactus_audit_exempt_begin:
    .globl tactus_audit_system_call
tactus_audit_system_call:
    mov %rdi, %rax
    mov %rsi, %rdi
    mov %rdx, %rsi
    mov %rcx, %rdx
    mov %r8, %r10
    mov %r9, %r8
    mov 8(%rsp), %r9
    syscall
    ret
    .globl tactus_audit_return
tactus_audit_return:
    mov $15, %eax
    syscall
    nop
    .globl tactus_audit_exempt_end
tactus_audit_exempt_end:
)");

extern "C" {
extern const char tactus_audit_exempt_begin[];
extern const char tactus_audit_exempt_end[];
void tactus_audit_return();
long tactus_audit_system_call(long number, long a, long b, long c, long d, long e, long f);
}

namespace tactus::testing {

namespace {

// What the kernel's rt_sigaction takes; the C library's own would put its own return behind the handler.
struct KernelSignalAction {
    void (*handler)(int, siginfo_t*, void*);
    unsigned long flags;
    void (*restorer)();
    std::uint64_t mask;
};
constexpr unsigned long with_restorer = 0x04000000;  // SA_RESTORER

// They return at once whatever the rest of the machine does.
bool never_blocks(long number) {
    switch (number) {
        case SYS_clock_gettime:
        case SYS_gettimeofday:
        case SYS_getcpu:
        case SYS_getpid:
        case SYS_gettid:
            return true;
        default:
            return false;
    }
}

// They come back on another stack, and have to be made where they stand.
bool changes_stack(long number) {
    return number == SYS_clone || number == SYS_clone3 || number == SYS_vfork;
}

// Where the sanitizers' own code stands: what they ask of the kernel for themselves is nobody's offence. What
// they pass on is made from within the C library.
struct CodeRange {
    std::uintptr_t begin = 0, end = 0;
};
std::array<CodeRange, 4> sanitizer_code{};

int note_sanitizer(dl_phdr_info* library, std::size_t, void* count) {
    const std::string_view name(library->dlpi_name);
    auto& known = *static_cast<std::size_t*>(count);
    if (name.find("libtsan") == name.npos && name.find("libasan") == name.npos &&
        name.find("libubsan") == name.npos) {
        return 0;
    }
    for (int i = 0; i < library->dlpi_phnum; ++i) {
        const auto& segment = library->dlpi_phdr[i];
        if (segment.p_type == PT_LOAD && (segment.p_flags & PF_X) != 0 && known < sanitizer_code.size()) {
            const std::uintptr_t begin = library->dlpi_addr + segment.p_vaddr;
            sanitizer_code[known++] = {begin, begin + segment.p_memsz};
        }
    }
    return 0;
}

bool is_sanitizer(const void* address) {
    const auto at = reinterpret_cast<std::uintptr_t>(address);
    return std::ranges::any_of(sanitizer_code,
                               [&](const CodeRange& code) { return at >= code.begin && at < code.end; });
}

void on_system_call(int, siginfo_t* info, void* context) {
    syscall_selector = let_pass;
    auto& registers = static_cast<ucontext_t*>(context)->uc_mcontext.gregs;
    const long number = info->si_syscall;
    if (!never_blocks(number) && !is_sanitizer(info->si_call_addr)) {
        Recorder::system_call(number);
    }
    if (changes_stack(
            number)) {  // once more, unintercepted, as is the rest of the scope: it has failed by now
        constexpr long syscall_instruction_bytes = 2;
        registers[REG_RIP] -= syscall_instruction_bytes;
        registers[REG_RAX] = number;
        return;
    }
    registers[REG_RAX] =
        tactus_audit_system_call(number, registers[REG_RDI], registers[REG_RSI], registers[REG_RDX],
                                 registers[REG_R10], registers[REG_R8], registers[REG_R9]);
    syscall_selector = intercept;
}

bool install_handler() {
    std::size_t known = 0;
    dl_iterate_phdr(&note_sanitizer, &known);
    KernelSignalAction action{&on_system_call, SA_SIGINFO | SA_NODEFER | with_restorer, &tactus_audit_return,
                              0};
    return syscall(SYS_rt_sigaction, SIGSYS, &action, nullptr, sizeof(action.mask)) == 0;
}

bool start_interception() {
    static const bool handler_stands = install_handler();
    constexpr int set_syscall_user_dispatch = 59;  // PR_SET_SYSCALL_USER_DISPATCH, PR_SYS_DISPATCH_ON = 1
    return handler_stands &&
           prctl(set_syscall_user_dispatch, 1, tactus_audit_exempt_begin,
                 tactus_audit_exempt_end - tactus_audit_exempt_begin, &syscall_selector) == 0;
}

}  // namespace

}  // namespace tactus::testing

#else

namespace tactus::testing {
namespace {
bool start_interception() {
    return false;
}
}  // namespace
}  // namespace tactus::testing

#endif

namespace tactus::testing {

bool AuditScope::is_sleep(long number) {
    return number == SYS_clock_nanosleep;
}

bool AuditScope::watches_system_calls() {
    static thread_local const bool watches = start_interception();
    return watches;
}

Watch watch() {
    return {watching, syscall_selector == intercept};
}

void set_watch(Watch wanted) {
    syscall_selector = let_pass;
    watching = wanted.scope;
    syscall_selector = wanted.system_calls ? intercept : let_pass;
}

// backtrace() loads a library when it is first called.
void prepare_audit() {
    void* frame = nullptr;
    backtrace(&frame, 1);
    watch_memory();
}

std::uintptr_t thread_number() {
    return static_cast<std::uintptr_t>(pthread_self());
}

int back_trace(void** frames, int most) {
    return backtrace(frames, most);
}

std::string names_of(void* const* frames, int count) {
    std::string text;
    char** const symbols = backtrace_symbols(frames, count);
    for (int frame = 0; symbols != nullptr && frame < count; ++frame) {
        text += std::string("\n  ") + symbols[frame];
    }
    std::free(symbols);
    return text;
}

}  // namespace tactus::testing
