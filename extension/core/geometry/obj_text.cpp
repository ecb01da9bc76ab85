#include "core/geometry/obj_text.hpp"

#include <charconv>
#include <optional>

namespace tactus {

namespace {

std::string_view next_line(std::string_view& text) {
    const std::size_t end = text.find('\n');
    std::string_view line = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    return line.substr(0, line.find_first_of("#\r"));
}

std::string_view next_word(std::string_view& line) {
    line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
    const std::size_t end = std::min(line.find_first_of(" \t"), line.size());
    const std::string_view word = line.substr(0, end);
    line.remove_prefix(end);
    return word;
}

template <typename Number>
std::optional<Number> to_number(std::string_view word) {
    if (word.starts_with('+')) {
        word.remove_prefix(1);
    }
    Number number{};
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    const bool whole = error == std::errc{} && end == word.data() + word.size();
    return whole ? std::optional<Number>(number) : std::nullopt;
}

std::string quoted(std::string_view word) {
    return "'" + std::string(word) + "'";
}

std::string read_vertex(std::string_view line, TriangleMesh& mesh) {
    Vec3 vertex{0.0};
    for (int axis = 0; axis < 3; ++axis) {
        const std::string_view word = next_word(line);
        const std::optional<double> number = to_number<double>(word);
        if (!number) {
            return word.empty() ? "a vertex needs three numbers" : quoted(word) + " is not a number";
        }
        vertex[axis] = *number;
    }
    mesh.vertices.push_back(vertex);
    return {};
}

// "7", "7/2", "7//3" and "7/2/3" all name vertex 7; "-1" names the newest.
std::string read_corner(std::string_view word, std::size_t vertex_count, std::uint32_t& corner) {
    const std::optional<std::int64_t> number = to_number<std::int64_t>(word.substr(0, word.find('/')));
    if (!number) {
        return quoted(word) + " does not name a vertex";
    }
    const auto count = static_cast<std::int64_t>(vertex_count);
    const std::int64_t index = *number < 0 ? count + *number : *number - 1;
    if (index < 0 || index >= count) {
        return "vertex " + std::to_string(*number) + " does not exist: there are " + std::to_string(count) +
               " so far";
    }
    corner = static_cast<std::uint32_t>(index);
    return {};
}

std::string read_face(std::string_view line, TriangleMesh& mesh) {
    std::uint32_t first = 0;
    std::uint32_t previous = 0;
    int corners = 0;
    for (std::string_view word = next_word(line); !word.empty(); word = next_word(line)) {
        std::uint32_t corner = 0;
        if (std::string error = read_corner(word, mesh.vertices.size(), corner); !error.empty()) {
            return error;
        }
        if (corners >= 2) {
            mesh.triangles.push_back({first, previous, corner});
        }
        first = corners == 0 ? corner : first;
        previous = corner;
        ++corners;
    }
    return corners < 3 ? "a face needs at least three corners" : std::string();
}

}  // namespace

ObjResult read_obj_text(std::string_view text) {
    ObjResult result;
    for (std::size_t number = 1; !text.empty(); ++number) {
        std::string_view line = next_line(text);
        const std::string_view keyword = next_word(line);
        std::string error;
        if (keyword == "v") {
            error = read_vertex(line, result.mesh);
        } else if (keyword == "f") {
            error = read_face(line, result.mesh);
        }
        if (!error.empty()) {
            return {{}, "line " + std::to_string(number) + ": " + error};
        }
    }
    return result;
}

}  // namespace tactus
