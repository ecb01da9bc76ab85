#include "session/input_file.hpp"

#include <array>
#include <string_view>

#include "core/math/bit_hash.hpp"
#include "session/input_records.hpp"

namespace tactus {

namespace {

constexpr std::string_view magic = "tactus inputs 2\n";

struct PieceHead {
    InputPiece kind;
    std::uint32_t check;  // of the others
    std::uint64_t size;
    ContentHash hash;
};
static_assert(sizeof(PieceHead) == 32);

std::uint32_t check_of(const PieceHead& head) {
    BitHash hash;
    hash.add(static_cast<std::uint64_t>(head.kind));
    hash.add(head.size);
    for (const auto& byte : head.hash) {
        hash.add(static_cast<std::uint64_t>(byte));
    }
    return static_cast<std::uint32_t>(hash.value());
}

// How long the values of every kind are when they are empty: another number where something has got another
// member, so that nobody takes one layout for another.
template <typename... Kinds>
void add_lengths(BitHash& hash, const std::variant<Kinds...>*) {
    struct Length {
        std::uint64_t bytes = 0;
        bool append(const void*, std::size_t size) {
            bytes += size;
            return true;
        }
    };
    const auto length_of = [](const auto& value) {
        Length length;
        ValueWriter writer(length);
        pass(writer, value);
        return length.bytes;
    };
    (hash.add(length_of(Kinds{})), ...);
}

std::uint64_t layout() {
    BitHash hash;
    add_lengths(hash, static_cast<const InputCall*>(nullptr));
    add_lengths(hash, static_cast<const HeardInput*>(nullptr));
    add_lengths(hash, static_cast<const std::variant<SessionSettings, SidePlan>*>(nullptr));
    return hash.value();
}

}  // namespace

bool write_input_head(std::FILE* file) {
    const std::uint64_t known = layout();
    return std::fwrite(magic.data(), 1, magic.size(), file) == magic.size() &&
           std::fwrite(&known, sizeof known, 1, file) == 1;
}

bool write_input_piece(std::FILE* file, InputPiece kind, std::span<const std::byte> content) {
    PieceHead head{kind, 0, content.size(), content_hash(content)};
    head.check = check_of(head);
    return std::fwrite(&head, sizeof head, 1, file) == 1 &&
           std::fwrite(content.data(), 1, content.size(), file) == content.size();
}

InputFileReader::InputFileReader(std::FILE* file) : file_(file) {
    std::fseek(file_, 0, SEEK_END);
    const long size = std::ftell(file_);
    std::rewind(file_);
    left_ = size > 0 ? static_cast<std::uint64_t>(size) : 0;
    std::array<char, magic.size()> first{};
    std::uint64_t known = 0;
    if (!read(first.data(), first.size()) || std::string_view(first.data(), first.size()) != magic) {
        problem_ = "it is no recording of inputs: name the file 'inputs.tactus' of a bundle";
    } else if (!read(&known, sizeof known) || known != layout()) {
        problem_ = "another version of Tactus has recorded it: play it with that one";
    }
}

bool InputFileReader::read(void* into, std::size_t size) {
    if (size > left_ || std::fread(into, 1, size, file_) != size) {
        return false;
    }
    left_ -= size;
    return true;
}

bool InputFileReader::next() {
    if (!problem_.empty() || (number_ > 0 && kind_ == InputPiece::end)) {
        return false;
    }
    ++number_;
    PieceHead head{};
    if (!read(&head, sizeof head) || head.size > left_) {
        problem_ = "it is cut short after piece " + std::to_string(number_ - 1);
        return false;
    }
    kind_ = head.kind;
    content_.resize(head.size);
    if (head.check != check_of(head) || !read(content_.data(), content_.size()) ||
        content_hash(content_) != head.hash) {
        problem_ = "piece " + std::to_string(number_) + " of it is damaged";
        return false;
    }
    return true;
}

}  // namespace tactus
