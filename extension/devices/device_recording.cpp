#include "devices/device_recording.hpp"

#include <array>
#include <charconv>
#include <cinttypes>
#include <optional>
#include <string_view>

namespace tactus {

namespace {

constexpr std::string_view header = "tactus device recording 1";

// std::from_chars and std::to_chars know no locale: the file reads the same everywhere.
void append_number(std::string& line, double value) {
    std::array<char, 40> digits{};
    const auto result =
        std::to_chars(digits.data(), digits.data() + digits.size(), value, std::chars_format::hex);
    line.append(digits.data(), result.ptr);
    line.push_back(' ');
}

std::string to_line(const DeviceSample& sample) {
    std::string line;
    for (const Vec3& vector : {sample.position, sample.velocity}) {
        append_number(line, vector.x);
        append_number(line, vector.y);
        append_number(line, vector.z);
    }
    append_number(line, sample.rotation.w);
    append_number(line, sample.rotation.x);
    append_number(line, sample.rotation.y);
    append_number(line, sample.rotation.z);
    line += std::to_string(sample.buttons) + (sample.connected ? " 1\n" : " 0\n");
    return line;
}

std::string_view next_word(std::string_view& rest) {
    const std::size_t begin = std::min(rest.find_first_not_of(' '), rest.size());
    const std::size_t end = std::min(rest.find(' ', begin), rest.size());
    const std::string_view word = rest.substr(begin, end - begin);
    rest.remove_prefix(end);
    return word;
}

template <typename Number, typename... Format>
bool read_number(std::string_view& rest, Number& number, Format... format) {
    const std::string_view word = next_word(rest);
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number, format...);
    return error == std::errc{} && end == word.data() + word.size();
}

bool read_vector(std::string_view& rest, Vec3& v) {
    constexpr auto hex = std::chars_format::hex;
    return read_number(rest, v.x, hex) && read_number(rest, v.y, hex) && read_number(rest, v.z, hex);
}

bool read_rotation(std::string_view& rest, Quat& q) {
    constexpr auto hex = std::chars_format::hex;
    return read_number(rest, q.w, hex) && read_number(rest, q.x, hex) && read_number(rest, q.y, hex) &&
           read_number(rest, q.z, hex);
}

std::optional<DeviceSample> from_line(std::string_view line) {
    DeviceSample sample;
    int connected = 0;
    const bool understood = read_vector(line, sample.position) && read_vector(line, sample.velocity) &&
                            read_rotation(line, sample.rotation) && read_number(line, sample.buttons) &&
                            read_number(line, connected) && next_word(line).empty();
    if (!understood || connected < 0 || connected > 1) {
        return std::nullopt;
    }
    sample.connected = connected == 1;
    return sample;
}

// A line without its end; nothing at the end of the file. A line longer than any of ours is cut, and not
// understood.
std::optional<std::string> read_line(std::FILE* file) {
    std::array<char, 1024> buffer{};
    if (std::fgets(buffer.data(), static_cast<int>(buffer.size()), file) == nullptr) {
        return std::nullopt;
    }
    std::string line = buffer.data();
    while (!line.empty() && (line.back() == '\n' || line.back() == '\r')) {
        line.pop_back();
    }
    return line;
}

}  // namespace

bool write_device_recording(std::FILE* file, std::span<const DeviceSample> samples) {
    std::fprintf(file, "%s\n", std::string(header).c_str());
    for (const DeviceSample& sample : samples) {
        std::fputs(to_line(sample).c_str(), file);
    }
    return std::fflush(file) == 0 && std::ferror(file) == 0;
}

DeviceRecording read_device_recording(std::FILE* file) {
    if (read_line(file) != header) {
        return {{}, "the first line is not \"" + std::string(header) + "\""};
    }
    DeviceRecording recording;
    for (std::size_t number = 2;; ++number) {
        const std::optional<std::string> line = read_line(file);
        if (!line) {
            break;
        }
        const std::optional<DeviceSample> sample = from_line(*line);
        if (!sample) {
            return {{}, "line " + std::to_string(number) + " is not a sample"};
        }
        recording.samples.push_back(*sample);
    }
    if (recording.samples.empty()) {
        recording.error = "the recording has no samples";
    }
    return recording;
}

}  // namespace tactus
