// Soft bodies that swing, sag, roll and are pressed.
#include "credibility/soft_bodies.hpp"

#include <cmath>
#include <string>

#include "shared/soft_cases.hpp"

namespace tactus::bench {

void measure_soft(const SoftResult& add) {
    const auto add_case = [&add](const std::string& name, const shared::SoftCase& found) {
        add(name + ".ours", found.ours);
        add(name + ".right", found.right);
        add(name, 100.0 * std::abs(found.ours / found.right - 1.0));
    };
    for (const auto& [name, stiffness] : {std::pair{"1e5", 1e5}, {"1e6", 1e6}}) {
        add_case("soft.plate_period_" + std::string(name) + "Pa", shared::hung_plate_period(stiffness, 2e-3));
        add_case("soft.beam_period_" + std::string(name) + "Pa", shared::beam_period(stiffness, 2e-3));
    }
    add_case("soft.plate_period_20ms_damping", shared::hung_plate_period(1e5, 0.02));
    add_case("soft.roll", shared::rolling_ball(3e4, 2e-3));
    for (const int cells : {8, 16, 32}) {
        add_case("soft.sag_" + std::to_string(cells) + "_cells", shared::beam_sag(1e6, cells));
    }
    for (const int cells : {4, 6, 8, 10}) {
        add("soft.press_" + std::to_string(cells) + "_cells_n_per_m", shared::press_stiffness(cells));
    }
}

}  // namespace tactus::bench
