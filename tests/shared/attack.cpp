#include "shared/attack.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <glm/geometric.hpp>
#include <limits>

#include "network/plausibility.hpp"
#include "shared/attack_descriptions.hpp"
#include "shared/attack_rig.hpp"
#include "shared/dice.hpp"
#include "support/process.hpp"

namespace tactus::shared {
namespace {

using Bytes = std::vector<std::byte>;

constexpr int thrown_a_tick = 96;

// --- what a side with the key may say

struct Says {
    Says(Dice& some_dice, const AttackRig& some_rig) : dice(some_dice), rig(some_rig) {}

    Dice& dice;
    const AttackRig& rig;

    ObjectId object() {
        return one_in_three() ? static_cast<ObjectId>(dice.number()) : static_cast<ObjectId>(dice.below(8));
    }
    bool one_in_three() { return dice.one_in(3); }
    Nanoseconds time(Nanoseconds near) {
        return near + static_cast<Nanoseconds>(dice.real(static_cast<double>(plausible::max_age)));
    }

    void operator()(Hello& m) {
        m.side = static_cast<Side>(dice.below(2));
        m.scenario = static_cast<std::uint8_t>(1 + dice.below(5));
        m.period = 1 + static_cast<Nanoseconds>(dice.number() % nanoseconds_per_second);
        m.heard_epoch = dice.one_in(2)   ? AttackRig::near_epoch
                        : dice.one_in(2) ? AttackRig::far_epoch
                                         : dice.bits();
        m.object_count = static_cast<std::uint32_t>(dice.number());
        m.gravity = dice.one_in(2) ? Vec3(0.0, -9.81, 0.0) : dice.vector(plausible::max_gravity);
        m.heard_packets = dice.number();
        m.heard_sequence = dice.number();
    }
    void operator()(Bye&) {}
    void operator()(ClockRequest& m) { m = {static_cast<std::uint32_t>(dice.number()), any_time()}; }
    void operator()(ClockAnswer& m) {
        m = {static_cast<std::uint32_t>(dice.number()), any_time(), any_time(), any_time()};
        if (dice.one_in(2)) {
            m.t0 = rig.now - static_cast<Nanoseconds>(dice.below(100'000'000));
            m.t1 = time(rig.now);
            m.t2 = m.t1 + static_cast<Nanoseconds>(dice.below(1'000'000));
        }
    }
    Nanoseconds any_time() {
        return static_cast<Nanoseconds>(dice.real(static_cast<double>(plausible::max_time)));
    }
    void operator()(DiscoveryFragment& m) {
        static const Bytes bytes(max_fragment_bytes, std::byte{0x42});
        m.object = object();
        m.object = m.object == no_object ? 0 : m.object;
        m.revision = static_cast<std::uint32_t>(dice.one_in(2) ? ++revision_ : dice.number());
        m.hash.fill(static_cast<std::uint8_t>(dice.below(4)));
        m.total_bytes = 1 + static_cast<std::uint32_t>(dice.number() % max_description_bytes);
        const std::uint32_t pieces = (m.total_bytes + max_fragment_bytes - 1) / max_fragment_bytes;
        m.offset = static_cast<std::uint32_t>(dice.below(pieces) * max_fragment_bytes);
        m.bytes = std::span(bytes).first(std::min<std::size_t>(max_fragment_bytes, m.total_bytes - m.offset));
    }
    void operator()(ObjectRemoval& m) {
        // Removing what it has described is the far side's right: objects that it has not are aimed at.
        m.object = 16 + static_cast<ObjectId>(dice.number() % 1'000'000);
        m.revision = static_cast<std::uint32_t>(dice.number());
        m.hash.fill(static_cast<std::uint8_t>(dice.bits()));
    }
    void operator()(DiscoveryAcknowledgement& m) {
        m.object = object();
        m.object = m.object == no_object ? 0 : m.object;
        m.hash.fill(static_cast<std::uint8_t>(dice.bits()));
        m.verdict = static_cast<DiscoveryVerdict>(dice.below(4));
    }
    void operator()(ObjectStates& m) {
        m.true_at = time(rig.now);
        m.newest_operator_sample = sample();
        m.count = static_cast<std::uint8_t>(dice.below(ObjectStates::max_count + 1));
        for (std::size_t i = 0; i < m.count; ++i) {
            ObjectState& state = m.states[i];
            state.object = object();
            state.object = state.object == no_object ? 0 : state.object;
            state.asleep = dice.one_in(2);
            state.pose.position = dice.vector(plausible::max_position);
            state.pose.rotation = dice.rotation();
            state.linear_velocity = dice.vector(plausible::max_speed);
            state.angular_velocity = dice.vector(plausible::max_angular_speed);
        }
    }
    void operator()(OperatorSamples& m) {
        m.period = 1 + static_cast<Nanoseconds>(dice.number() % nanoseconds_per_second);
        m.count = static_cast<std::uint8_t>(1 + dice.below(6));
        for (std::size_t i = 0; i < m.count; ++i) {
            OperatorSample& s = m.samples[i];
            s.sequence = std::clamp<std::uint64_t>(sample(), 1, plausible::max_sequence);
            s.time = time(rig.now);
            s.has_turn = dice.one_in(4);
            s.pointer =
                static_cast<std::uint16_t>(dice.one_in(2) ? (s.has_turn ? first_tool : 0) : dice.number());
            s.rotation = dice.rotation();
            s.spin = dice.vector(plausible::max_angular_speed);
            s.connected = !dice.one_in(8);
            s.buttons = static_cast<std::uint32_t>(dice.number());
            s.position = dice.vector(plausible::max_position);
            s.velocity = dice.vector(plausible::max_speed);
            s.force = dice.vector(plausible::max_force);
            s.nearest_object = object();
            s.position_in_object = dice.vector(plausible::max_position);
        }
    }
    void operator()(ForceSamples& m) {
        m.count = static_cast<std::uint8_t>(1 + dice.below(ForceSamples::max_count));
        for (std::size_t i = 0; i < m.count; ++i) {
            m.samples[i] = {static_cast<std::uint16_t>(dice.one_in(2) ? 0 : dice.number()),
                            time(rig.now),
                            sample(),
                            dice.vector(plausible::max_force),
                            dice.vector(plausible::max_position),
                            object()};
        }
    }
    void operator()(Ghosts& m) {
        m.count = static_cast<std::uint8_t>(1 + dice.below(Ghosts::max_count));
        for (std::size_t i = 0; i < m.count; ++i) {
            m.ghosts[i] = {static_cast<std::uint16_t>(dice.number()), dice.one_in(2),
                           dice.vector(plausible::max_position), dice.size(max_ghost_radius)};
        }
    }
    void operator()(ObjectEstimates& m) {
        m.count = static_cast<std::uint8_t>(1 + dice.below(ObjectEstimates::max_count));
        for (std::size_t i = 0; i < m.count; ++i) {
            ObjectEstimate& e = m.estimates[i];
            e.object = object();
            e.has_doubt = dice.one_in(2);
            e.doubt = {Mat3(dice.size(1e4)), Mat3(dice.size(100.0))};
            for (TouchValue* const value : {&e.stiffness, &e.friction, &e.mass}) {
                *value = {dice.size(max_estimate), dice.size(max_estimate), dice.one_in(2)};
            }
        }
    }
    void operator()(Terms& m) {
        m.scenario = static_cast<std::uint8_t>(1 + dice.below(5));
        m.passivity = static_cast<std::uint8_t>(dice.below(6));
        m.impedance = m.passivity == Terms::with_waves ? dice.size(max_impedance) : 0.0;
        m.bodies = static_cast<std::uint32_t>(dice.number() % no_object);
        for (HandTerms& hand : m.hands) {
            hand.kind = static_cast<HandTerms::Kind>(dice.below(3));
            hand.radius = 1e-3 * static_cast<double>(dice.below(20));
            hand.shape = static_cast<std::uint64_t>(dice.number());
        }
    }
    void operator()(SampleAcknowledgements& m) {
        m.count = static_cast<std::uint8_t>(1 + dice.below(SampleAcknowledgements::max_count));
        for (std::size_t i = 0; i < m.count; ++i) {
            m.samples[i].pointer = static_cast<std::uint16_t>(dice.below(first_tool + 6));
            m.samples[i].sequence = std::min(sample(), plausible::max_sequence);
        }
    }
    void operator()(WrenchSamples& m) {
        m.count = static_cast<std::uint8_t>(1 + dice.below(WrenchSamples::max_count));
        for (std::size_t i = 0; i < m.count; ++i) {
            m.samples[i] = {static_cast<std::uint16_t>(dice.one_in(2) ? first_tool : dice.number()),
                            time(rig.now),
                            sample(),
                            dice.vector(plausible::max_force),
                            dice.vector(plausible::max_torque),
                            {dice.vector(plausible::max_position), dice.rotation()},
                            object(),
                            dice.one_in(2)};
        }
    }
    std::uint64_t sample() {
        const std::uint64_t newest = rig.far->statistics().sample;
        const std::uint64_t some = dice.one_in(2)
                                       ? newest + dice.below(2048) - std::min<std::uint64_t>(newest, 1024)
                                       : dice.number();
        return std::min(some, plausible::max_sequence);
    }

private:
    std::uint32_t revision_ = 0;
};

// After the kinds of message: what pieces of descriptions say when they have been put together.
constexpr std::size_t message_kinds = std::variant_size_v<Message>;
constexpr std::size_t bodies_kind = message_kinds, joints_kind = message_kinds + 1;

template <std::size_t... Kinds>
void make_kind(std::size_t kind, Message& message, std::index_sequence<Kinds...>) {
    [[maybe_unused]] const bool made = ((kind == Kinds && (message.emplace<Kinds>(), true)) || ...);
}

// --- what is thrown

class Thrower {
public:
    Thrower(AttackRig& rig, const AttackSettings& settings)
        : rig_(rig),
          settings_(settings),
          dice_(settings.seed * 1000 + settings.kind),
          says_(dice_, rig),
          descriptions_(dice_, settings.kind == joints_kind, AttackRig::untouchable) {}

