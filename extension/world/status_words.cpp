#include "world/status_words.hpp"

#include "session/session_types.hpp"

namespace tactus {

namespace {

struct StatusWord {
    TickStatus bit;
    const char* text;
};

constexpr StatusWord words[] = {
    {session_step_pairs_full, "too many bodies near each other at once: some contacts were lost"},
    {session_step_contacts_full, "too many contacts at once: some were lost"},
    {session_step_memory_full, "the physics step needed more memory than it had set aside"},
    {session_full, "a body, device or proxy found no place: raise max_bodies or remove some"},
    {session_force_limited, "a force was longer than its device's limit and was shortened"},
    {session_proxy_unfinished, "a proxy needed more than one tick to find its place"},
    {session_record_lost, "a recorder could not keep up"},
    {session_body_lost, "a body left the range of numbers: it was put back where it was, asleep"},
    {session_commands_waiting, "many changes at once: they take effect over several ticks"},
    {tick_late, "a tick ended after the next one was due"},
    {tick_rebased, "the program stood still for so long that the schedule was moved"},
};

}  // namespace

std::string status_words(TickStatus status) {
    std::string text;
    for (const StatusWord& word : words) {
        if ((status & word.bit) != 0) {
            text += (text.empty() ? "" : "; ") + std::string(word.text);
        }
    }
    return text;
}

}  // namespace tactus
