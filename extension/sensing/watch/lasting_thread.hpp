// A thread that is kept for the next one who needs it.
//
// OpenNI2 (2.2) notes each thread that has ever waited for an image, and when another one does asks of all of
// them whether they still are, by pthread_kill(): of a thread that has ended, whose stack has gone, that is
// a read of nothing. So no thread that waits for images ever ends: there are as many as sensors have been
// open at once.
#pragma once

#include <functional>

namespace tactus {

class LastingThread {
public:
    // Throws std::system_error where there is no thread for it.
    explicit LastingThread(std::function<void()> work);
    LastingThread(const LastingThread&) = delete;
    LastingThread& operator=(const LastingThread&) = delete;
    // Waits for the end of the work: once, before this goes.
    void join();

private:
    class Worker;
    struct Idle;

    Worker* worker_;
};

}  // namespace tactus
