// Does what takes a while for a thread that must not wait, one after the other, at ordinary priority.
//
// Threads: construction and destruction belong to the owner, add() to one other thread. The destructor waits
// for the job that is being done and drops the rest.
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>

namespace tactus {

class JobThread {
public:
    JobThread() : thread_([this] { run(); }) {}
    ~JobThread() {
        {
            const std::lock_guard lock(mutex_);
            ends_ = true;
        }
        wakes_.notify_one();
        thread_.join();
    }
    JobThread(const JobThread&) = delete;
    JobThread& operator=(const JobThread&) = delete;

    void add(std::function<void()> job) {
        {
            const std::lock_guard lock(mutex_);
            jobs_.push_back(std::move(job));
        }
        wakes_.notify_one();
    }

private:
    void run() {
        std::unique_lock lock(mutex_);
        while (!ends_) {
            if (jobs_.empty()) {
                wakes_.wait(lock);
                continue;
            }
            const std::function<void()> job = std::move(jobs_.front());
            jobs_.pop_front();
            lock.unlock();
            job();
            lock.lock();
        }
    }

    std::mutex mutex_;
    std::condition_variable wakes_;
    std::deque<std::function<void()>> jobs_;
    bool ends_ = false;
    std::thread thread_;
};

}  // namespace tactus