    void throw_one() {
        const bool at_operator = aims_at_operator();
        const std::size_t size = settings_.attacker == Attacker::without_key && !dice_.one_in(4)
                                     ? recorded(at_operator)
                                     : made(at_operator);
        mutate(size, at_operator);
    }

private:
    bool aims_at_operator() {
        switch (settings_.kind) {
            case 4:
            case 5:
            case 7:
            case 9:
            case 10:
            case bodies_kind:
            case joints_kind:
                return true;
            case 6:
            case 8:
                return false;
            default:
                return dice_.one_in(2);
        }
    }

    // A well-formed packet of the kind.
    std::size_t made(bool at_operator) {
        if (settings_.attacker == Attacker::stranger && dice_.one_in(4)) {
            return noise();
        }
        if (settings_.kind >= message_kinds) {
            message_ = descriptions_.next();
        } else {
            make_kind(settings_.kind, message_, std::make_index_sequence<message_kinds>());
            std::visit(says_, message_);
        }
        const LinkStatistics& there = (at_operator ? rig_.far : rig_.near)->statistics().link;
        PacketHeader header;
        const bool knows = settings_.attacker != Attacker::stranger;
        header.epoch = knows && !dice_.one_in(4)
                           ? (at_operator ? AttackRig::far_epoch : AttackRig::near_epoch)
                           : dice_.bits() | 1;
        header.sequence = dice_.one_in(4) ? dice_.number() : there.packets_sent + dice_.below(64);
        header.sequence = std::clamp<std::uint64_t>(header.sequence, 1, plausible::max_sequence);
        header.sent_at = dice_.one_in(4) ? says_.any_time() : rig_.now;
        return encode(header, message_, bytes_);
    }

