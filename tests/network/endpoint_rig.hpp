// Two sides and an emulated network between them, in virtual time.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "network/endpoint.hpp"
#include "network/link_emulator.hpp"
#include "network/memory_link.hpp"

namespace tactus {

class EndpointRig {
public:
    static constexpr Nanoseconds tick = 1'000'000;

    struct SideRig {
        LinkEmulator link;  // on what comes in
        std::unique_ptr<Endpoint> endpoint;
        std::vector<Message> heard;
        std::function<void(const Message&)> listener;  // instead of `heard`
    };

    explicit EndpointRig(const LinkConditions& conditions = {}, std::uint64_t seed = 1)
        : near_{LinkEmulator(pair_.first(), conditions, seed), nullptr, {}, {}},
          far_{LinkEmulator(pair_.second(), conditions, seed + 1), nullptr, {}, {}} {
        start_near(11);
        start_far(22);
    }

    void start_near(std::uint64_t epoch, Side side = Side::operator_side) { start(near_, epoch, side); }
    void start_far(std::uint64_t epoch, Side side = Side::teleoperator_side) { start(far_, epoch, side); }
    void stop_far() { far_.endpoint.reset(); }

    Endpoint& near() { return *near_.endpoint; }
    Endpoint& far() { return *far_.endpoint; }
    LinkEmulator& near_link() { return near_.link; }
    LinkEmulator& far_link() { return far_.link; }
    Link& far_wire() { return pair_.second(); }
    std::vector<Message>& near_heard() { return near_.heard; }
    std::vector<Message>& far_heard() { return far_.heard; }
    void on_near(std::function<void(const Message&)> listener) { near_.listener = std::move(listener); }
    void on_far(std::function<void(const Message&)> listener) { far_.listener = std::move(listener); }
    Nanoseconds now() const { return now_; }

    // Ticks both sides; `act` is called within each tick.
    template <typename Act>
    void run(Nanoseconds span, Act&& act) {
        for (const Nanoseconds end = now_ + span; now_ < end; now_ += tick) {
            begin(near_);
            begin(far_);
            act();
            finish(near_);
            finish(far_);
        }
    }
    void run(Nanoseconds span) {
        run(span, [] {});
    }

private:
    void start(SideRig& side, std::uint64_t epoch, Side which) {
        EndpointSettings settings;
        settings.side = which;
        settings.epoch = epoch;
        side.endpoint = std::make_unique<Endpoint>(side.link, settings);
        side.endpoint->begin_tick(now_);
    }

    void begin(SideRig& side) {
        if (side.endpoint == nullptr) {
            return;
        }
        side.endpoint->begin_tick(now_);
        while (const Endpoint::Received* received = side.endpoint->receive()) {
            if (side.listener) {
                side.listener(received->packet.message);
            } else {
                side.heard.push_back(received->packet.message);
            }
        }
    }

    static void finish(SideRig& side) {
        if (side.endpoint != nullptr) {
            side.endpoint->end_tick();
        }
    }

    MemoryLinkPair pair_{8192};
    SideRig near_;
    SideRig far_;
    Nanoseconds now_ = 0;
};

}  // namespace tactus
