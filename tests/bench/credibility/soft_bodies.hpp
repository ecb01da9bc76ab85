// The part of the bench of credibility that is of soft bodies.
#pragma once

#include <functional>
#include <string>

namespace tactus::bench {

// Takes a figure by its name.
using SoftResult = std::function<void(const std::string& name, double value)>;

// CASE.ours, CASE.right and the deviation in percent, CASE; of a press its stiffness (unit: newtons per
// meter).
void measure_soft(const SoftResult& add);

}  // namespace tactus::bench
