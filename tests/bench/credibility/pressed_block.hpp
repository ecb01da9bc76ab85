// A block that stands on a floor it is glued to, pressed in the middle of its top by a rigid ball without
// friction that hangs on a hand's spring. What is right for it, by finite elements: a quarter of the block in
// bricks of eight nodes and eight points of integration, the finer the nearer to the ball, of the material of
// soft bodies (corotated), found by Newton's method with conjugate gradients and a search along each step.
#pragma once

namespace tactus::bench {

struct PressedBlock {
    double half = 0.04;          // of an edge (unit: meters)
    double modulus = 1e4;        // Young's (unit: pascals)
    double poisson = 0.3;        // (dimensionless)
    double radius = 0.01;        // of the ball (unit: meters)
    double spring = 500.0;       // of the hand (unit: newtons per meter)
    double depth = 0.01;         // of the hand below where the ball touches first (unit: meters)
    double finest = 1.4e-3;      // bricks under the ball (unit: meters)
    int across = 12, down = 15;  // bricks along an edge of the quarter, and from its top to its foot
};

// What the hand feels (unit: newtons).
double force_of(const PressedBlock& block);

}  // namespace tactus::bench
