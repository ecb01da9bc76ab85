// The inputs of a running world, written to a file as they come: input_replay.hpp plays them again.
//
// Threads: all belongs to the session's owner, but for the recorder's half that is the loop's.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "session/input_file.hpp"
#include "session/input_recorder.hpp"
#include "world/written_file.hpp"

namespace tactus {

class InputRecording {
public:
    // Hears what goes wrong, each with what to do.
    using Say = std::function<void(const std::string&)>;

    // Makes the folder. Null where the file cannot be written.
    static std::unique_ptr<InputRecording> open(const std::string& path, const SessionSettings& settings,
                                                const Say& say);
    ~InputRecording() { close(); }
    InputRecording(const InputRecording&) = delete;
    InputRecording& operator=(const InputRecording&) = delete;

    InputRecorder& recorder() { return recorder_; }

    // `epoch`: the zero of the session's clock, since 1970.
    void drain(Nanoseconds epoch);
    // The file is complete. Nothing ticks any more.
    void close();

    std::uint64_t lost_ticks() const { return recorder_.lost_ticks(); }

private:
    explicit InputRecording(const Say& say) : say_(say) {}
    void write(InputPiece kind, std::vector<std::byte>& content);
    void end_short();

    WrittenFile file_;  // none: closed, or the disk is full
    Say say_;
    InputRecorder recorder_;
    std::vector<std::byte> calls_, ticks_;
    Nanoseconds epoch_ = 0;
    bool has_said_lost_ = false;
};

}  // namespace tactus
