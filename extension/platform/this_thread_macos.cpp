#include "platform/this_thread.hpp"

#include <pthread.h>
#include <pthread/qos.h>

namespace tactus {

void name_this_thread(const char* name) {
    pthread_setname_np(name);
}

void work_in_background() {
    pthread_set_qos_class_self_np(QOS_CLASS_UTILITY, 0);
}

void keep_off_last_processor(bool) {}

}  // namespace tactus
