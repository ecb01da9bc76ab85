// Recordings by OpenNI2 (.oni), read without OpenNI2: its own player trusts what it reads, and a changed byte
// of a file ends the program that plays it. Here every length is checked against the file before it is used.
//
// The format (numbers little-endian, packed): "NI10", version (bytes major, minor; two bytes, four bytes),
// largest time (8 bytes), largest node (4 bytes); then records, each with
//     magic "NIR\0", type, node, bytes of header and fields, bytes of payload (4 bytes each), position of an
//     earlier record (8 bytes; 4 before version 1.0.1.0)
// and its fields and payload behind, the last one of type "end". Fields, a text being its length with its
// end (4 bytes), its characters and a zero:
//     node added   name, kind (4 bytes; 2: depth), codec (4 bytes), what is not needed
//     property     name, bytes (4 bytes), value
//     new data     time (8 bytes, unit: microseconds), number (4 bytes); the payload is the image
// Of several depth cameras in a file the first is played.
#pragma once

#include <istream>
#include <string>
#include <vector>

#include "sensing/image/depth_image.hpp"
#include "sensing/recording/depth_codec.hpp"

namespace tactus {

// How images lie in the file: it may change from one to the next.
struct OniView {
    DepthCamera camera;
    DepthCodec codec = DepthCodec::none;
    int tenths = 10;  // of a millimeter that one step of depth is
    bool is_mirrored = false;
    int left = 0, top = 0, width = 0, height = 0;  // the part of the image that was recorded (unit: pixels)

    bool operator==(const OniView&) const = default;
};

struct OniFrame {
    std::uint64_t time_us = 0;  // of the camera's clock (unit: microseconds)
    std::uint64_t at = 0;       // of its payload (unit: bytes)
    std::uint32_t bytes = 0;    // of its payload
    std::uint32_t view = 0;     // index in `views`
};

struct OniRecording {
    std::vector<OniView> views;
    std::vector<OniFrame> frames;
};

// All but the images. Empty, or what is wrong with the file: then the recording is not to be used.
std::string read_oni(std::istream& file, OniRecording& recording);

// The part of the image that was not recorded has no depth. False where the payload is no such image.
// `memory` is kept from one call to the next.
bool read_oni_frame(std::istream& file, const OniRecording& recording, std::size_t number,
                    std::vector<std::byte>& memory, DepthImage& image);

}  // namespace tactus
