#pragma once

namespace tactus {

// One pointer of each thread's own, null at first. Unlike thread_local, which may allocate when a thread
// first asks for it, this never does. It belongs to physics/loop_memory.cpp.
void* thread_slot();
void set_thread_slot(void* value);

}  // namespace tactus
