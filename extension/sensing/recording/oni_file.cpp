#include "sensing/recording/oni_file.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <optional>
#include <span>
#include <string_view>

namespace tactus {

namespace {

constexpr std::uint64_t file_header = 24;
constexpr std::uint32_t record_magic = 0x0052494e;
constexpr std::uint32_t depth_node = 2;

// Names and values that matter are shorter than this; of longer fields the rest is not looked at.
constexpr std::size_t most_fields = 512;

// No depth camera has larger images (unit: pixels).
constexpr std::uint32_t largest_side = 4096;

enum RecordType : std::uint32_t {
    type_first = 0x02,
    type_node_added_oldest = 0x02,
    type_whole_number = 0x03,
    type_general = 0x06,
    type_new_data = 0x0a,
    type_end = 0x0b,
    type_node_added_older = 0x0c,
    type_node_added = 0x0d,
    type_last = 0x0e,
};

// OpenNI2's names of the formats of depth, OniPixelFormat.
constexpr std::uint64_t format_millimeters = 100, format_tenths = 101;

struct Record {
    std::uint32_t magic = 0, type = 0, node = 0, fields = 0, payload = 0;
};

template <class Value>
Value value_at(std::span<const std::byte> bytes, std::size_t at = 0) {
    Value value{};
    std::memcpy(&value, bytes.data() + at, sizeof value);
    return value;
}

bool read_at(std::istream& file, std::uint64_t at, std::span<std::byte> into) {
    file.clear();
    file.seekg(static_cast<std::streamoff>(at));
    file.read(reinterpret_cast<char*>(into.data()), static_cast<std::streamsize>(into.size()));
    return file.good();
}

// Fields of a record, one after the other; none where they have come to their end.
class Fields {
public:
    explicit Fields(std::span<const std::byte> bytes) : bytes_(bytes) {}

    template <class Value>
    std::optional<Value> next() {
        const auto found = take(sizeof(Value));
        return found ? std::optional(value_at<Value>(*found)) : std::nullopt;
    }
    std::optional<std::span<const std::byte>> take(std::size_t count) {
        if (count > bytes_.size()) {
            return std::nullopt;
        }
        const std::span<const std::byte> taken = bytes_.first(count);
        bytes_ = bytes_.subspan(count);
        return taken;
    }
    // Of a text its characters, which end in a zero.
    std::optional<std::string_view> text() {
        const auto length = next<std::uint32_t>();
        const auto found = length && *length > 0 ? take(*length) : std::nullopt;
        if (!found || found->back() != std::byte{0}) {
            return std::nullopt;
        }
        return std::string_view(reinterpret_cast<const char*>(found->data()), found->size() - 1);
    }

private:
    std::span<const std::byte> bytes_;
};

std::optional<DepthCodec> codec_called(std::uint32_t id) {
    const auto is = [id](std::string_view name) { return std::memcmp(&id, name.data(), sizeof id) == 0; };
    return id == 0 || is("NONE") ? std::optional(DepthCodec::none)
           : is("16zP")          ? std::optional(DepthCodec::differences)
           : is("16zT")          ? std::optional(DepthCodec::indices)
                                 : std::nullopt;
}

// What the file says of its depth camera as far as it has been read.
struct SaidView {
    std::uint32_t width = 0, height = 0;
    double horizontal = 0.0, vertical = 0.0;  // whole angles of view (unit: radians)
    std::uint64_t format = format_millimeters;
    std::optional<DepthCodec> codec;
    bool is_mirrored = false, is_cropped = false;
    std::array<std::uint16_t, 4> crop{};  // left, top, width, height

