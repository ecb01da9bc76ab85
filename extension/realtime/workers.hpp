// Threads for what takes longer than a frame: they take jobs in the order given and help each other inside
// one. All worlds share them: a job owns what it works on, so that nobody has to wait for it.
//
// Threads: add() belongs to the main thread; runner()'s result may be called by anybody, also from inside a
// job. None of them may be the haptic thread. They start with the first job.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "core/tree/parallel.hpp"

namespace tactus {

class Workers {
public:
    Workers() = default;
    // What has not begun never will; waits for what has.
    ~Workers();
    Workers(const Workers&) = delete;
    Workers& operator=(const Workers&) = delete;

    void add(std::function<void()> job) { add_to(jobs_, std::move(job)); }
    // What nobody waits for: begun when nothing else is to be done, one after the other, so that with two
    // threads there is always one for what is added meanwhile. It uses runner_later().
    void add_later(std::function<void()> job) { add_to(later_jobs_, std::move(job)); }

    // Those of the program; they end with end_shared().
    static Workers& shared();
    static void end_shared();

    // Has it destroyed here, where that may take as long as it likes.
    template <class Value>
    static std::shared_ptr<Value> freed_aside(Value value) {
        return std::shared_ptr<Value>(new Value(std::move(value)),
                                      [](Value* gone) { discard([gone] { delete gone; }); });
    }
    // Called by one of the threads, or at once where there are none.
    static void discard(std::function<void()> destroy);

    // Calls tasks on the caller's thread and on those that have nothing to do.
    ParallelRunner runner();
    // The same from inside of what was added for later: help ends as soon as anything else is to be done.
    ParallelRunner runner_later();

    // Returns when all jobs are done.
    void wait();

private:
    struct Batch;

    void start();
    void work();
    using Jobs = std::deque<std::function<void()>>;
    using Batches = std::deque<std::shared_ptr<Batch>>;
    void run(std::size_t count, const std::function<void(std::size_t)>& task, Batches& among);
    void add_to(Jobs& jobs, std::function<void()> job);
    void do_job(std::unique_lock<std::mutex>& lock, Jobs& jobs);
    bool has_later_job() const { return !later_jobs_.empty() && !is_later_under_way_; }
    bool is_idle() const { return working_ == 0 && jobs_.empty() && later_jobs_.empty(); }
    static bool take_task(Batch& batch);
    static void take_part(Batch& batch);

    static std::unique_ptr<Workers>& instance();

    std::vector<std::thread> threads_;
    std::mutex mutex_;  // of all below
    std::condition_variable news_;
    std::condition_variable all_done_;
    Jobs jobs_, later_jobs_;
    Batches batches_, later_batches_;  // that may still have tasks to give
    std::size_t working_ = 0;          // on a job
    bool is_later_under_way_ = false;  // on one of later_jobs_
    bool ending_ = false;
};

// Discards what is large: where it is discarded faster than the threads destroy it (they give way to all
// that is ordinary, and may get no time), it is destroyed by who discards it.
//
// Threads: any one but the haptic thread, one at a time.
class BoundedDiscard {
public:
    explicit BoundedDiscard(int max_waiting) : max_waiting_(max_waiting) {}
    void operator()(std::function<void()> destroy);

private:
    const int max_waiting_;
    std::shared_ptr<std::atomic<int>> waiting_ = std::make_shared<std::atomic<int>>(0);
};

}  // namespace tactus
