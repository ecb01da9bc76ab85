// Chance on the way is no queue, and a queue behind chance is found.
#include "network/queue_watch.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "endpoint_rig.hpp"
#include "network/pace.hpp"
#include "shared/wire_samples.hpp"

namespace tactus {
namespace {

constexpr Nanoseconds ms = 1'000'000;
constexpr double threshold = 20e6;

// The share of requests, one every 100 ms for `seconds`, after which a queue is told.
template <typename Draw>
double share_told(double seconds, Draw&& way) {
    QueueWatch watch;
    const int count = static_cast<int>(10.0 * seconds);
    int told = 0;
    for (int i = 0; i < count; ++i) {
        const Nanoseconds at = i * 100 * ms;
        watch.add(at, at + static_cast<Nanoseconds>(way(i)), at);
        told += watch.figures().is_longer_than(threshold, false) ? 1 : 0;
    }
    return static_cast<double>(told) / count;
}

TEST(QueueWatch, EvenChanceIsNoQueue) {
    for (const double jitter : {5e6, 10e6, 20e6, 50e6, 200e6}) {
        std::mt19937_64 random(3);
        std::uniform_real_distribution<double> draw(-jitter, jitter);
        EXPECT_LT(share_told(3000.0, [&](int) { return 300e6 + draw(random); }), 1e-3) << jitter;
    }
}

TEST(QueueWatch, NormalChanceIsNoQueue) {
    for (const double jitter : {5e6, 10e6, 20e6, 50e6}) {
        std::mt19937_64 random(4);
        std::normal_distribution<double> draw(0.0, jitter);
        EXPECT_LT(share_told(3000.0, [&](int) { return 500e6 + draw(random); }), 1e-3) << jitter;
    }
}

TEST(QueueWatch, AQueueBehindChanceIsFound) {
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> draw(-10e6, 10e6);
    // After 3 s it fills by 50 ms a second, up to 150 ms.
    const double told =
        share_told(8.0, [&](int i) { return 100e6 + draw(random) + std::clamp((i - 30) * 5e6, 0.0, 150e6); });
    EXPECT_GT(told, 0.45);
}

TEST(QueueWatch, AQueueThatAnswersNothingIsThereStill) {
    QueueWatch watch;
    for (int i = 0; i < 10; ++i) {
        const Nanoseconds at = i * 20 * ms;
        watch.add(at, at + 10 * ms + (i > 4 ? 100 * ms : 0), at);
    }
    const Nanoseconds last = watch.figures().as_of;
    watch.wait(last + 600 * ms, 120 * ms);
    EXPECT_EQ(watch.figures().as_of, last) << "the answer may be on its way";
    watch.wait(last + 700 * ms, 120 * ms);
    EXPECT_EQ(watch.figures().as_of, last + 700 * ms);
    EXPECT_TRUE(watch.figures().is_longer_than(threshold, true));
    EXPECT_FALSE(watch.figures().falls());
}

// It is full before a request finds a queue, and then none is answered: only what is lost tells of it.
TEST(Pace, AWayThatIsFilledAtOnceIsFound) {
    for (const double rate : {100e3, 150e3, 200e3}) {
        LinkConditions conditions;
        conditions.delay = 10 * ms;
        conditions.rate = rate;
        EndpointRig rig(conditions, 6);
        Pace pace(PaceSettings{0.1, 8});
        rig.run(3000 * ms, [] {});
        int tick = 0;
        const auto send = [&] {
            if (++tick % pace.stride() == 0) {
                rig.far().send(samples::force(1.0));
            }
            pace.adapt(rig.far(), rig.now());
        };
        rig.run(1000 * ms, send);
        EXPECT_GT(rig.far().statistics().lost_there, 0.1) << rate;
        rig.run(9000 * ms, send);
        EXPECT_LT(rig.far().statistics().lost_there, 0.1) << rate;
    }
}

// More packets are what helps there.
TEST(Pace, LossByChanceThrottlesOnlyToAsk) {
    for (const double loss : {0.2, 0.5, 0.9}) {
        LinkConditions conditions;
        conditions.delay = 10 * ms;
        conditions.loss = loss;
        EndpointRig rig(conditions, 6);
        Pace pace(PaceSettings{0.1, 8});
        int ticks = 0, throttled = 0;
        rig.run(60'000 * ms, [&] {
            rig.far().send(samples::force(1.0));
            pace.adapt(rig.far(), rig.now());
            ++ticks;
            throttled += pace.stride() > 1 ? 1 : 0;
        });
        EXPECT_LT(throttled, 0.1 * ticks) << loss;
    }
}

// What is sent over a way with jitter, without a limit and without losses, is all that there is to send.
TEST(Pace, JitterThrottlesNothingAndLosesNothing) {
    for (const JitterShape shape : {JitterShape::uniform, JitterShape::normal})
        for (const Nanoseconds jitter : {10 * ms, 20 * ms, 50 * ms}) {
            LinkConditions conditions;
            conditions.delay = 60 * ms;
            conditions.jitter = jitter;
            conditions.shape = shape;
            EndpointRig rig(conditions, 6);
            Pace pace(PaceSettings{});
            int ticks = 0, throttled = 0;
            double lost = 0.0;
            rig.run(60'000 * ms, [&] {
                rig.far().send(samples::force(1.0));
                pace.adapt(rig.far(), rig.now());
                ++ticks;
                throttled += pace.stride() > 1 ? 1 : 0;
                lost += rig.far().statistics().lost_there;
            });
            EXPECT_LT(throttled, 0.01 * ticks) << jitter;
            EXPECT_LT(lost / ticks, 0.003) << jitter;
        }
}

}  // namespace
}  // namespace tactus
