// Whether an .oni file is whole. OpenNI2's player trusts what it reads: a recording that was cut off, as by a
// full disk, ends the program that plays it.
//
// The format (numbers little-endian, packed): "NI10", version 1.0.0.4 and later, then records, each with
//     magic "NIR\0", type, node, bytes of header and fields, bytes of payload (4 bytes each), position of an
//     earlier record (8 bytes; 4 before version 1.0.1.0)
// and its fields and payload behind, the last one of type "end".
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace tactus {

// Empty, or what is wrong with it.
std::string check_recording(std::span<const std::byte> file);

// The same of a file on the disk; it may be of any size.
std::string check_recording(const std::string& path);

}  // namespace tactus
