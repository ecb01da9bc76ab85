#include "world/input_player.hpp"

#include <utility>

#include "session/record_csv.hpp"

namespace tactus {

std::unique_ptr<InputPlayer> InputPlayer::open(const std::string& inputs, const std::string& csv,
                                               std::string& error) {
    OpenFile file(open_file(inputs, "rb"));
    if (file == nullptr) {
        error = "'" + inputs + "' cannot be read: name the 'inputs.tactus' of a bundle";
        return nullptr;
    }
    if (is_same_file(inputs, csv)) {
        error = "'" + csv + "' is the recording itself: choose another path for the rows";
        return nullptr;
    }
    std::unique_ptr<InputPlayer> player(new InputPlayer(std::move(file)));
    error = csv.empty() ? "" : player->csv_.open(csv);
    return error.empty() ? std::move(player) : nullptr;
}

InputPlayer::InputPlayer(OpenFile inputs)
    : inputs_(std::move(inputs)),
      text_(record_csv_header()),
      replay_(inputs_.get(),
              [this](const SessionRecord& row, Nanoseconds epoch) { append_record_csv(text_, row, epoch); }) {
}

bool InputPlayer::play(std::uint64_t ticks) {
    const bool has_more = replay_.play(ticks);
    write_rows();
    return has_more;
}

void InputPlayer::write_rows() {
    if (csv_ && (std::fwrite(text_.data(), 1, text_.size(), csv_.get()) != text_.size() ||
                 std::fflush(csv_.get()) != 0)) {
        rows_problem_ = csv_.cut_short();
        csv_.close();
    }
    text_.clear();
}

}  // namespace tactus
