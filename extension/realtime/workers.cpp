#include "realtime/workers.hpp"

#include <algorithm>
#include <atomic>

#include "platform/atomic_wait.hpp"
#include "platform/this_thread.hpp"
#include "realtime/thread_role.hpp"

namespace tactus {

struct Workers::Batch {
    Batch(std::size_t tasks, const std::function<void(std::size_t)>& function)
        : count(tasks), task(function) {}
    const std::size_t count;
    const std::function<void(std::size_t)>& task;  // lives until all are done
    std::atomic<std::size_t> next{0};
    std::atomic<std::size_t> done{0};
    std::atomic<bool> all_done{false};
};

Workers::~Workers() {
    {
        const std::lock_guard lock(mutex_);
        jobs_.clear();
        later_jobs_.clear();
        ending_ = true;
    }
    news_.notify_all();
    for (std::thread& thread : threads_) {
        thread.join();
    }
}

std::unique_ptr<Workers>& Workers::instance() {
    static std::unique_ptr<Workers> workers;
    return workers;
}

Workers& Workers::shared() {
    if (instance() == nullptr) {
        instance() = std::make_unique<Workers>();
    }
    return *instance();
}

void Workers::end_shared() {
    if (const std::unique_ptr<Workers> last = std::move(instance())) {
        last->wait();
    }
}

void Workers::discard(std::function<void()> destroy) {
    Workers* const workers = instance().get();
    if (workers != nullptr && !workers->threads_.empty()) {
        workers->add(std::move(destroy));
    } else {
        destroy();
    }
}

void BoundedDiscard::operator()(std::function<void()> destroy) {
    if (waiting_->load(std::memory_order_acquire) >= max_waiting_) {
        destroy();
        return;
    }
    waiting_->fetch_add(1, std::memory_order_relaxed);
    Workers::discard([waiting = waiting_, destroy = std::move(destroy)] {
        destroy();
        waiting->fetch_sub(1, std::memory_order_release);
    });
}

void Workers::start() {
    const unsigned processors = std::thread::hardware_concurrency();
    for (unsigned i = 0; i < std::max(processors, 1u); ++i) {
        threads_.emplace_back([this] { work(); });
    }
}

void Workers::add_to(Jobs& jobs, std::function<void()> job) {
    TACTUS_ASSERT_NOT_HAPTIC_THREAD();
    if (threads_.empty()) {
        start();
    }
    {
        const std::lock_guard lock(mutex_);
        jobs.push_back(std::move(job));
    }
    news_.notify_one();
}

void Workers::do_job(std::unique_lock<std::mutex>& lock, Jobs& jobs) {
    std::function<void()> job = std::move(jobs.front());
    jobs.pop_front();
    ++working_;
    lock.unlock();
    job();
    job = nullptr;  // what it owns goes while nobody waits
    lock.lock();
    --working_;
}

// Help for a job that is under way comes before the next job: what was asked for first is ready first.
void Workers::work() {
    work_in_background();  // a frame of the scene comes first
    std::unique_lock lock(mutex_);
    while (true) {
        news_.wait(lock, [this] {
            return ending_ || !batches_.empty() || !jobs_.empty() || !later_batches_.empty() ||
                   has_later_job();
        });
        if (!batches_.empty()) {
            const std::shared_ptr<Batch> batch = batches_.front();
            lock.unlock();
            take_part(*batch);
            lock.lock();
            std::erase(batches_, batch);
        } else if (!jobs_.empty()) {
            do_job(lock, jobs_);
        } else if (!later_batches_.empty()) {
            const std::shared_ptr<Batch> batch = later_batches_.front();
            lock.unlock();
            const bool has_more = take_task(*batch);
            lock.lock();
            if (!has_more) {
                std::erase(later_batches_, batch);
            }
        } else if (has_later_job()) {
            is_later_under_way_ = true;
            do_job(lock, later_jobs_);
            is_later_under_way_ = false;
        } else {
            return;
        }
        if (is_idle()) {
            all_done_.notify_all();
        }
    }
}

// A batch that has ended hands out no task: its function is not called then.
bool Workers::take_task(Batch& batch) {
    const std::size_t i = batch.next.fetch_add(1);
    if (i >= batch.count) {
        return false;
    }
    batch.task(i);
    if (batch.done.fetch_add(1, std::memory_order_acq_rel) + 1 == batch.count) {
        batch.all_done.store(true, std::memory_order_release);
        wake_all(batch.all_done);
    }
    return true;
}

void Workers::take_part(Batch& batch) {
    while (take_task(batch)) {
    }
}

void Workers::run(std::size_t count, const std::function<void(std::size_t)>& task, Batches& among) {
    TACTUS_ASSERT_NOT_HAPTIC_THREAD();
    if (count < 2) {
        run_serially(count, task);
        return;
    }
    const auto batch = std::make_shared<Batch>(count, task);
    {
        const std::lock_guard lock(mutex_);
        among.push_back(batch);
    }
    news_.notify_all();
    take_part(*batch);
    wait_while(batch->all_done, false);
    const std::lock_guard lock(mutex_);
    std::erase(among, batch);
}

ParallelRunner Workers::runner() {
    return [this](std::size_t count, const std::function<void(std::size_t)>& task) {
        run(count, task, batches_);
    };
}

ParallelRunner Workers::runner_later() {
    return [this](std::size_t count, const std::function<void(std::size_t)>& task) {
        run(count, task, later_batches_);
    };
}

void Workers::wait() {
    TACTUS_ASSERT_NOT_HAPTIC_THREAD();
    std::unique_lock lock(mutex_);
    all_done_.wait(lock, [this] { return is_idle(); });
}

}  // namespace tactus
