// What acts on a hand besides what it touches: guides, effects, and the force that its owner computes.
//
// Together they are no stiffer than what the device's damping renders safely: guides have half of it, effects
// and the owner's force half of the rest, and walls what is left.
#pragma once

#include "core/haptics/hand_effect.hpp"
#include "core/haptics/hand_field.hpp"
#include "core/haptics/hand_guide.hpp"

namespace tactus {

struct HandAids {
    static constexpr std::size_t most_guides = 4;

    std::array<HandGuide, most_guides> guides{};
    std::size_t guide_count = 0;
    HandEffects effects{};

    void add(const HandGuide& guide) { guides[guide_count++] = guide; }
};

// Whether they are the same but for where guides are.
bool are_same_aids(const HandAids& a, const HandAids& b);

// Empty where all can be computed; otherwise what is wrong and what to do.
std::string check_aids(const HandAids& aids);

// A frame whose owner moves it a few dozen times a second, moved evenly in between: it gets to each place
// within the time since the one before.
class FollowedFrame {
public:
    // One tick.
    const Pose& follow(const Pose& target);

private:
    static constexpr int longest = 20;  // (unit: ticks)

    Pose now_, target_;
    int ticks_left_ = 0;
    int since_ = longest;  // the target was another one
    bool is_there_ = false;
};

// What guides and effects remember from tick to tick.
struct AidMemory {
    struct Guided {
        FollowedFrame frame;
        Vec3 hand{0.0}, place{0.0};  // from where to where, in its frame (unit: meters)
    };

    std::array<Guided, HandAids::most_guides> guides;
    std::array<HandEffectMemory, HandEffects::most> effects;
};

// The hand and its device, as they are in the scene.
struct AidedHand {
    HandMotion motion;
    LoopLag lag;
    double damping = 0.0;      // of the device (unit: newton seconds per meter)
    double max_damping = 0.0;  // of the owner's force (the same unit)
    double max_force = 0.0;    // that the hand can be given (unit: newtons)
    Nanoseconds now = 0;
};

struct AidForce {
    Vec3 force{0.0};       // on the hand (unit: newtons)
    Wall wall;             // how steep that is at most
    double damping = 0.0;  // of the device's, that is left for walls (unit: newton seconds per meter)
    bool jumped = false;   // a guide leads elsewhere than the hand's way explains
};

AidForce aid_force(const HandAids& aids, const AidedHand& hand, HandField& field, AidMemory& memory);

}  // namespace tactus
