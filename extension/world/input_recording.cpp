#include "world/input_recording.hpp"

#include <utility>

namespace tactus {

std::unique_ptr<InputRecording> InputRecording::open(const std::string& path, const SessionSettings& settings,
                                                     const Say& say) {
    std::unique_ptr<InputRecording> recording(new InputRecording(say));
    if (const std::string problem = recording->file_.open(path); !problem.empty()) {
        say(problem);
        return nullptr;
    }
    ByteSink sink;
    ValueWriter writer(sink);
    pass(writer, settings);
    if (!write_input_head(recording->file_.get())) {
        recording->end_short();
    }
    recording->write(InputPiece::settings, sink.bytes());
    return recording;
}

// What could not be written to its end is played up to there.
void InputRecording::write(InputPiece kind, std::vector<std::byte>& content) {
    if (file_ && !content.empty() && !write_input_piece(file_.get(), kind, content)) {
        end_short();
    }
    content.clear();
}

void InputRecording::end_short() {
    say_(file_.cut_short());
    file_.close();
}

void InputRecording::drain(Nanoseconds epoch) {
    if (std::exchange(epoch_, epoch) != epoch) {
        recorder_.note(call::Epoch{epoch});
    }
    recorder_.drain(calls_, ticks_);
    write(InputPiece::calls, calls_);
    write(InputPiece::ticks, ticks_);
    if (lost_ticks() > 0 && !std::exchange(has_said_lost_, true)) {
        say_("the recording of inputs ends here: the program stood still for too long");
    }
}

void InputRecording::close() {
    drain(epoch_);
    const std::uint64_t lost = lost_ticks();
    ByteSink sink;
    ValueWriter writer(sink);
    pass(writer, lost);
    write(InputPiece::end, sink.bytes());
    if (const std::string problem = file_.close(); !problem.empty()) {
        say_(problem);
    }
}

}  // namespace tactus
