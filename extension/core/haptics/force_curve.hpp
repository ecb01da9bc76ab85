// The force of a surface over the depth to which it is pressed, as a button or a key has it: from sample to
// sample it is straight. Beyond the last one it goes on as steeply as the surface is stiff.
//
// The force is a function of the depth alone. So it gives back on the way out what it took on the way in,
// also where it falls with the depth.
#pragma once

#include <memory>
#include <string>
#include <vector>

namespace tactus {

struct ForceCurve {
    static constexpr std::size_t most = 1024;  // samples

    double depth = 0.0;          // of the last sample (unit: meters), > 0
    std::vector<double> forces;  // at even depths from 0 on, where it is 0 (unit: newtons)
    double steepest = 0.0;       // of its pieces, up or down (unit: newtons per meter)

    // Of any samples: whether they can be used is for check_curve() to say.
    static std::shared_ptr<const ForceCurve> of(double depth, std::vector<double> forces);

    struct At {
        double force = 0.0;  // (unit: newtons)
        double slope = 0.0;  // (unit: newtons per meter)
    };
    // `stiffness`: beyond the last sample (unit: newtons per meter).
    At at(double depth, double stiffness) const;
};

// Empty where it can be used; otherwise what is wrong and what to do.
std::string check_curve(const ForceCurve& curve);

}  // namespace tactus
