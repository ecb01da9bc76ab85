#include "realtime/workers.hpp"

#include <algorithm>
#include <atomic>

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
};

Workers::~Workers() {
    {
        const std::lock_guard lock(mutex_);
        jobs_.clear();
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

void Workers::add(std::function<void()> job) {
    TACTUS_ASSERT_NOT_HAPTIC_THREAD();
    if (threads_.empty()) {
        start();
    }
    {
        const std::lock_guard lock(mutex_);
        jobs_.push_back(std::move(job));
    }
    news_.notify_one();
}

// Help for a job that is under way comes before the next job: what was asked for first is ready first.
void Workers::work() {
    work_in_background();  // a frame of the scene comes first
    std::unique_lock lock(mutex_);
    while (true) {
        news_.wait(lock, [this] { return ending_ || !batches_.empty() || !jobs_.empty(); });
        if (!batches_.empty()) {
            const std::shared_ptr<Batch> batch = batches_.front();
            lock.unlock();
            take_part(*batch);
            lock.lock();
            std::erase(batches_, batch);
        } else if (!jobs_.empty()) {
            std::function<void()> job = std::move(jobs_.front());
            jobs_.pop_front();
            ++working_;
            lock.unlock();
            job();
            job = nullptr;  // what it owns goes while nobody waits
            lock.lock();
            if (--working_ == 0 && jobs_.empty()) {
                all_done_.notify_all();
            }
        } else {
            return;
        }
    }
}

// A batch that has ended hands out no task: its function is not called then.
void Workers::take_part(Batch& batch) {
    for (std::size_t i = batch.next.fetch_add(1); i < batch.count; i = batch.next.fetch_add(1)) {
        batch.task(i);
        if (batch.done.fetch_add(1, std::memory_order_acq_rel) + 1 == batch.count) {
            batch.done.notify_all();
        }
    }
}

void Workers::run(std::size_t count, const std::function<void(std::size_t)>& task) {
    TACTUS_ASSERT_NOT_HAPTIC_THREAD();
    if (count < 2) {
        run_serially(count, task);
        return;
    }
    const auto batch = std::make_shared<Batch>(count, task);
    {
        const std::lock_guard lock(mutex_);
        batches_.push_back(batch);
    }
    news_.notify_all();
    take_part(*batch);
    for (std::size_t done = batch->done.load(); done < count; done = batch->done.load()) {
        batch->done.wait(done);
    }
    const std::lock_guard lock(mutex_);
    std::erase(batches_, batch);
}

ParallelRunner Workers::runner() {
    return [this](std::size_t count, const std::function<void(std::size_t)>& task) { run(count, task); };
}

void Workers::wait() {
    TACTUS_ASSERT_NOT_HAPTIC_THREAD();
    std::unique_lock lock(mutex_);
    all_done_.wait(lock, [this] { return working_ == 0 && jobs_.empty(); });
}

}  // namespace tactus