    void take_whole_number(std::string_view name, std::span<const std::byte> value) {
        if (value.size() != sizeof(std::uint64_t)) {
            return;
        }
        if (name == "xnMirror") {
            is_mirrored = value_at<std::uint64_t>(value) != 0;
        } else if (name == "oniPixelFormat") {
            format = value_at<std::uint64_t>(value);
        }
    }
    void take_general(std::string_view name, std::span<const std::byte> value) {
        if (name == "xnMapOutputMode" && value.size() == 12) {
            width = value_at<std::uint32_t>(value);
            height = value_at<std::uint32_t>(value, 4);
        } else if (name == "xnFOV" && value.size() == 16) {
            horizontal = value_at<double>(value);
            vertical = value_at<double>(value, 8);
        } else if (name == "xnCropping" && value.size() == 12) {
            is_cropped = value_at<std::uint32_t>(value) != 0;
            std::memcpy(crop.data(), value.data() + 4, sizeof crop);
        }
    }
};

// Empty, or why no image can be taken for one of it.
std::string to_view(const SaidView& said, OniView& view) {
    const auto is_angle = [](double angle) { return angle > 0.01 && angle < 3.1; };
    if (said.width == 0 || said.height == 0 || said.width > largest_side || said.height > largest_side ||
        !is_angle(said.horizontal) || !is_angle(said.vertical)) {
        return "it does not tell the size or the angle of view of its images";
    }
    if (!said.codec) {
        return "its depth images are compressed in a way that is not read here";
    }
    if (said.format != format_millimeters && said.format != format_tenths) {
        return "its depths are not in millimeters";
    }
    view.camera = camera_of_view(static_cast<int>(said.width), static_cast<int>(said.height), said.horizontal,
                                 said.vertical);
    view.codec = *said.codec;
    view.tenths = said.format == format_millimeters ? 10 : 1;
    view.is_mirrored = said.is_mirrored;
    view.left = said.is_cropped ? said.crop[0] : 0;
    view.top = said.is_cropped ? said.crop[1] : 0;
    view.width = said.is_cropped ? said.crop[2] : view.camera.width;
    view.height = said.is_cropped ? said.crop[3] : view.camera.height;
    const bool is_inside = view.width > 0 && view.height > 0 && view.left + view.width <= view.camera.width &&
                           view.top + view.height <= view.camera.height;
    return is_inside ? "" : "its images are cut out of more than there is";
}

class IndexReader {
public:
    IndexReader(std::istream& file, OniRecording& recording) : file_(file), recording_(recording) {}

    std::string read();

private:
    enum class Outcome { goes_on, ended, damaged, refused };

    std::uint64_t size();
    std::string place() const { return "after " + std::to_string(recording_.frames.size()) + " images"; }
    Outcome take(const Record& record, std::uint64_t at, std::span<const std::byte> fields);
    bool take_node(std::uint32_t node, Fields fields);
    bool take_property(const Record& record, Fields fields);
    Outcome take_frame(const Record& record, std::uint64_t at, Fields fields);

