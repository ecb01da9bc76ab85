// Soft bodies of which a closed form says how they move, or hang: tests and the bench of credibility use
// them.
#pragma once

namespace tactus::shared {

struct SoftCase {
    double ours = 0.0;
    double right = 0.0;
};

// A plate of 20 x 100 x 100 mm, held along the middle of an edge, swings by 0.1 rad: its period (unit:
// seconds).
SoftCase hung_plate_period(double stiffness, double damping);

// A beam of 200 x 20 x 20 mm, clamped at one end: the first period, and how far its end sags under a tenth of
// gravity (units: seconds; meters).
SoftCase beam_period(double stiffness, double damping);
SoftCase beam_sag(double stiffness, int cells);

// A ball of 40 mm radius that lies on a plane and is let go as that leans by 0.15 rad: its acceleration in
// the first 0.4 s, the mean of six placings (unit: meters per square second).
SoftCase rolling_ball(double stiffness, double damping);

// A cube of 80 mm, 10 kPa, on its foot, pressed in 10 mm by a hand of 500 N/m at one point of its top: the
// force over the way of the point (unit: newtons per meter).
double press_stiffness(int cells);

}  // namespace tactus::shared
