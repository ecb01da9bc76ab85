#include "sensing/watch/lasting_thread.hpp"

#include <condition_variable>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace tactus {

class LastingThread::Worker {
public:
    void give(std::function<void()> work) {
        {
            const std::lock_guard lock(mutex_);
            work_ = std::move(work);
        }
        changes_.notify_all();
    }

    void wait() {
        std::unique_lock lock(mutex_);
        changes_.wait(lock, [this] { return !work_; });
    }

    void run() {
        std::unique_lock lock(mutex_);
        while (true) {
            changes_.wait(lock, [this] { return static_cast<bool>(work_); });
            lock.unlock();
            work_();
            lock.lock();
            work_ = nullptr;
            changes_.notify_all();
        }
    }

private:
    std::mutex mutex_;
    std::condition_variable changes_;
    std::function<void()> work_;  // none: it waits for some
};

// Never destroyed: its threads are there until the program has gone.
struct LastingThread::Idle {
    std::mutex mutex;
    std::vector<Worker*> workers;

    static Idle& all() {
        static Idle& idle = *new Idle;
        return idle;
    }
    Worker* take() {
        const std::lock_guard lock(mutex);
        if (workers.empty()) {
            return nullptr;
        }
        Worker* const worker = workers.back();
        workers.pop_back();
        return worker;
    }
    void give_back(Worker* worker) {
        const std::lock_guard lock(mutex);
        workers.push_back(worker);
    }
};

LastingThread::LastingThread(std::function<void()> work) : worker_(Idle::all().take()) {
    if (worker_ == nullptr) {
        auto worker = std::make_unique<Worker>();
        std::thread([begun = worker.get()] { begun->run(); }).detach();
        worker_ = worker.release();
    }
    worker_->give(std::move(work));
}

void LastingThread::join() {
    worker_->wait();
    Idle::all().give_back(worker_);
}

}  // namespace tactus
