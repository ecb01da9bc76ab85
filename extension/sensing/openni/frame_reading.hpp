// What OpenNI2's drivers deliver, taken for a depth image only where it is one: each field may be wrong.
#pragma once

#include <OniCAPI.h>

#include <string>

#include "sensing/image/depth_image.hpp"

namespace tactus {

// Of one step of depth, in tenths of a millimeter; 0: not a format that is depth.
int tenths_of_millimeter(OniPixelFormat format);

// Whether the frame, or what it is cut out of, has that size.
bool has_size_of(const OniFrame& frame, const DepthCamera& view);

// A frame may be cropped: what it leaves out has no depth. Empty, or what is wrong with it: then the image is
// as it was. `view`: of all that the camera sees.
std::string take_frame(const OniFrame& frame, const DepthCamera& view, bool is_mirrored, DepthImage& image);

}  // namespace tactus
