#include "world/input_recording.hpp"

#include <utility>

namespace tactus {

std::unique_ptr<InputRecording> InputRecording::open(const std::string& path, const SessionSettings& settings,
                                                     const Say& say) {
    make_folder_of(path);
    OpenFile file(open_file(path, "wb"));
    if (file == nullptr) {
        say("'" + path + "' cannot be written: choose a folder that exists and may be written to");
        return nullptr;
    }
    std::unique_ptr<InputRecording> recording(new InputRecording(path, std::move(file), say));
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
    if (file_ != nullptr && !content.empty() && !write_input_piece(file_.get(), kind, content)) {
        end_short();
    }
    content.clear();
}

void InputRecording::end_short() {
    file_.reset();
    say_("'" + path_ + "' could not be written to its end: is the disk full?");
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
    // What the system still holds is written now, or never.
    if (file_ != nullptr && std::fclose(file_.release()) != 0) {
        end_short();
    }
}

}  // namespace tactus
