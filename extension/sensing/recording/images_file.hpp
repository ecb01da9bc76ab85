// The files that a camera's images are written to.
#pragma once

#include <cstdint>
#include <string>

namespace tactus {

// What stays free on a disk that images are written to (unit: bytes): OpenNI2 tells of no write that fails,
// and a recording has its index at its end.
constexpr std::uintmax_t kept_free = 64u << 20;

// Makes an empty file of this path; where there is one already, NAME_2 or the next that is free: no recording
// is written over. `path` becomes its path. Returns an empty text, or why there is none and what to do.
std::string make_images_file(std::string& path);

std::string images_file_error(const std::string& path, const std::string& why);

// False where the system does not say.
bool has_less_free(const std::string& path, std::uintmax_t bytes);

}  // namespace tactus
