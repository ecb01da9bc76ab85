#include "sensing/openni/recording_check.hpp"

#include <array>
#include <cstdint>
#include <cstring>

#include "platform/mapped_file.hpp"

namespace tactus {

namespace {

constexpr std::size_t file_header = 24;
constexpr std::uint32_t record_magic = 0x0052494e;

enum RecordType : std::uint32_t {
    type_first = 0x02,
    type_new_data = 0x0a,
    type_end = 0x0b,
    type_node_added = 0x0d,
    type_last = 0x0e,
};

struct Record {
    std::uint32_t magic = 0, type = 0, node = 0, fields = 0, payload = 0;
};

template <class Value>
Value read(std::span<const std::byte> file, std::size_t at) {
    Value value{};
    std::memcpy(&value, file.data() + at, sizeof value);
    return value;
}

// Records of the versions before 1.0.1.0 hold positions in half the bytes.
std::size_t record_header(std::span<const std::byte> file) {
    const auto major = read<std::uint8_t>(file, 4);
    const auto minor = read<std::uint8_t>(file, 5);
    const auto maintenance = read<std::uint16_t>(file, 6);
    return std::array<unsigned, 3>{major, minor, maintenance} < std::array<unsigned, 3>{1, 0, 1} ? 24 : 28;
}

// Of a node that was added: its name, which the player takes as it stands, ends inside.
bool is_name_whole(std::span<const std::byte> file, std::size_t fields, std::size_t bytes) {
    if (bytes < sizeof(std::uint32_t)) {
        return false;
    }
    const auto length = read<std::uint32_t>(file, fields);
    return length > 0 && length <= bytes - sizeof(std::uint32_t) &&
           file[fields + sizeof(std::uint32_t) + length - 1] == std::byte{0};
}

}  // namespace

std::string check_recording(std::span<const std::byte> file) {
    if (file.size() < file_header || std::memcmp(file.data(), "NI10", 4) != 0) {
        return "it is not a recording by OpenNI2";
    }
    const std::size_t header = record_header(file);
    std::size_t frames = 0;
    for (std::size_t at = file_header;;) {
        const std::string place = "after " + std::to_string(frames) + " images";
        if (file.size() - at < header) {
            return "it is cut off " + place;
        }
        const auto record = read<Record>(file, at);
        const std::uint64_t bytes = std::uint64_t{record.fields} + record.payload;
        if (record.magic != record_magic || record.fields < header || record.type < type_first ||
            record.type > type_last ||
            (record.type == type_node_added && bytes <= file.size() - at &&
             !is_name_whole(file, at + header, record.fields - header))) {
            return "it is damaged " + place;
        }
        if (bytes > file.size() - at) {
            return "it is cut off " + place;
        }
        frames += record.type == type_new_data ? 1 : 0;
        if (record.type == type_end) {
            return frames > 0 ? "" : "it holds no images";
        }
        at += static_cast<std::size_t>(bytes);
    }
}

std::string check_recording(const std::string& path) {
    MappedFile file;
    const std::string error = file.open(path);
    return error.empty() ? check_recording(file.bytes()) : error;
}

}  // namespace tactus
