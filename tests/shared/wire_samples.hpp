// One message of each kind with values that differ in every field, for tests of the wire; after them operator
// samples again, of a tool.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "network/messages.hpp"

namespace tactus::samples {

inline constexpr PacketHeader header{0x0102030405060708u, 77, -123'456'789};

inline ContentHash hash() {
    ContentHash hash;
    for (std::size_t i = 0; i < hash.size(); ++i) {
        hash[i] = static_cast<std::uint8_t>(0xa0 + i);
    }
    return hash;
}

inline constexpr std::array<std::byte, 5> piece{std::byte{1}, std::byte{2}, std::byte{3}, std::byte{4},
                                                std::byte{5}};

inline ObjectState state(ObjectId object) {
    const double shift = object;
    return {object,
            object % 2 == 1,
            {{0.5 + shift, -1.25, 2.0}, {0.8, -0.4, 0.4, -0.2}},
            {0.125, -0.25, 0.375 + shift},
            {-4.0, 5.5, 6.25}};
}

inline OperatorSample hand(SampleSequence sequence) {
    OperatorSample sample;
    sample.sequence = sequence;
    sample.time = 1'000'000 * static_cast<Nanoseconds>(sequence);
    sample.pointer = 1;
    sample.connected = true;
    sample.buttons = 0x80000001u;
    sample.position = {0.01, 0.02, 0.03};
    sample.velocity = {-0.1, 0.2, -0.3};
    sample.force = {1.5, -2.5, 3.5};
    sample.nearest_object = 7;
    sample.position_in_object = {0.001, 0.002, -0.003};
    return sample;
}

// Of a hand that holds the second tool.
inline OperatorSample tool(SampleSequence sequence) {
    OperatorSample sample = hand(sequence);
    sample.pointer = first_tool + 1;
    sample.force = sample.position_in_object = Vec3(0.0);
    sample.nearest_object = no_object;
    sample.buttons = 0;
    sample.has_turn = true;
    sample.rotation = rotation_as_sent(glm::normalize(Quat(0.8, -0.4, 0.4, -0.2)));
    sample.spin = {0.5, -1.25, 2.0};
    return sample;
}

// A force on the first pointer, up.
inline ForceSamples force(double newtons) {
    ForceSamples forces{1, {}};
    forces.samples[0].newest_operator_sample = 1;
    forces.samples[0].force = {0.0, newtons, 0.0};
    return forces;
}

inline std::vector<Message> one_of_each() {
    ObjectStates states{5'000'000, 42, 2, {}};
    states.states[0] = state(3);
    states.states[1] = state(4);
    states.states[1].linear_velocity = states.states[1].angular_velocity = Vec3(0.0);
    OperatorSamples samples{1'000'000, 5, {}};
    samples.samples[0] = hand(43);
    samples.samples[1] = hand(42);
    samples.samples[1].position.x = 0.0101;
    samples.samples[1].velocity.y = 0.25;
    samples.samples[2] = hand(41);
    samples.samples[2].velocity.y = 0.31;
    samples.samples[3] = hand(38);
    samples.samples[4] = hand(43);
    samples.samples[4].pointer = 0;
    samples.samples[4].force = Vec3(0.0);
    samples.samples[4].buttons = 0;
    samples.samples[4].nearest_object = no_object;
    samples.samples[4].position_in_object = Vec3(0.0);
    ForceSamples forces{2, {}};
    forces.samples[0] = {2, 5'000'000, 41, {0.1, 0.2, -0.3}, {1.0, 2.0, 3.0}, 4};
    forces.samples[1] = {3, -123'456'789, 0, {0.0, -5.25, 0.0}, {-1.0, 0.0, 0.25}, no_object};
    WrenchSamples wrenches{2, {}};
    wrenches.samples[0] = {
        17, 5'000'000, 41, {0.1, 0.2, -0.3}, {0.25, -0.5, 1e-6}, {{1.0, 2.0, 3.0}, {0.8, -0.4, 0.4, -0.2}},
        4};
    wrenches.samples[1] = {
        16,        -123'456'789, 0, {0.0, -5.25, 0.0}, Vec3(0.0), {{-1.0, 0.0, 0.25}, {0.0, 0.6, 0.0, 0.8}},
        no_object, true};
    OperatorSamples tools{1'000'000, 4, {}};
    tools.samples[0] = tool(43);
    tools.samples[1] = tool(42);
    tools.samples[1].rotation = rotation_as_sent(glm::normalize(Quat(0.81, -0.41, 0.38, -0.2)));
    tools.samples[1].spin.y = -1.0;
    tools.samples[2] = tool(41);
    tools.samples[2].rotation = rotation_as_sent(glm::normalize(Quat(0.3, -0.41, 0.88, -0.2)));
    tools.samples[3] = tool(39);
    ObjectEstimate seen;
    seen.object = 5;
    seen.has_doubt = true;
    seen.doubt.place = Mat3(Vec3(0.25, 0.125, 0.0), Vec3(0.125, 0.5, -0.0625), Vec3(0.0, -0.0625, 0.125));
    seen.doubt.turn = Mat3(0.5);
    seen.mass = {0.75, 0.0625, true};
    ObjectEstimate felt;
    felt.object = 300;
    felt.stiffness = {512.0, 8.0, true};
    felt.friction = {0.25, 0.03125, true};
    Terms terms;
    terms.scenario = 3;
    terms.passivity = 1;
    terms.impedance = 4.5;
    terms.bodies = 300;
    terms.hands[0] = {HandTerms::Kind::fingertip, 0.0105, 0};
    terms.hands[2] = {HandTerms::Kind::fingertip, 0.005, 0};
    terms.hands[first_tool] = {HandTerms::Kind::tool, 0.0, 0x0102030405060708u};
    return {
        Hello{
            Side::teleoperator_side, 2, 1'000'000, 0x1122334455667788u, 9, {0.0, -9.5, 0.25}, 2, 3, 300, 321},
        Bye{},
        ClockRequest{12, 1'000'000'007},
        ClockAnswer{12, 1'000'000'007, -5, 6},
        DiscoveryFragment{7, 3, hash(), 1024 + 5, 1024, piece},
        ObjectRemoval{8, 4, hash()},
        DiscoveryAcknowledgement{9, hash(), DiscoveryVerdict::no_room},
        states,
        samples,
        forces,
        Ghosts{2, {Ghost{1, true, {0.5, -1.25, 2.0}, 0.01}, Ghost{3, false, {0.0, 0.125, -3.0}, 0.0055}}},
        ObjectEstimates{2, {seen, felt}},
        wrenches,
        SampleAcknowledgements{2, {SampleAcknowledgement{1, 300}, SampleAcknowledgement{17, 5}}},
        terms,
        tools,
    };
}

}  // namespace tactus::samples
