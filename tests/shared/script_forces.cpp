#include "shared/script_forces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "core/haptics/measured_field.hpp"
#include "devices/simulated_arm.hpp"
#include "session/session.hpp"
#include "shared/random_values.hpp"

namespace tactus::shared {

namespace {

constexpr Nanoseconds period = 1'000'000;
constexpr double seconds = 1e-3;
constexpr int ticks = 4'000;
constexpr int faded_in = 100;  // ticks, core/haptics/hand_field.hpp

struct Script {
    ScriptForm form;
    double size;         // (unit: newtons)
    double length;       // of a detent (unit: meters)
    double stiffness;    // (unit: newtons per meter)
    double fine = 0.0;   // of a texture (unit: meters)
    double steep = 0.0;  // (unit: newtons per meter)

    double force(double x) const {
        switch (form) {
            case ScriptForm::leap:
                return x <= 0.0 ? size : 0.0;
            case ScriptForm::ramp:
                return std::clamp(-1e3 * size * x, 0.0, size);
            case ScriptForm::cliff:
                return x <= 0.0 ? size - 100.0 * x : 0.0;
            case ScriptForm::spring:
                return -stiffness * x;
            case ScriptForm::detents:
                return size * std::sin(2.0 * std::numbers::pi * x / length);
            case ScriptForm::saw:
                return size * (1.0 - 2.0 * (x / length - std::floor(x / length)));
            case ScriptForm::wind:
                return size;
            case ScriptForm::texture:
                return size * std::sin(2.0 * std::numbers::pi * x / fine);
            case ScriptForm::notches: {
                const double off = x / length - std::floor(x / length) - 0.5;
                return std::abs(off) < 0.15 ? -size * std::sin(2.0 * std::numbers::pi * off / 0.3) : 0.0;
            }
            case ScriptForm::teeth:
                return size * (2.0 * (2.0 * x / length - std::floor(2.0 * x / length)) - 1.0);
            case ScriptForm::square:
                return std::sin(2.0 * std::numbers::pi * x / length) > 0.0 ? size : -size;
            case ScriptForm::pair:
                return (x <= 0.0 ? 0.5 * size : 0.0) + size * std::sin(2.0 * std::numbers::pi * x / length);
            case ScriptForm::stiff:
                return -steep * x;
        }
        return 0.0;
    }

    bool is_spring() const { return form == ScriptForm::spring || form == ScriptForm::stiff; }
    // What the hand is to feel of it, so that energy can be made: a spring no stiffer than any is felt.
    double due(double x) const {
        const double k = form == ScriptForm::stiff ? steep : stiffness;
        return is_spring() ? -std::min(k, HandField::stiffest) * x : force(x);
    }
    bool is_steep() const {
        switch (form) {
            case ScriptForm::ramp:
                return 1e3 * size > HandField::stiffest;
            case ScriptForm::spring:
                return stiffness > HandField::stiffest;
            case ScriptForm::detents:
            case ScriptForm::pair:  // its wall may never be reached
                return 2.0 * std::numbers::pi * size / length > HandField::stiffest;
            case ScriptForm::texture:
                return 2.0 * std::numbers::pi * size / fine > HandField::stiffest;
            case ScriptForm::notches:
                return 2.0 * std::numbers::pi * size / (0.3 * length) > HandField::stiffest;
            case ScriptForm::wind:
                return false;
            default:
                return true;
        }
    }
};

// Led from 3 cm on one side to 2 cm on the other within a second.
class LedArm final : public Device {
public:
    LedArm(const ArmSettings& arm, const Script& script) : arm_(arm), script_(script) {
        state_.position.x = from();
        state_.velocity.x = to - from();
    }

