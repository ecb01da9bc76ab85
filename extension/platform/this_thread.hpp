// What a thread asks for itself.
#pragma once

namespace tactus {

// For debuggers and lists of threads: at most 15 characters are shown.
void name_this_thread(const char* name);

// Gives way to ordinary threads where there are fewer processors than threads.
void work_in_background();

}  // namespace tactus
