// How a fingertip is shown: a ball where the proxy is, a smaller one where the hand is, and a line between
// the two where they are apart.
#pragma once

#include "core/math/types.hpp"

namespace tactus {

struct HandView {
    Vec3 proxy{0.0}, hand{0.0};  // in the world (unit: meters)
    double radius = 0.01;        // of the fingertip (unit: meters)
    bool is_running = false;     // else it stands where it was put, without a hand
    bool is_present = true;      // false: the hand began inside a body
    bool shows_proxy = true, shows_hand = true;
};

// A ball of radius 1, or a cylinder of diameter and height 1 along y, in a frame with these axes.
struct PicturePart {
    bool is_visible = false;
    Vec3 center{0.0};
    Mat3 axes{1.0};
};

struct HandPicture {
    PicturePart proxy, hand, line;
};

HandPicture hand_picture(const HandView& view);

}  // namespace tactus
