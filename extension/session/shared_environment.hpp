// Several operators on one environment. Each has a side of its own, with its own link, pointers and truths,
// and is a ghost to the others: they see where its hands are (ghosts.hpp), and feel only what it does to the
// bodies.
#pragma once

#include <memory>
#include <vector>

#include "session/teleop_side.hpp"

namespace tactus {

class SharedEnvironment final : public TeleopSide {
public:
    static constexpr std::size_t max_operators = 4;

    // Not empty; each with a share of its own of the pointers (PointerShare).
    explicit SharedEnvironment(std::vector<std::unique_ptr<TeleopSide>> sides) : sides_(std::move(sides)) {}

    void set_hands(SessionLoop& loop, Nanoseconds now) override {
        for (const auto& side : sides_) {
            side->set_hands(loop, now);
        }
    }
    void set_forces(SessionLoop& loop, Nanoseconds now) override {
        for (const auto& side : sides_) {
            side->set_forces(loop, now);
        }
    }
    void report(SessionLoop& loop, Nanoseconds now) override {
        for (const auto& side : sides_) {
            side->report(loop, now);
        }
    }
    bool hears_tools() const override { return true; }
    // No operator's hand is at a device of this side.
    const ForceLimits& limits() const override { return sides_.front()->limits(); }

private:
    std::vector<std::unique_ptr<TeleopSide>> sides_;
};

}  // namespace tactus
