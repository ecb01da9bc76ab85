// A file of recorded inputs (input_recording.hpp), played; the rows that were written down then are written
// again.
//
// Any one thread, but the haptic one.
#pragma once

#include <memory>
#include <string>

#include "platform/file.hpp"
#include "session/input_replay.hpp"
#include "world/written_file.hpp"

namespace tactus {

class InputPlayer {
public:
    // `csv`: where the rows go; empty: nowhere. Null where a file cannot be opened, or where the rows would
    // replace the recording, and `error` says why.
    static std::unique_ptr<InputPlayer> open(const std::string& inputs, const std::string& csv,
                                             std::string& error);

    // False where there are no more ticks. Then the rows are written to their end.
    bool play(std::uint64_t ticks);
    const InputReplay::Report& report() const { return replay_.report(); }
    // Why the rows are not all in their file; empty where they are.
    const std::string& rows_problem() const { return rows_problem_; }
    Nanoseconds now() const { return replay_.now(); }
    Session* session() { return replay_.session(); }

private:
    explicit InputPlayer(OpenFile inputs);
    void write_rows();

    OpenFile inputs_;
    WrittenFile csv_;
    std::string text_, rows_problem_;
    InputReplay replay_;
};

}  // namespace tactus
