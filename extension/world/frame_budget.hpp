// Whether something that runs in every frame takes too long for it: now and then it may.
#pragma once

namespace tactus {

class FrameBudget {
public:
    // One frame more. True where it was too late too often in a row, or far too late once (unit of both:
    // seconds).
    bool is_overdrawn(double taken, double budget) {
        late_ = taken > budget ? late_ + 1 : 0;
        return late_ >= late_in_a_row || taken > far_too_late * budget;
    }
    void forget() { late_ = 0; }

private:
    static constexpr int late_in_a_row = 5;
    static constexpr double far_too_late = 100.0;  // as many budgets

    int late_ = 0;  // frames in a row
};

}  // namespace tactus
