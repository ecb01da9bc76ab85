#include "core/mesh/obj_file.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>

namespace tactus {

namespace {

using namespace std::string_view_literals;

// At which length text shows what it is (unit: bytes).
constexpr std::size_t looked_at = 4096;

struct FileKind {
    std::string_view begin;
    const char* words;
};

constexpr std::array kinds{
    FileKind{"\xFF\xFE\0\0"sv, "it is text in UTF-32: save it as UTF-8"},
    FileKind{"\0\0\xFE\xFF"sv, "it is text in UTF-32: save it as UTF-8"},
    FileKind{"\x1F\x8B"sv, "it is packed by gzip: unpack it"},
    FileKind{"PK\x03\x04"sv, "it is a ZIP archive: unpack it"},
    FileKind{"BZh"sv, "it is packed by bzip2: unpack it"},
    FileKind{"\xFD\x37zXZ"sv, "it is packed by xz: unpack it"},
    FileKind{"7z\xBC\xAF"sv, "it is a 7z archive: unpack it"},
    FileKind{"version https://git-lfs"sv,
             "it is a pointer of Git LFS to the file: fetch it with git lfs pull"},
    FileKind{"glTF"sv, "it is a glTF file: export the mesh as OBJ"},
    FileKind{"Kaydara FBX"sv, "it is an FBX file: export the mesh as OBJ"},
    FileKind{"BLENDER"sv, "it is a Blender file: export the mesh as OBJ"},
    FileKind{"ply\n"sv, "it is a PLY file: export the mesh as OBJ"},
    FileKind{"ply\r"sv, "it is a PLY file: export the mesh as OBJ"},
    FileKind{"OFF\n"sv, "it is an OFF file: export the mesh as OBJ"},
    FileKind{"OFF\r"sv, "it is an OFF file: export the mesh as OBJ"},
};

std::string_view without_blanks(std::string_view text) {
    text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
    return text;
}

bool begins_alike(std::string_view text, std::string_view small) {
    const auto is_same = [](char a, char b) { return (a >= 'A' && a <= 'Z' ? a - 'A' + 'a' : a) == b; };
    return text.size() >= small.size() && std::equal(small.begin(), small.end(), text.begin(),
                                                     [&](char s, char t) { return is_same(t, s); });
}

// 80 bytes of anything, the number of triangles, 50 bytes for each.
bool is_binary_stl(std::string_view bytes) {
    if (bytes.size() < 84) {
        return false;
    }
    std::uint32_t triangles = 0;
    std::memcpy(&triangles, bytes.data() + 80, sizeof triangles);
    return triangles > 0 && bytes.size() == 84 + std::uint64_t{50} * triangles;
}

constexpr std::array known_keywords{
    "v"sv,        "vt"sv,       "vn"sv,         "vp"sv,        "f"sv,      "fo"sv,     "l"sv,      "p"sv,
    "g"sv,        "s"sv,        "o"sv,          "mg"sv,        "mtllib"sv, "usemtl"sv, "usemap"sv, "maplib"sv,
    "cstype"sv,   "deg"sv,      "bmat"sv,       "step"sv,      "curv"sv,   "curv2"sv,  "surf"sv,   "parm"sv,
    "trim"sv,     "hole"sv,     "scrv"sv,       "sp"sv,        "end"sv,    "con"sv,    "bevel"sv,  "lod"sv,
    "d_interp"sv, "c_interp"sv, "shadow_obj"sv, "trace_obj"sv, "ctech"sv,  "stech"sv,  "call"sv,   "csh"sv,
};

// "line 3: '…' is not understood: …", empty where every line may be of an .obj file.
std::string first_unknown_line(std::string_view text) {
    constexpr std::size_t most_shown = 40;
    for (std::size_t number = 1; !text.empty(); ++number) {
        const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
        const std::string_view line = without_blanks(text.substr(0, end));
        text.remove_prefix(std::min(text.size(), end + (text.substr(end).starts_with("\r\n") ? 2 : 1)));
        const std::string_view word = line.substr(0, line.find_first_of(" \t"));
        if (!word.empty() && word[0] != '#' &&
            std::ranges::find(known_keywords, word) == known_keywords.end()) {
            std::string shown(line.substr(0, most_shown));
            std::ranges::replace_if(shown, [](char c) { return static_cast<unsigned char>(c) < 0x20; }, '?');
            return "line " + std::to_string(number) + ": '" + shown +
                   "' is not understood: an OBJ file has lines 'v x y z' and 'f 1 2 3'";
        }
    }
    return {};
}

void append_utf8(std::uint32_t point, std::string& text) {
    if (point < 0x80) {
        text += static_cast<char>(point);
        return;
    }
    constexpr std::array<std::uint32_t, 4> lead{0, 0xc0, 0xe0, 0xf0};  // by the number of bytes that follow
    const int following = point < 0x800 ? 1 : point < 0x10000 ? 2 : 3;
    text += static_cast<char>(lead[static_cast<std::size_t>(following)] |
                              point >> static_cast<unsigned>(6 * following));
    for (int i = following - 1; i >= 0; --i) {
        text += static_cast<char>(0x80u | (point >> static_cast<unsigned>(6 * i) & 0x3fu));
    }
}

}  // namespace

std::string kind_of_other_file(std::string_view bytes) {
    const std::string_view text = without_blanks(bytes);
    if (text.empty()) {
        return "it is empty: export the mesh again";
    }
    for (const FileKind& kind : kinds) {
        if (bytes.starts_with(kind.begin)) {
            return kind.words;
        }
    }
    if (begins_alike(text, "<!doctype html") || begins_alike(text, "<html")) {
        return "it is a web page: download the file that it is about";
    }
    const bool is_stl_text =
        begins_alike(text, "solid") && text.substr(0, looked_at).find("facet") != std::string_view::npos;
    if (is_stl_text || is_binary_stl(bytes)) {
        return "it is an STL file: export the mesh as OBJ";
    }
    const bool is_utf16 = bytes.starts_with("\xFF\xFE") || bytes.starts_with("\xFE\xFF");
    if (!is_utf16 && bytes.substr(0, looked_at).find('\0') != std::string_view::npos) {
        return "it is no text: export the mesh as OBJ";
    }
    return {};
}

std::string as_utf8(std::string_view bytes) {
    const bool is_little = bytes.starts_with("\xFF\xFE");
    if (!is_little && !bytes.starts_with("\xFE\xFF")) {
        return std::string(bytes);
    }
    const auto unit = [&](std::size_t at) -> std::uint32_t {
        const std::uint32_t first = static_cast<unsigned char>(bytes[at]);
        const std::uint32_t second = static_cast<unsigned char>(bytes[at + 1]);
        return is_little ? first | second << 8u : first << 8u | second;
    };
    std::string text;
    text.reserve(bytes.size() / 2);
    for (std::size_t at = 2; at + 1 < bytes.size(); at += 2) {
        std::uint32_t point = unit(at);
        if (point >= 0xd800 && point < 0xe000) {
            const bool is_first = point < 0xdc00 && at + 3 < bytes.size();
            const std::uint32_t low = is_first ? unit(at + 2) : 0;
            const bool is_pair = low >= 0xdc00 && low < 0xe000;
            point = is_pair ? 0x10000 + ((point & 0x3ffu) << 10u | (low & 0x3ffu)) : ' ';
            at += is_pair ? 2 : 0;
        }
        append_utf8(point, text);
    }
    return text;
}

ObjResult read_obj_file(std::string_view bytes, const ObjLimits& limits) {
    if (std::string other = kind_of_other_file(bytes); !other.empty()) {
        return {{}, std::move(other)};
    }
    const bool is_utf8 = !bytes.starts_with("\xFF\xFE") && !bytes.starts_with("\xFE\xFF");
    const std::string converted = is_utf8 || bytes.size() > limits.bytes ? std::string() : as_utf8(bytes);
    const std::string_view text = converted.empty() ? bytes : std::string_view(converted);
    ObjResult result = read_obj_text(text, limits);
    if (result.error.empty() && result.mesh.triangles.empty()) {
        if (std::string unknown = first_unknown_line(text); !unknown.empty()) {
            result.error = std::move(unknown);
        }
    }
    return result;
}

}  // namespace tactus