    std::size_t noise() {
        const std::size_t size = 1 + dice_.below(max_datagram_bytes - 1);
        for (std::size_t i = 0; i < size; ++i) {
            bytes_[i] = static_cast<std::byte>(dice_.bits());
        }
        constexpr std::array<char, 4> fronts[] = {
            {'T', 'C', wire_version, 8}, {'T', 'S', 2, 0}, {'T', 'S', 2, 1}};
        if (size > 4 && !dice_.one_in(4)) {
            std::memcpy(bytes_.data(), fronts[dice_.below(3)].data(), 4);
        }
        return size;
    }

    // One that a side has said, of any kind: nobody can see which. Sometimes thrown back at its sender.
    std::size_t recorded(bool at_operator) {
        const auto& heard = at_operator != dice_.one_in(16) ? rig_.said_by_far() : rig_.said_by_operator();
        if (heard.empty()) {
            return 0;
        }
        const Bytes& one = heard[dice_.below(heard.size())];
        std::copy(one.begin(), one.end(), bytes_.begin());
        return one.size();
    }

    void mutate(std::size_t size, bool at_operator) {
        if (size == 0) {
            return;
        }
        if (dice_.one_in(2)) {
            for (std::uint64_t hits = 1 + dice_.below(4); hits > 0; --hits) {
                bytes_[dice_.below(size)] ^= static_cast<std::byte>(1u << dice_.below(8));
            }
        }
        if (dice_.one_in(16)) {
            size = 1 + dice_.below(size);
        } else if (dice_.one_in(16)) {
            size = std::min(max_datagram_bytes, size + dice_.below(40));
        }
        const std::span<const std::byte> thrown = std::span(bytes_).first(size);
        at_operator ? rig_.throw_at_operator(thrown) : rig_.throw_at_far(thrown);
        // Kept for later: out of order, or once more.
        if (dice_.one_in(8)) {
            kept_[dice_.below(kept_.size())].assign(thrown.begin(), thrown.end());
        }
        if (dice_.one_in(8)) {
            if (const Bytes& again = kept_[dice_.below(kept_.size())]; !again.empty()) {
                at_operator ? rig_.throw_at_operator(again) : rig_.throw_at_far(again);
            }
        }
    }

