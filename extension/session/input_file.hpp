// A recording of a session's inputs as a file: a head, then pieces, each with its length and the hash of what
// is in it. So a file that was cut short, or of which bits have flipped, is whole up to some piece, and says
// where.
//
// Any thread, but the haptic one.
#pragma once

#include <cstdint>
#include <cstdio>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace tactus {

enum class InputPiece : std::uint32_t {
    settings = 1,  // of the session: the first one
    calls = 2,     // InputCall after InputCall
    ticks = 3,     // HeardInput after HeardInput
    end = 4,       // how many ticks found no room: the last one
};

// False where it could not be written.
bool write_input_head(std::FILE* file);
bool write_input_piece(std::FILE* file, InputPiece kind, std::span<const std::byte> content);

class InputFileReader {
public:
    // At the beginning of the file, which stays the caller's.
    explicit InputFileReader(std::FILE* file);

    // Empty, or why nothing more of it is to be had. A file that has come to its end says nothing.
    const std::string& problem() const { return problem_; }

    // The next piece; false where there is none.
    bool next();
    InputPiece kind() const { return kind_; }
    std::span<const std::byte> content() const { return content_; }

private:
    bool read(void* into, std::size_t size);

    std::FILE* file_;
    std::uint64_t left_ = 0;  // bytes of the file
    std::uint64_t number_ = 0;
    InputPiece kind_ = InputPiece::end;
    std::vector<std::byte> content_;
    std::string problem_;
};

}  // namespace tactus
