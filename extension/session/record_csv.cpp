#include "session/record_csv.hpp"

#include <charconv>

namespace tactus {

namespace {

constexpr int decimals = 9;  // nanometers and nanonewtons

void append(std::string& text, std::int64_t number) {
    char digits[24];
    text.append(digits, std::to_chars(digits, digits + sizeof digits, number).ptr);
}

// What is far beyond any scene has no fixed form of bounded length.
void append(std::string& text, double number) {
    char digits[64];
    constexpr double longest_fixed = 1e40;
    const bool fixed = number > -longest_fixed && number < longest_fixed;
    const auto result =
        fixed ? std::to_chars(digits, digits + sizeof digits, number, std::chars_format::fixed, decimals)
              : std::to_chars(digits, digits + sizeof digits, number);
    text.append(digits, result.ptr);
}

void append(std::string& text, const Vec3& vector) {
    for (int axis = 0; axis < 3; ++axis) {
        text += ',';
        append(text, vector[axis] + 0.0);  // + 0.0: no minus before a zero
    }
}

}  // namespace

std::string record_csv_header() {
    return "time_us,force_x,force_y,force_z,object_x,object_y,object_z,hand_x,hand_y,hand_z,"
           "proxy_x,proxy_y,proxy_z,object_qx,object_qy,object_qz,object_qw,proxy_status,contacts,"
           "displayed_x,displayed_y,displayed_z,ran_us,force_cut\n";
}

void append_record_csv(std::string& text, const SessionRecord& record, Nanoseconds epoch) {
    append(text, (record.time + epoch) / 1000);
    append(text, record.force);
    append(text, record.object_position);
    append(text, record.hand);
    append(text, record.proxy_position);
    const Quat& turn = record.object_rotation;
    append(text, Vec3(turn.x, turn.y, turn.z));
    text += ',';
    append(text, turn.w);
    text += ',';
    append(text, static_cast<std::int64_t>(record.proxy_status));
    text += ',';
    append(text, static_cast<std::int64_t>(record.contacts));
    append(text, record.displayed);
    text += ',';
    append(text, (record.ran + epoch) / 1000);
    text += ',';
    append(text, static_cast<std::int64_t>(record.cuts));
    text += '\n';
}

}  // namespace tactus