    DeviceSample read(Nanoseconds) override {
        const double time = seconds * tick_++;
        HandSample intended;
        intended.position.x = from() + (to - from()) * std::min(1.0, time + 0.5 * seconds);
        intended.velocity.x = time < 1.0 ? to - from() : 0.0;
        const ArmState before = state_;
        state_ = step_arm(arm_, state_, intended, force_, seconds);
        const double way = state_.position.x - before.position.x;
        const double middle = 0.5 * (state_.position.x + before.position.x);
        made_ = tick_ > faded_in ? made_ + (force_.x - script_.due(middle)) * way : 0.0;
        most_made_ = std::max(most_made_, made_);
        DeviceSample sample;
        sample.position = state_.position;
        sample.velocity = state_.velocity;
        sample.connected = true;
        return sample;
    }
    void write(Nanoseconds, const Vec3& force) override { force_ = force; }

    const ArmState& state() const { return state_; }
    double most_made() const { return most_made_; }

private:
    static constexpr double to = -0.02;
    // A spring begins where it gives no more than a device may.
    double from() const { return script_.is_spring() ? 0.0 : 0.03; }

    ArmSettings arm_;
    Script script_;
    ArmState state_;
    Vec3 force_{0.0};
    int tick_ = 0;
    double made_ = 0.0, most_made_ = 0.0;
};

}  // namespace

std::string_view name_of(ScriptForm form) {
    constexpr std::string_view names[] = {"leap",    "ramp",    "cliff", "spring", "detents", "saw",  "wind",
                                          "texture", "notches", "teeth", "square", "pair",    "stiff"};
    return names[static_cast<std::size_t>(form)];
}

void ScriptFigures::add(const ScriptFigures& other) {
    energy_made_max = std::max(energy_made_max, other.energy_made_max);
    shake_max = std::max(shake_max, other.shake_max);
    limited += other.limited;
    steep += other.steep;
    runs += other.runs;
}

ScriptFigures play_script(ScriptForm form, std::uint64_t seed, const ScriptFrames& frames) {
    RandomValues random(seed * 8 + static_cast<std::uint64_t>(form));
    Script script{form, random.between(0.5, 5.0), random.magnitude(2e-3, 2e-2),
                  random.magnitude(100.0, 6'000.0)};
    const ArmSettings arm{random.between(0.3, 1.0), random.between(5.0, 15.0), random.between(100.0, 300.0)};
    const double any_rate = random.between(30.0, 144.0);
    const double frame = 1e3 / (frames.rate > 0.0 ? frames.rate : any_rate);
    const int oldest = random.below(8);
    double next_frame = random.between(0.0, frame);
    script.fine = random.magnitude(5e-4, 5e-3);
    script.steep = random.magnitude(2'000.0, 10'000.0);
    LedArm device(arm, script);
    Session session{SessionSettings{}};
    Workspace workspace;
    workspace.force_limit = 8.0;
    ProxyDescription pointer;
    pointer.device = session.add_device(device, workspace).handle;
    const SessionHandle proxy = session.add_proxy(pointer).handle;
    FieldMoment told;
    told.place = device.state().position;
    std::array<ArmState, 8> past{};
    double least = 1e9, most = -1e9;
    bool is_limited = false;
    for (int i = 0; i < ticks; ++i) {
        past[static_cast<std::size_t>(i) % past.size()] = device.state();
        if (i >= next_frame && i >= oldest) {
            next_frame += random.between(0.0, 1.0) < frames.hiccups ? random.between(30.0, 100.0) : frame;
            const ArmState& seen = past[static_cast<std::size_t>(i - oldest) % past.size()];
            const auto answer = [&](const HandMotion& hand) {
                return std::optional(Vec3(script.force(hand.position.x), 0.0, 0.0));
            };
            told = *measured_field({seen.position, seen.velocity}, told, answer);
            session.set_hand_field(proxy, told);
        }
        session.tick((i + 1) * period);
        session.collect();
        session.refresh();
        is_limited = is_limited || (session.snapshot().proxies[0].status & touch_field_limited) != 0;
        if (i >= ticks / 2) {
            least = std::min(least, device.state().position.x);
            most = std::max(most, device.state().position.x);
        }
    }
    return {device.most_made(), most - least, is_limited ? 1 : 0, script.is_steep() ? 1 : 0, 1};
}

}  // namespace tactus::shared