    AttackRig& rig_;
    AttackSettings settings_;
    Dice dice_;
    Says says_;
    FalseDescriptions descriptions_;
    Message message_;
    std::array<std::byte, max_datagram_bytes> bytes_{};
    std::array<Bytes, 64> kept_;
};

double resident_mb() {
    return 1e-6 * testing::resident_bytes();
}

// What must stay where it is: the bodies that no packet of the attacker may move.
struct Watch {
    explicit Watch(const AttackRig& watched, Attacker who)
        : rig(watched), attacker(who), places{where()}, force(watched.near->device.force) {}

    std::array<Vec3, 3> where() const {
        return {rig.near->place_of(rig.near->own), rig.far->place_of(rig.far->own),
                rig.far->place_of(rig.far->box)};
    }
    void look(AttackFigures& figures) {
        const Vec3 now = rig.near->device.force;
        const double step = glm::distance(now, std::exchange(force, now));
        const double way = way_of_touched();
        const double by_motion = AttackRig::stiffness * std::max(way, std::exchange(way_before, way));
        figures.largest_force_step = std::max(figures.largest_force_step, step);
        figures.largest_unmoved_step = std::max(figures.largest_unmoved_step, step - by_motion);
        // Counts what is no number.
        figures.force_steps += step - by_motion <= AttackFigures::max_force_step ? 0 : 1;
    }
    // By which what the hand touches moves on in a tick (unit: meters): what flies against a hand is felt.
    double way_of_touched() const {
        constexpr double fastest = 10.0;  // what comes faster fades in (docs/teleoperation.md)
        const ProxyState& touch = rig.near->session.snapshot().proxies[0];
        double speed = 0.0;
        for (int k = 0; k < touch.contact_count; ++k) {
            const auto at = static_cast<std::size_t>(k);
            if (const BodyState* const body = rig.near->body_state(touch.bodies[at])) {
                speed = std::max(speed, glm::length(body->linear_velocity) +
                                            glm::length(body->angular_velocity) *
                                                glm::distance(touch.points[at], body->pose.position));
            }
        }
        return std::min(speed, fastest) * to_seconds(AttackRig::period);
    }
    // The touched box belongs to who has the hand; to nobody else.
    std::uint64_t moved() const {
        const std::array<Vec3, 3> now = where();
        const std::size_t watched = attacker == Attacker::with_key ? 2 : 3;
        constexpr double noticed = 1e-3;
        return static_cast<std::uint64_t>(
            std::count_if(now.begin(), now.begin() + watched, [&](const Vec3& place) {
                return !(glm::distance(place, places[static_cast<std::size_t>(&place - now.data())]) <=
                         noticed);
            }));
    }

