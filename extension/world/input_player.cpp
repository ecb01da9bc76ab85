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
    OpenFile rows;
    if (!csv.empty()) {
        make_folder_of(csv);
        rows.reset(open_file(csv, "wb"));
        if (rows == nullptr) {
            error = "'" + csv + "' cannot be written: choose a folder that exists and may be written to";
            return nullptr;
        }
    }
    return std::unique_ptr<InputPlayer>(new InputPlayer(std::move(file), std::move(rows), csv));
}

InputPlayer::InputPlayer(OpenFile inputs, OpenFile csv, const std::string& csv_path)
    : inputs_(std::move(inputs)),
      csv_(std::move(csv)),
      csv_path_(csv_path),
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
    if (csv_ != nullptr && (std::fwrite(text_.data(), 1, text_.size(), csv_.get()) != text_.size() ||
                            std::fflush(csv_.get()) != 0)) {
        rows_problem_ = "'" + csv_path_ + "' could not be written to its end: is the disk full?";
        csv_.reset();
    }
    text_.clear();
}

}  // namespace tactus
