#include "core/feedback/touch_feedback.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace tactus::touch_feedback_test {
namespace {

constexpr double rate = 22050.0;
constexpr Nanoseconds tick = 1'000'000;

// A finger that presses with a force that shakes at 200 Hz.
void shake(TouchFeedback& feedback, Nanoseconds from, int ticks, bool has_sound) {
    for (int i = 0; i < ticks; ++i) {
        const double seconds = i * 1e-3;
        feedback.hear(from + i * tick, {Vec3(0, 1.0 + std::sin(1256.6 * seconds), 0), 0.001}, {}, has_sound);
    }
}

TEST(TouchFeedback, ShakesAndSoundsForAsLongAsItHears) {
    TouchFeedback feedback(rate);
    shake(feedback, tick, 100, true);
    EXPECT_GT(feedback.take_levels({}).light, 0.1);
    const std::vector<float> samples = feedback.take_samples();
    EXPECT_NEAR(static_cast<double>(samples.size()), 0.1 * rate, 2.0);
    EXPECT_GT(*std::ranges::max_element(samples), 0.05f);
    EXPECT_EQ(feedback.take_levels({}).light, 0.0) << "since the last time there was nothing";
    EXPECT_TRUE(feedback.take_samples().empty());
}

TEST(TouchFeedback, MakesNoSamplesWithoutSound) {
    TouchFeedback feedback(rate);
    shake(feedback, tick, 100, false);
    EXPECT_TRUE(feedback.take_samples().empty());
    EXPECT_GT(feedback.take_levels({}).light, 0.1);
}

TEST(TouchFeedback, DoesNotMakeUpForAPause) {
    TouchFeedback feedback(rate);
    shake(feedback, tick, 10, true);
    feedback.take_samples();
    feedback.hear(60 * nanoseconds_per_second, {Vec3(0, 1, 0), 0.001}, {}, true);
    EXPECT_LE(feedback.take_samples().size(), static_cast<std::size_t>(0.011 * rate));
}

TEST(TouchFeedback, FallsSilent) {
    TouchFeedback feedback(rate);
    shake(feedback, tick, 100, true);
    feedback.fall_silent();
    EXPECT_TRUE(feedback.take_samples().empty());
    EXPECT_EQ(feedback.take_levels({}).light, 0.0);
}

}  // namespace
}  // namespace tactus::touch_feedback_test