    const AttackRig& rig;
    Attacker attacker;
    std::array<Vec3, 3> places;
    Vec3 force;
    double way_before = 0.0;
};

}  // namespace

const char* name_of(Attacker attacker) {
    constexpr const char* names[] = {"stranger", "without_key", "with_key"};
    return names[static_cast<std::size_t>(attacker)];
}

std::size_t kind_count() {
    return message_kinds + 2;
}

std::string kind_name(std::size_t kind) {
    constexpr const char* names[] = {"hello",
                                     "bye",
                                     "clock_request",
                                     "clock_answer",
                                     "discovery_piece",
                                     "removal",
                                     "acknowledgement",
                                     "object_states",
                                     "operator_samples",
                                     "forces",
                                     "ghosts",
                                     "estimates",
                                     "wrenches",
                                     "sample_acknowledgements",
                                     "terms",
                                     "bodies",
                                     "joints"};
    return names[kind];
}

AttackFigures run_attack(const AttackSettings& settings) {
    AttackRig rig(settings.attacker != Attacker::with_key);
    rig.press();
    AttackFigures figures;
    const auto thrower = std::make_unique<Thrower>(rig, settings);
    Watch watch(rig, settings.attacker);
    const std::uint64_t built_before = rig.model_changes;
    const double memory_before = resident_mb();
    double memory = memory_before;
    while (figures.packets < settings.packets) {
        for (int i = 0; i < thrown_a_tick; ++i) {
            thrower->throw_one();
        }
        figures.packets += thrown_a_tick;
        rig.tick();
        watch.look(figures);
        if (figures.packets % (1000 * thrown_a_tick) == 0) {
            memory = std::max(memory, resident_mb());
        }
    }
    memory = std::max(memory, resident_mb());
    figures.memory_growth_mb = memory - memory_before;
    figures.moved_objects = watch.moved();
    figures.model_changes = rig.model_changes - built_before;
    for (int i = 0; i < 7000 && !(i > 2000 && rig.both_connected()); ++i) {
        rig.tick();
        watch.look(figures);
    }
    figures.not_recovered = rig.both_connected() ? 0 : 1;
    return figures;
}

// --- silence

BlackoutFigures run_blackout(double silence) {
    constexpr double radius = 0.1, turns_a_second = 0.4, tau = 6.283185307179586;
    constexpr int delay_ticks = 50;
    constexpr double near_enough = 1e-3;
    LinkConditions conditions;
    conditions.delay = delay_ticks * AttackRig::period;
    AttackRig rig(false, conditions);
    std::vector<Vec3> hands;
    const auto tick = [&] {
        const double angle = tau * turns_a_second * 1e-3 * static_cast<double>(hands.size());
        rig.near->device.position = {radius * std::cos(angle), 0.4, radius * std::sin(angle)};
        rig.near->device.velocity =
            Vec3(-std::sin(angle), 0.0, std::cos(angle)) * (tau * turns_a_second * radius);
        hands.push_back(rig.near->device.position);
        rig.tick();
    };
    BlackoutFigures figures;
    figures.hand_speed = tau * turns_a_second * radius;
    for (int i = 0; i < 3000; ++i) {
        tick();
    }
    const auto hand = [&rig] { return rig.far->session.snapshot().proxies[0].hand; };
    // Who has heard nothing for a second has let the hand go: it begins anew where it is then.
    const auto is_there = [&rig] {
        const PeerState peer = rig.far->statistics().link.peer;
        return peer == PeerState::connected || peer == PeerState::one_way;
    };
    // Where the network's own delay puts the hand, a tick or two more or less.
    const auto error = [&] {
        double least = 1.0;
        for (std::size_t late = delay_ticks - 1; late <= delay_ticks + 3; ++late) {
            least = std::min(least, glm::distance(hand(), hands[hands.size() - 1 - late]));
        }
        return least;
    };
    conditions.loss = 1.0;
    rig.change(conditions);
    for (int i = 0; i < static_cast<int>(silence * 1e3); ++i) {
        tick();
    }
    conditions.loss = 0.0;
    rig.change(conditions);
    Vec3 before = hand();
    bool was_there = is_there();
    figures.recovery_s = 1e9;
    int settled = 0;
    constexpr int long_enough = 1500;
    for (int i = 1; i <= delay_ticks + long_enough; ++i) {
        tick();
        const double speed = glm::distance(hand(), std::exchange(before, hand())) * 1e3;
        if (std::exchange(was_there, is_there()) && is_there()) {
            figures.max_speed = std::max(figures.max_speed, speed);
        }
        if (i > delay_ticks && error() <= near_enough) {
            settled = settled == 0 ? i : settled;
        } else {
            settled = 0;
        }
    }
    if (settled > 0) {
        figures.recovery_s = 1e-3 * static_cast<double>(settled - delay_ticks - 1);
    }
    return figures;
}

}  // namespace tactus::shared
