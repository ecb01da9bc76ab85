#include "platform/this_thread.hpp"

#include <pthread.h>
#include <sched.h>
#include <sys/resource.h>
#include <unistd.h>

#include <string>

namespace tactus {

void name_this_thread(const char* name) {
    pthread_setname_np(pthread_self(), std::string(name).substr(0, 15).c_str());
}

void work_in_background() {
    constexpr int behind_frames = 10;  // nice value; Linux: of this thread alone
    setpriority(PRIO_PROCESS, 0, behind_frames);
}

void keep_off_last_processor(bool keeps_off) {
    cpu_set_t processors;  // of the first thread: this one's may have been narrowed before
    if (sched_getaffinity(getpid(), sizeof(processors), &processors) != 0) {
        return;
    }
    if (keeps_off && CPU_COUNT(&processors) > 1) {
        std::size_t last = CPU_SETSIZE - 1;
        while (!CPU_ISSET(last, &processors)) {
            --last;
        }
        CPU_CLR(last, &processors);
    }
    sched_setaffinity(0, sizeof(processors), &processors);
}

}  // namespace tactus
