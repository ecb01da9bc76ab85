// Where depth images come from, one after the other.
#pragma once

#include <cstdint>
#include <string>

#include "sensing/image/depth_image.hpp"

namespace tactus {

class FrameSource {
public:
    enum class Reading : std::uint8_t {
        frame,
        nothing,  // in the time that was given
        damaged,  // a frame came that is none, trouble() says why; the next one may be whole
        ended,    // the recording is at its end
        lost,     // the camera is gone: open it again
    };

    virtual ~FrameSource() = default;

    // Waits for a frame so long. `image` keeps its memory from one frame to the next.
    virtual Reading read(DepthImage& image, int wait_ms) = 0;
    // For sentences: "seeing through NAME".
    virtual const std::string& name() const = 0;
    // Of the last damaged frame: what is wrong and what to do.
    virtual const std::string& trouble() const = 0;
    // What is to be known beside its frames, as the end of a sentence that begins with its name; empty:
    // nothing.
    virtual std::string remark() const { return {}; }
    // Its images are stamped with the time at which they were taken, on this machine's monotonic clock.
    virtual bool has_our_clock() const { return false; }
};

}  // namespace tactus
