#include "core/mesh/obj_text.hpp"

#include <algorithm>
#include <charconv>
#include <optional>
#include <span>

#include "core/mesh/polygon_triangles.hpp"

namespace tactus {

namespace {

// Lines as they are meant: put together where they go on after a \, without comment.
class Lines {
public:
    explicit Lines(std::string_view text) : text_(text) {
        constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
        if (text_.starts_with(byte_order_mark)) {
            text_.remove_prefix(byte_order_mark.size());
        }
    }

    bool next(std::string_view& line) {
        if (text_.empty()) {
            return false;
        }
        number_ = following_;
        line = piece();
        if (line.ends_with('\\')) {
            joined_.clear();
            while (line.ends_with('\\')) {
                joined_.append(line.substr(0, line.size() - 1)) += ' ';
                line = piece();
            }
            line = joined_.append(line);
        }
        line = line.substr(0, line.find('#'));
        return true;
    }
    std::size_t number() const { return number_; }  // of the line's first piece, from 1

private:
    std::string_view piece() {
        const std::size_t end = std::min(text_.find_first_of("\r\n"), text_.size());
        const std::string_view line = text_.substr(0, end);
        text_.remove_prefix(std::min(text_.size(), end + (text_.substr(end).starts_with("\r\n") ? 2 : 1)));
        ++following_;
        return line;
    }

    std::string_view text_;
    std::string joined_;
    std::size_t number_ = 0;
    std::size_t following_ = 1;
};

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
    if (index < 0 || index >= 0xffff'ffff) {
        return "vertex " + std::to_string(*number) + " does not exist: there are " + std::to_string(count) +
               " so far";
    }
    corner = static_cast<std::uint32_t>(index);
    return {};
}

// How many of the corners make the face, where they come again and again in the same order: the shortest
// period, by the longest border of each prefix (Knuth, Morris, Pratt 1977).
std::size_t corners_once(std::span<const std::uint32_t> corners, std::vector<std::size_t>& border) {
    border.assign(corners.size(), 0);
    for (std::size_t i = 1; i < corners.size(); ++i) {
        std::size_t length = border[i - 1];
        while (length > 0 && corners[i] != corners[length]) {
            length = border[length - 1];
        }
        border[i] = corners[i] == corners[length] ? length + 1 : 0;
    }
    const std::size_t period = corners.size() - border.back();
    return period >= 3 && corners.size() % period == 0 ? period : corners.size();
}

class Reader {
public:
    explicit Reader(const ObjLimits& limits) : limits_(limits), work_(limits.polygon_work) {}

    ObjResult read(std::string_view text) {
        if (text.size() > limits_.bytes) {
            return {{},
                    "the text has " + std::to_string(text.size()) + " bytes, the limit is " +
                        std::to_string(limits_.bytes) + ": split it into several meshes"};
        }
        Lines lines(text);
        std::string_view line;
        while (lines.next(line)) {
            const std::string_view keyword = next_word(line);
            std::string error;
            if (keyword == "v") {
                error = read_vertex(line, mesh_);
            } else if (keyword == "f") {
                error = read_face(line, lines.number());
            }
            if (error.empty() && mesh_.vertices.size() > limits_.vertices) {
                error = "more than " + std::to_string(limits_.vertices) +
                        " vertices: split the mesh into several";
            }
            if (!error.empty()) {
                return {{}, in_line(lines.number(), error)};
            }
        }
        for (std::size_t i = 0; i < early_.size(); ++i) {
            const std::size_t end = i + 1 < early_.size() ? early_[i + 1].first : early_corners_.size();
            const std::span<const std::uint32_t> face(&early_corners_[early_[i].first],
                                                      end - early_[i].first);
            if (std::string error = add_face(face); !error.empty()) {
                return {{}, in_line(early_[i].line, error)};
            }
        }
        return {std::move(mesh_), {}};
    }

private:
    // A face that names vertices which come later.
    struct EarlyFace {
        std::size_t first;  // of its corners
        std::size_t line;
    };

    static std::string in_line(std::size_t number, const std::string& error) {
        return "line " + std::to_string(number) + ": " + error;
    }

    std::string read_face(std::string_view line, std::size_t number) {
        face_.clear();
        bool known = true;
        for (std::string_view word = next_word(line); !word.empty(); word = next_word(line)) {
            std::uint32_t corner = 0;
            if (std::string error = read_corner(word, mesh_.vertices.size(), corner); !error.empty()) {
                return error;
            }
            known = known && corner < mesh_.vertices.size();
            face_.push_back(corner);
        }
        if (face_.size() < 3) {
            return "a face needs at least three corners";
        }
        face_.resize(corners_once(face_, border_));
        if (known) {
            return add_face(face_);
        }
        early_.push_back({early_corners_.size(), number});
        early_corners_.insert(early_corners_.end(), face_.begin(), face_.end());
        return {};
    }

    std::string add_face(std::span<const std::uint32_t> face) {
        for (const std::uint32_t corner : face) {
            if (corner >= mesh_.vertices.size()) {
                return "vertex " + std::to_string(std::uint64_t{corner} + 1) + " does not exist: there are " +
                       std::to_string(mesh_.vertices.size());
            }
        }
        if (!add_polygon(mesh_.vertices, face, work_, mesh_.triangles)) {
            return "faces of many corners would take too long to cut into triangles: export the mesh with "
                   "triangles";
        }
        if (mesh_.triangles.size() > limits_.triangles) {
            return "more than " + std::to_string(limits_.triangles) +
                   " triangles: split the mesh into several";
        }
        return {};
    }

    const ObjLimits& limits_;
    TriangleMesh mesh_;
    std::int64_t work_;
    std::vector<std::uint32_t> face_;
    std::vector<std::size_t> border_;
    std::vector<EarlyFace> early_;
    std::vector<std::uint32_t> early_corners_;
};

}  // namespace

ObjResult read_obj_text(std::string_view text, const ObjLimits& limits) {
    return Reader(limits).read(text);
}

}  // namespace tactus
