#include "platform/this_thread.hpp"

#include <pthread.h>
#include <sys/resource.h>

#include <string>

namespace tactus {

void name_this_thread(const char* name) {
    pthread_setname_np(pthread_self(), std::string(name).substr(0, 15).c_str());
}

void work_in_background() {
    constexpr int behind_frames = 10;  // nice value; Linux: of this thread alone
    setpriority(PRIO_PROCESS, 0, behind_frames);
}

}  // namespace tactus
