// Files that hold a secret.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace tactus {

enum class FileTrouble : std::uint8_t {
    none,
    unreadable,      // `system_text` says why
    not_ordinary,    // a folder, a pipe, a device
    open_to_others,  // somebody else on this machine may read or change it; `way_out` is what to type
    too_long,
};

struct PrivateFile {
    FileTrouble trouble = FileTrouble::none;
    std::string bytes;  // empty in trouble
    std::string system_text;
    std::string way_out;
};

// Off the loop; the path is UTF-8. What is judged is what is read, whatever becomes of the name meanwhile.
PrivateFile read_private_file(const std::string& path, std::size_t max_bytes);

}  // namespace tactus