    std::istream& file_;
    OniRecording& recording_;
    std::uint64_t header_ = 28;
    std::optional<std::uint32_t> node_;  // of the depth camera
    SaidView said_;
    bool is_other_view_ = true;  // than the last frame's
    std::string refused_;
};

std::uint64_t IndexReader::size() {
    file_.clear();
    file_.seekg(0, std::ios::end);
    const std::streamoff end = file_.tellg();
    return end > 0 ? static_cast<std::uint64_t>(end) : 0;
}

std::string IndexReader::read() {
    const std::uint64_t size = this->size();
    std::array<std::byte, most_fields> memory;
    if (size < file_header || !read_at(file_, 0, std::span(memory).first(file_header)) ||
        std::memcmp(memory.data(), "NI10", 4) != 0) {
        return "it is not a recording by OpenNI2";
    }
    const std::array<unsigned, 3> version{value_at<std::uint8_t>(memory, 4),
                                          value_at<std::uint8_t>(memory, 5),
                                          value_at<std::uint16_t>(memory, 6)};
    header_ = version < std::array<unsigned, 3>{1, 0, 1} ? 24 : 28;
    for (std::uint64_t at = file_header;;) {
        if (size - at < header_ || !read_at(file_, at, std::span(memory).first(sizeof(Record)))) {
            return "it is cut off " + place();
        }
        const auto record = value_at<Record>(memory);
        if (record.magic != record_magic || record.fields < header_ || record.type < type_first ||
            record.type > type_last) {
            return "it is damaged " + place();
        }
        const std::uint64_t bytes = std::uint64_t{record.fields} + record.payload;
        const auto fields = std::span(memory).first(std::min(record.fields - header_, most_fields));
        if (bytes > size - at || !read_at(file_, at + header_, fields)) {
            return "it is cut off " + place();
        }
        switch (take(record, at, fields)) {
            case Outcome::goes_on:
                break;
            case Outcome::ended:
                return recording_.frames.empty() ? "it holds no depth images" : "";
            case Outcome::damaged:
                return "it is damaged " + place();
            case Outcome::refused:
                return refused_;
        }
        at += bytes;
    }
}

IndexReader::Outcome IndexReader::take(const Record& record, std::uint64_t at,
                                       std::span<const std::byte> fields) {
    const auto go_on = [](bool is_whole) { return is_whole ? Outcome::goes_on : Outcome::damaged; };
    switch (record.type) {
        case type_node_added_oldest:
        case type_node_added_older:
        case type_node_added:
            return go_on(take_node(record.node, Fields(fields)));
        case type_whole_number:
        case type_general:
            return go_on(record.node != node_ || take_property(record, Fields(fields)));
        case type_new_data:
            return record.node == node_ ? take_frame(record, at, Fields(fields)) : Outcome::goes_on;
        case type_end:
            return Outcome::ended;
        default:
            return Outcome::goes_on;
    }
}

bool IndexReader::take_node(std::uint32_t node, Fields fields) {
    const auto name = fields.text();
    const auto kind = fields.next<std::uint32_t>();
    const auto codec = fields.next<std::uint32_t>();
    if (name && kind == depth_node && codec && !node_) {
        node_ = node;
        said_.codec = codec_called(*codec);
    }
    return name && kind && codec;
}

bool IndexReader::take_property(const Record& record, Fields fields) {
    const auto name = fields.text();
    const auto bytes = fields.next<std::uint32_t>();
    if (!name || !bytes) {
        return false;
    }
    const auto value = fields.take(*bytes);
    if (!value) {
        return *bytes <= record.fields;  // a long one, which does not matter
    }
    record.type == type_whole_number ? said_.take_whole_number(*name, *value)
                                     : said_.take_general(*name, *value);
    is_other_view_ = true;
    return true;
}

IndexReader::Outcome IndexReader::take_frame(const Record& record, std::uint64_t at, Fields fields) {
    const auto time = fields.next<std::uint64_t>();
    if (!time) {
        return Outcome::damaged;
    }
    if (is_other_view_) {
        OniView view;
        refused_ = to_view(said_, view);
        if (!refused_.empty()) {
            return Outcome::refused;
        }
        if (recording_.views.empty() || !(recording_.views.back() == view)) {
            recording_.views.push_back(view);
        }
        is_other_view_ = false;
    }
    recording_.frames.push_back(
        {*time, at + record.fields, record.payload, static_cast<std::uint32_t>(recording_.views.size() - 1)});
    return Outcome::goes_on;
}

// Where the part that was recorded stands in the whole image, with depths in millimeters.
void place_part(const OniView& view, std::span<const std::uint16_t> part, DepthImage& image) {
    image.camera = view.camera;
    image.depth_mm.assign(pixel_count(view.camera), 0);
    for (int v = 0; v < view.height; ++v) {
        const std::size_t row =
            static_cast<std::size_t>(v + view.top) * static_cast<std::size_t>(view.camera.width);
        for (int u = 0; u < view.width; ++u) {
            const int told = part[static_cast<std::size_t>(v * view.width + u)];
            const int across = view.is_mirrored ? view.camera.width - 1 - (u + view.left) : u + view.left;
            image.depth_mm[row + static_cast<std::size_t>(across)] =
                static_cast<std::uint16_t>(view.tenths == 10 ? told : (told + 5) / 10);
        }
    }
}

}  // namespace

std::string read_oni(std::istream& file, OniRecording& recording) {
    recording = {};
    return IndexReader(file, recording).read();
}

bool read_oni_frame(std::istream& file, const OniRecording& recording, std::size_t number,
                    std::vector<std::byte>& memory, DepthImage& image) {
    const OniFrame& frame = recording.frames[number];
    const OniView& view = recording.views[frame.view];
    const auto pixels = static_cast<std::size_t>(view.width) * static_cast<std::size_t>(view.height);
    if (frame.bytes > most_encoded_bytes(pixels)) {
        return false;
    }
    memory.resize(frame.bytes);
    if (!read_at(file, frame.at, memory)) {
        return false;
    }
    std::vector<std::uint16_t> part(pixels, 0);
    // The recorder leaves out the last pixels of an image.
    if (2 * decode_depth(view.codec, memory, part) < pixels) {
        return false;
    }
    place_part(view, part, image);
    image.time_us = frame.time_us;
    return true;
}

}  // namespace tactus
