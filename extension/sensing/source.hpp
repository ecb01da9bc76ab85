// The source of images that a name stands for: a recording, or a camera of OpenNI2.
#pragma once

#include <memory>
#include <string>

#include "sensing/image/frame_source.hpp"
#include "sensing/watch/sensor.hpp"

namespace tactus {

// Open. Null: `error` says why not and what to do. `own_driver`: see OpenNi::get(). OpenNI2 is loaded for
// cameras alone.
std::unique_ptr<FrameSource> open_source(const SourceChoice& choice, const std::string& own_driver,
                                         std::string& error);

}  // namespace tactus
