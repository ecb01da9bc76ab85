// A box on a ground at either side of a link, and a hand that presses the model.
#pragma once

#include <memory>
#include <vector>

#include "network/link_emulator.hpp"
#include "network/memory_link.hpp"
#include "session/environment_teller.hpp"
#include "session/model_builder.hpp"
#include "session/operator_side.hpp"
#include "session/teleoperator_side.hpp"
#include "shared/sealed_link.hpp"

namespace tactus::shared {

class AttackDevice final : public Device {
public:
    DeviceSample read(Nanoseconds) override {
        return {position, Quat(1.0, 0.0, 0.0, 0.0), velocity, 0, true};
    }
    void write(Nanoseconds, const Vec3& given) override { force = given; }

    Vec3 position{0.0, 0.2, 0.0};
    Vec3 velocity{0.0};
    Vec3 force{0.0};
};

// Keeps the last datagrams that came through it.
class ListenedLink final : public Link {
public:
    explicit ListenedLink(Link& inner) : inner_(inner) { heard_.reserve(kept); }
    bool send(std::span<const std::byte> datagram, Nanoseconds now) override {
        if (heard_.size() < kept) {
            heard_.emplace_back();
        }
        heard_[count_++ % kept].assign(datagram.begin(), datagram.end());
        return inner_.send(datagram, now);
    }
    ReceivedDatagram receive(std::span<std::byte> into, Nanoseconds now) override {
        return inner_.receive(into, now);
    }
    std::size_t overhead() const override { return inner_.overhead(); }
    const std::vector<std::vector<std::byte>>& heard() const { return heard_; }

private:
    static constexpr std::size_t kept = 2048;
    Link& inner_;
    std::vector<std::vector<std::byte>> heard_;
    std::size_t count_ = 0;
};

// One place of the two. The environment's bodies are described to the operator.
struct AttackPlace {
    AttackPlace();

    // Its side is attached.
    void fill(bool far);

    void tick(Nanoseconds now) {
        session.tick(now);
        session.refresh();
        port->statistics.refresh();
        session.collect();
    }
    const TeleopStatistics& statistics() const { return port->statistics.front(); }
    const BodyState* body_state(SessionHandle body) const;  // null: it cannot move, or there is none
    Vec3 place_of(SessionHandle body) const;

    AttackDevice device;
    std::shared_ptr<TeleopPort> port = std::make_shared<TeleopPort>();
    Session session;
    SessionHandle own = no_handle;  // a body that nobody else may move: no hand of the far side reaches it
    SessionHandle box = no_handle;  // far: what is touched
};

class AttackRig {
public:
    static constexpr Nanoseconds period = 1'000'000;
    static constexpr double stiffness = 500.0;  // of what is touched (unit: newtons per meter)
    // Layers: what pointers touch, and what nothing that is described meets.
    static constexpr std::uint32_t touchable = 1, untouchable = 2;

    AttackRig(bool sealed, const LinkConditions& conditions = {});

    void tick();
    void ticks(int count) {
        for (int i = 0; i < count; ++i) {
            tick();
        }
    }
    // The hand comes down onto the box and stays, pressing.
    void press();

    // As if it came over the wire.
    void throw_at_operator(std::span<const std::byte> bytes) { wire_.second().send(bytes, now); }
    void throw_at_far(std::span<const std::byte> bytes) { wire_.first().send(bytes, now); }
    const std::vector<std::vector<std::byte>>& said_by_far() const { return far_tap_.heard(); }
    const std::vector<std::vector<std::byte>>& said_by_operator() const { return near_tap_.heard(); }
    bool both_connected() const;
    // Of what comes in at the far side.
    void change(const LinkConditions& conditions) { far_way_.change(conditions); }

    Nanoseconds now = 0;
    std::uint64_t model_changes = 0;  // times that the operator has built what was described
    std::unique_ptr<AttackPlace> near, far;
    static constexpr std::uint64_t near_epoch = 0x1f2e3d4c5b6a7988u, far_epoch = 0x123456789abcdef1u;

private:
    MemoryLinkPair wire_{8192};
    ListenedLink near_tap_{wire_.first()}, far_tap_{wire_.second()};
    LinkEmulator near_way_, far_way_;
    std::unique_ptr<SealedLink> near_seal_, far_seal_;
    std::unique_ptr<EnvironmentTeller> teller_;
    std::unique_ptr<ModelBuilder> builder_;
};

}  // namespace tactus::shared
