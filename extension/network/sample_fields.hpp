// The fields of what is sent many times a second, in few bytes: positions in whole nanometers and the like,
// as numbers of as many bytes as they need, and a sample that follows another one as what differs from it.
// Private to messages.cpp; docs/wire_format.md, kinds 8 to 11.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <type_traits>

#include "network/messages.hpp"
#include "network/wire_stream.hpp"

namespace tactus {

using WholeVector = std::array<std::int64_t, 3>;

// In whole quanta; refuses what is no number or lies beyond `most`.
inline WholeVector whole(WireStream& s, const Vec3& value, double quantum, double most) {
    WholeVector result{};
    for (int i = 0; i < 3; ++i) {
        if (!std::isfinite(value[i])) {
            s.refuse(Refusal::not_finite);
        } else if (std::abs(value[i]) > most) {
            s.refuse(Refusal::out_of_range);
        } else {
            result[static_cast<std::size_t>(i)] = std::llround(value[i] / quantum);
        }
    }
    return result;
}

// `value` as what it differs by from `expected`.
inline void whole_fields(WireWriter& s, Vec3 const& value, WholeVector& number, const WholeVector& expected,
                         double quantum, double most) {
    number = whole(s, value, quantum, most);
    for (std::size_t i = 0; i < 3; ++i) {
        s.folded_varint(number[i] - expected[i]);
    }
}
inline void whole_fields(WireReader& s, Vec3& value, WholeVector& number, const WholeVector& expected,
                         double quantum, double most) {
    const auto limit = static_cast<std::int64_t>(std::ceil(most / quantum));
    for (std::size_t i = 0; i < 3; ++i) {
        std::int64_t difference = 0;
        s.folded_varint(difference);
        constexpr std::int64_t no_overflow = std::int64_t{1} << 62;
        s.require(difference > -no_overflow && difference < no_overflow);
        number[i] = s.good() ? expected[i] + difference : 0;
        s.require(number[i] >= -limit && number[i] <= limit);
        number[i] = s.good() ? number[i] : 0;  // what follows is still told from it
        value[static_cast<int>(i)] = s.good() ? static_cast<double>(number[i]) * quantum : 0.0;
    }
}
template <typename Stream>
void whole_fields(Stream& s, auto& value, double quantum, double most) {
    WholeVector number{};
    whole_fields(s, value, number, WholeVector{}, quantum, most);
}

// Three of four: the largest is told by its place and follows from the others, its sign made positive.
inline constexpr double rotation_scale = 1518500249.98802484622;  // 2^30 * sqrt(2)
inline constexpr std::int64_t max_rotation_part = (std::int64_t{1} << 30) + 1;

inline std::uint8_t largest_part(const Quat& q) {
    const std::array<double, 4> parts{q.x, q.y, q.z, q.w};
    std::uint8_t largest = 0;
    for (std::uint8_t i = 1; i < 4; ++i) {
        largest = std::abs(parts[i]) > std::abs(parts[largest]) ? i : largest;
    }
    return largest;
}

inline void rotation_fields(WireWriter& s, const Quat& q, std::uint8_t largest) {
    const std::array<double, 4> parts{q.x, q.y, q.z, q.w};
    const double length = glm::length(q);
    const double scale = rotation_scale / (parts[largest] < 0.0 ? -length : length);
    s.require(std::isfinite(length) && std::abs(length - 1.0) < quaternion_tolerance);
    for (std::size_t i = 0; i < 4; ++i) {
        if (i != largest && s.good()) {
            s.integer(static_cast<std::int32_t>(std::llround(parts[i] * scale)));
        }
    }
}
inline void rotation_fields(WireReader& s, Quat& q, std::uint8_t largest) {
    std::array<double, 4> parts{};
    double rest = 1.0;
    for (std::size_t i = 0; i < 4; ++i) {
        if (i != largest) {
            std::int32_t part = 0;
            s.integer(part);
            s.require(std::abs(std::int64_t{part}) <= max_rotation_part);
            parts[i] = static_cast<double>(part) / rotation_scale;
            rest -= parts[i] * parts[i];
        }
    }
    constexpr double least = 0.25 - 1e-6;  // the square of the largest of four
    s.require(rest >= least);
    if (s.good()) {
        parts[largest] = std::sqrt(rest);
        q = glm::normalize(Quat(parts[3], parts[0], parts[1], parts[2]));
    }
}

// The same in whole numbers, for what is rounded before it is told: rounds once. Of parts that are as large
// but for rounding the first is left out, so that rounding does not change which.
struct WholeTurn {
    WholeVector parts{};  // x, y, z, w but the largest
    std::uint8_t largest = 3;
};

inline WholeTurn whole_turn(const Quat& q) {
    constexpr double alike = 1e-8;
    const std::array<double, 4> parts{q.x, q.y, q.z, q.w};
    const double most = std::abs(parts[largest_part(q)]) - alike;
    WholeTurn turn{{}, 0};
    while (turn.largest < 3 && std::abs(parts[turn.largest]) < most) {
        ++turn.largest;
    }
    const double length = glm::length(q);
    const double scale = rotation_scale / (parts[turn.largest] < 0.0 ? -length : length);
    for (std::size_t i = 0, k = 0; i < 4; ++i) {
        if (i != turn.largest) {
            turn.parts[k++] = std::llround(parts[i] * scale);
        }
    }
    return turn;
}

inline Quat rotation_of(const WholeTurn& turn) {
    std::array<double, 4> parts{};
    double rest = 1.0;
    for (std::size_t i = 0, k = 0; i < 4; ++i) {
        if (i != turn.largest) {
            parts[i] = static_cast<double>(turn.parts[k++]) / rotation_scale;
            rest -= parts[i] * parts[i];
        }
    }
    parts[turn.largest] = std::sqrt(rest);
    return glm::normalize(Quat(parts[3], parts[0], parts[1], parts[2]));
}

// Of a hand that holds a tool: how it is turned, as what that differs by from `expected`, which is of the
// same parts.
inline void turn_fields(WireWriter& s, const Quat& q, const WholeTurn& turn, const WholeVector& expected) {
    const double length = glm::length(q);
    s.require(std::isfinite(length) && std::abs(length - 1.0) < quaternion_tolerance);
    for (std::size_t i = 0; s.good() && i < 3; ++i) {
        s.folded_varint(turn.parts[i] - expected[i]);
    }
}
inline void turn_fields(WireReader& s, Quat& q, WholeTurn& turn, const WholeVector& expected) {
    constexpr double least = 0.25 - 1e-6;  // the square of the largest of four
    double rest = 1.0;
    for (std::size_t i = 0; i < 3; ++i) {
        std::int64_t difference = 0;
        s.folded_varint(difference);
        constexpr std::int64_t no_overflow = std::int64_t{1} << 40;
        s.require(difference > -no_overflow && difference < no_overflow);
        turn.parts[i] = s.good() ? expected[i] + difference : 0;
        s.require(std::abs(turn.parts[i]) <= max_rotation_part);
        turn.parts[i] = s.good() ? turn.parts[i] : 0;
        const double part = static_cast<double>(turn.parts[i]) / rotation_scale;
        rest -= part * part;
    }
    s.require(rest >= least);
    q = s.good() ? rotation_of(turn) : Quat(1.0, 0.0, 0.0, 0.0);
}

template <typename Stream>
void single_vector(Stream& s, auto& value, double most) {
    for (int i = 0; i < 3; ++i) {
        auto single = static_cast<float>(value[i]);
        s.real(single, static_cast<float>(-most), static_cast<float>(most));
        if constexpr (Stream::reads) {
            value[i] = s.good() ? static_cast<double>(single) : 0.0;
        }
    }
}

template <typename Stream>
void object_fields(Stream& s, auto& object) {
    std::uint64_t number = object;
    s.varint(number);
    s.require(number < no_object);
    if constexpr (Stream::reads) {
        object = s.good() ? static_cast<ObjectId>(number) : no_object;
    }
}

template <typename Stream>
void object_state_fields(Stream& s, auto& m) {
    enum : std::uint8_t { asleep = 1, moving = 2, largest_shift = 2, known = 0x0f };
    object_fields(s, m.object);
    std::uint8_t flags = 0;
    if constexpr (!Stream::reads) {
        const bool moves = m.linear_velocity != Vec3(0.0) || m.angular_velocity != Vec3(0.0);
        flags = static_cast<std::uint8_t>((m.asleep ? asleep : 0) | (moves ? moving : 0) |
                                          largest_part(m.pose.rotation) << largest_shift);
    }
    s.integer(flags);
    s.require((flags & ~known) == 0);
    whole_fields(s, m.pose.position, position_quantum, plausible::max_position);
    rotation_fields(s, m.pose.rotation, static_cast<std::uint8_t>(flags >> largest_shift & 3));
    if constexpr (Stream::reads) {
        m.asleep = (flags & asleep) != 0;
        m.linear_velocity = m.angular_velocity = Vec3(0.0);
    }
    if ((flags & moving) != 0) {
        single_vector(s, m.linear_velocity, plausible::max_speed);
        single_vector(s, m.angular_velocity, plausible::max_angular_speed);
    }
}

template <typename Stream>
void force_sample_fields(Stream& s, auto& m) {
    std::uint64_t pointer = m.pointer;
    s.varint(pointer);
    s.require(pointer <= 0xffffu);
    s.time_near(m.true_at);
    s.varint(m.newest_operator_sample);
    s.require(m.newest_operator_sample <= plausible::max_sequence);
    whole_fields(s, m.force, force_quantum, plausible::max_force);
    whole_fields(s, m.proxy, position_quantum, plausible::max_position);
    std::uint64_t object = m.object == no_object ? 0 : std::uint64_t{m.object} + 1;  // 0: none
    s.varint(object);
    s.require(object <= no_object);
    if constexpr (Stream::reads) {
        m.pointer = static_cast<std::uint16_t>(pointer);
        m.object = object == 0 ? no_object : static_cast<ObjectId>(object - 1);
    }
}

template <typename Stream>
void wrench_sample_fields(Stream& s, auto& m) {
    std::uint64_t pointer = m.pointer;
    s.varint(pointer);
    s.require(pointer <= 0xffffu);
    s.time_near(m.true_at);
    s.varint(m.newest_operator_sample);
    s.require(m.newest_operator_sample <= plausible::max_sequence);
    whole_fields(s, m.force, force_quantum, plausible::max_force);
    whole_fields(s, m.torque, torque_quantum, plausible::max_torque);
    enum : std::uint8_t { largest = 3, fixed = 4 };
    std::uint8_t bits = 0;
    if constexpr (!Stream::reads) {
        bits = static_cast<std::uint8_t>(largest_part(m.tool.rotation) | (m.fixed ? fixed : 0));
    }
    s.integer(bits);
    s.require(bits <= (largest | fixed));
    whole_fields(s, m.tool.position, position_quantum, plausible::max_position);
    if (s.good()) {
        rotation_fields(s, m.tool.rotation, bits & largest);
    }
    std::uint64_t object = m.object == no_object ? 0 : std::uint64_t{m.object} + 1;  // 0: none
    s.varint(object);
    s.require(object <= no_object);
    if constexpr (Stream::reads) {
        m.fixed = (bits & fixed) != 0;
        m.pointer = static_cast<std::uint16_t>(pointer);
        m.object = object == 0 ? no_object : static_cast<ObjectId>(object - 1);
    }
}

template <typename Stream>
void ghost_fields(Stream& s, auto& m) {
    enum : std::uint8_t { touching = 1 };
    std::uint64_t pointer = m.pointer;
    s.varint(pointer);
    std::uint8_t flags = m.touches ? touching : 0;
    s.integer(flags);
    s.require(pointer <= 0xffffu && (flags & ~touching) == 0);
    whole_fields(s, m.position, position_quantum, plausible::max_position);
    s.require(m.radius >= 0.0 && m.radius <= max_ghost_radius);  // false for what is no number
    std::uint64_t radius = s.good() ? static_cast<std::uint64_t>(std::llround(m.radius / radius_quantum)) : 0;
    s.varint(radius);
    s.require(static_cast<double>(radius) <= max_ghost_radius / radius_quantum);
    if constexpr (Stream::reads) {
        m.pointer = static_cast<std::uint16_t>(pointer);
        m.touches = (flags & touching) != 0;
        m.radius = s.good() ? static_cast<double>(radius) * radius_quantum : 0.0;
    }
}

// The diagonal, then what stands above it by rows.
template <typename Stream>
void covariance_fields(Stream& s, auto& c) {
    constexpr int places[6][2] = {{0, 0}, {1, 1}, {2, 2}, {1, 0}, {2, 0}, {2, 1}};
    for (const auto& [i, j] : places) {
        auto single = static_cast<float>(c[i][j]);
        s.real(single, i == j ? 0.0F : -static_cast<float>(max_estimate), static_cast<float>(max_estimate));
        if constexpr (Stream::reads) {
            c[i][j] = c[j][i] = s.good() ? static_cast<double>(single) : 0.0;
        }
    }
}

template <typename Stream>
void touch_value_fields(Stream& s, auto& m, bool known) {
    if (known) {
        auto value = static_cast<float>(m.value), deviation = static_cast<float>(m.deviation);
        s.real(value, 0.0F, static_cast<float>(max_estimate));
        s.real(deviation, 0.0F, static_cast<float>(max_estimate));
        if constexpr (Stream::reads) {
            m.value = s.good() ? static_cast<double>(value) : 0.0;
            m.deviation = s.good() ? static_cast<double>(deviation) : 0.0;
        }
    }
    if constexpr (Stream::reads) {
        m = known ? m : TouchValue{};
        m.known = known;
    }
}

template <typename Stream>
void object_estimate_fields(Stream& s, auto& m) {
    enum : std::uint8_t { doubted = 1, stiff = 2, rough = 4, heavy = 8, any = 15 };
    object_fields(s, m.object);
    std::uint8_t flags = 0;
    if constexpr (!Stream::reads) {
        flags = static_cast<std::uint8_t>((m.has_doubt ? doubted : 0) | (m.stiffness.known ? stiff : 0) |
                                          (m.friction.known ? rough : 0) | (m.mass.known ? heavy : 0));
    }
    s.integer(flags);
    s.require((flags & ~any) == 0);
    if constexpr (Stream::reads) {
        m.has_doubt = (flags & doubted) != 0;
        m.doubt = {};
    }
    if ((flags & doubted) != 0) {
        covariance_fields(s, m.doubt.place);
        covariance_fields(s, m.doubt.turn);
        s.require(is_sound(m.doubt));
    }
    touch_value_fields(s, m.stiffness, (flags & stiff) != 0);
    touch_value_fields(s, m.friction, (flags & rough) != 0);
    touch_value_fields(s, m.mass, (flags & heavy) != 0);
}

// A sample in whole numbers.
struct WholeSample {
    WholeVector position{}, velocity{}, force{}, relative{}, spin{};
    WholeTurn turn;
};

// What a packet has told so far of a pointer, the newest first: the next sample is told from it.
struct ToldSamples {
    WholeSample last, before;
    std::int64_t apart = 0;  // of the two (unit: samples); 0: `last` is the first
};

// What has changed evenly goes on doing so.
inline WholeVector carried_on(const WholeVector& last, const WholeVector& before, bool evenly) {
    WholeVector result = last;
    for (std::size_t i = 0; evenly && i < 3; ++i) {
        result[i] += last[i] - before[i];
    }
    return result;
}

inline WholeSample expected_from(const ToldSamples& told, std::int64_t apart) {
    const bool evenly = told.apart == apart;
    WholeSample expected;
    expected.velocity = carried_on(told.last.velocity, told.before.velocity, evenly);
    expected.force = carried_on(told.last.force, told.before.force, evenly);
    expected.relative = carried_on(told.last.relative, told.before.relative, evenly);
    expected.spin = carried_on(told.last.spin, told.before.spin, evenly);
    const bool same_parts = told.last.turn.largest == told.before.turn.largest;
    expected.turn.largest = told.last.turn.largest;
    expected.turn.parts = carried_on(told.last.turn.parts, told.before.turn.parts, evenly && same_parts);
    return expected;
}

// How a hand that holds a tool is turned and turns.
template <typename Stream, typename Sample>
void sample_turn(Stream& s, Sample& m, WholeSample& number, const WholeSample& expected) {
    std::uint8_t largest = 0;
    if constexpr (!Stream::reads) {
        number.turn = whole_turn(m.rotation);
        largest = number.turn.largest;
    }
    s.integer(largest);
    s.require(largest < 4);
    number.turn.largest = s.good() ? largest : 0;
    const bool same_parts = expected.turn.largest == number.turn.largest;
    turn_fields(s, m.rotation, number.turn, same_parts ? expected.turn.parts : WholeVector{});
    whole_fields(s, m.spin, number.spin, expected.spin, spin_quantum, plausible::max_angular_speed);
}

// Where the hand was `later` nanoseconds before, had its velocity changed evenly since: 1e-6 m/s times 1e-9 s
// is a millionth of 1e-9 m.
inline WholeVector carried_back(const WholeSample& from, const WholeVector& velocity, std::int64_t later) {
    constexpr std::int64_t per_quantum = 2'000'000;  // of the sum of two velocities
    WholeVector result{};
    for (std::size_t i = 0; i < 3; ++i) {
        result[i] = from.position[i] - (from.velocity[i] + velocity[i]) * later / per_quantum;
    }
    return result;
}

enum SampleFlag : std::uint8_t {
    sample_connected = 1,
    sample_follows = 2,  // is told from the one before it, of the same pointer
    sample_buttons = 4,
    sample_force = 8,
    sample_nearest = 16,
    sample_time = 32,  // is not taken when its place in the sequence says
    sample_next = 64,  // follows, and is of the tick just before
    sample_turn_told = 128,
};

// The farthest that a sample is told from another one (unit: nanoseconds).
inline constexpr std::int64_t max_sample_step = nanoseconds_per_second;

inline bool can_follow(const OperatorSample& before, const OperatorSample& sample, Nanoseconds period) {
    const auto apart = static_cast<std::int64_t>(before.sequence - sample.sequence);
    return before.pointer == sample.pointer && apart > 0 && apart <= max_sample_step / period;
}

// One sample; `before`: the one that stands before it in the packet, null for the first.
template <typename Stream, typename Sample>
void operator_sample(Stream& s, Sample& m, const OperatorSample* before, ToldSamples& told,
                     Nanoseconds period) {
    std::uint8_t flags = 0;
    Nanoseconds expected_time = s.sent_at();
    std::int64_t apart = 0;
    if constexpr (!Stream::reads) {
        const bool follows = before != nullptr && can_follow(*before, m, period);
        apart = follows ? static_cast<std::int64_t>(before->sequence - m.sequence) : 0;
        expected_time = follows ? before->time - apart * period : expected_time;
        flags = static_cast<std::uint8_t>(
            (m.connected ? sample_connected : 0) | (follows ? sample_follows : 0) |
            (apart == 1 ? sample_next : 0) | (m.buttons != 0 ? sample_buttons : 0) |
            (m.force != Vec3(0.0) ? sample_force : 0) | (m.nearest_object != no_object ? sample_nearest : 0) |
            (m.time != expected_time ? sample_time : 0) | (m.has_turn ? sample_turn_told : 0));
    }
    s.integer(flags);
    const bool follows = (flags & sample_follows) != 0;
    const bool is_next = (flags & sample_next) != 0;
    s.require((!follows || before != nullptr) && (follows || !is_next));
    std::uint64_t pointer = m.pointer;
    std::uint64_t place = is_next ? 1 : follows ? static_cast<std::uint64_t>(apart) : m.sequence;
    if (follows && s.good()) {
        if (!is_next) {
            s.varint(place);
            s.require(place >= 2);
        }
        s.require(place <= static_cast<std::uint64_t>(max_sample_step / period) && place < before->sequence);
    } else {
        s.varint(pointer);
        s.varint(place);
        s.require(pointer <= 0xffffu && place >= 1 && place <= plausible::max_sequence);
    }
    if (!s.good()) {
        return;
    }
    if constexpr (Stream::reads) {
        apart = follows ? static_cast<std::int64_t>(place) : 0;
        m.pointer = follows ? before->pointer : static_cast<std::uint16_t>(pointer);
        m.sequence = follows ? before->sequence - place : place;
        m.connected = (flags & sample_connected) != 0;
        expected_time = follows ? before->time - apart * period : expected_time;
    }
    std::int64_t beside = m.time - expected_time;
    if ((flags & sample_time) != 0) {
        s.folded_varint(beside);
    } else {
        beside = 0;
    }
    s.require(beside >= -plausible::max_age && beside <= plausible::max_age);
    if constexpr (Stream::reads) {
        m.time = s.good() ? expected_time + beside : 0;
    }
    const WholeSample expected = follows ? expected_from(told, apart) : WholeSample{};
    WholeSample number;
    whole_fields(s, m.velocity, number.velocity, expected.velocity, velocity_quantum, plausible::max_speed);
    const WholeVector place_then =
        follows ? carried_back(told.last, number.velocity, apart * period) : WholeVector{};
    whole_fields(s, m.position, number.position, place_then, position_quantum, plausible::max_position);
    std::uint64_t buttons = m.buttons;
    if ((flags & sample_buttons) != 0) {
        s.varint(buttons);
        s.require(buttons >= 1 && buttons <= 0xffff'ffffu);
    }
    if ((flags & sample_force) != 0) {
        whole_fields(s, m.force, number.force, expected.force, force_quantum, plausible::max_force);
    }
    if ((flags & sample_nearest) != 0) {
        object_fields(s, m.nearest_object);
        whole_fields(s, m.position_in_object, number.relative, expected.relative, position_quantum,
                     plausible::max_position);
    }
    if constexpr (Stream::reads) {
        m.has_turn = (flags & sample_turn_told) != 0;
        m.rotation = Quat(1.0, 0.0, 0.0, 0.0);
        m.spin = Vec3(0.0);
    }
    if (m.has_turn) {
        sample_turn(s, m, number, expected);
    }
    told = {number, told.last, apart};
    if constexpr (Stream::reads) {
        m.buttons = (flags & sample_buttons) != 0 ? static_cast<std::uint32_t>(buttons) : 0;
        m.force = (flags & sample_force) != 0 ? m.force : Vec3(0.0);
        m.nearest_object = (flags & sample_nearest) != 0 ? m.nearest_object : no_object;
        m.position_in_object = (flags & sample_nearest) != 0 ? m.position_in_object : Vec3(0.0);
    }
}

template <typename Stream>
void operator_sample_fields(Stream& s, auto& m) {
    ToldSamples told;
    for (std::size_t i = 0; s.good() && i < m.count; ++i) {
        operator_sample(s, m.samples[i], i > 0 ? &m.samples[i - 1] : nullptr, told, m.period);
    }
}

}  // namespace tactus
