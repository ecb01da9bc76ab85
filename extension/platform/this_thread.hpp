// What a thread asks for itself.
#pragma once

namespace tactus {

// For debuggers and lists of threads: at most 15 characters are shown.
void name_this_thread(const char* name);

// Gives way to ordinary threads where there are fewer processors than threads.
void work_in_background();

// Leaves the last of the processors that the process may use, which loops prefer (last_processor), or takes
// it back. Without effect where there is one alone, and on macOS, which places threads by itself.
void keep_off_last_processor(bool keeps_off);

}  // namespace tactus
