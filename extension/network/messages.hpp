// What the two sides say to each other, as plain values, and their form on the wire (docs/wire_format.md).
//
// One datagram is one packet: a header and one message. Encoding and decoding allocate nothing, except where
// an ObjectDescription is made or read: that is of any size, travels in fragments and belongs off the loop.
//
// Every position, velocity and force is in the frame of the HapticWorld. Times are the sender's own clock
// (unit: nanoseconds) unless said otherwise.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "core/estimation/touch_value.hpp"
#include "core/haptics/touch_material.hpp"
#include "core/math/pose.hpp"
#include "core/ports/link.hpp"
#include "core/teleop/seen_pose.hpp"
#include "network/sides.hpp"
#include "network/terms.hpp"
#include "physics/body_description.hpp"
#include "physics/joint.hpp"

namespace tactus {

inline constexpr std::uint8_t wire_version = 4;
// The oldest one that is still understood, both as reader and as writer.
inline constexpr std::uint8_t oldest_wire_version = 3;

// Given by the teleoperator. One that was removed may be given to another object, with a higher revision.
using ObjectId = std::uint32_t;
inline constexpr ObjectId no_object = 0xffff'ffffu;
// What joins two bodies is described like a body, under a number of its own from here on.
inline constexpr ObjectId first_joint = 0x8000'0000u;
constexpr bool is_joint(ObjectId object) {
    return object >= first_joint && object != no_object;
}

// Of operator samples: counts up from 1 within an epoch of the operator.
using SampleSequence = std::uint64_t;
inline constexpr SampleSequence no_sample = 0;

// Both sides say what must be alike (terms.hpp) since then.
inline constexpr std::uint8_t first_version_with_terms = 4;

struct PacketHeader {
    std::uint64_t epoch = 0;     // of the sender: another one at each start, never 0
    std::uint64_t sequence = 0;  // of the sender's packets of all kinds, counts up from 1 within an epoch
    Nanoseconds sent_at = 0;
};

// Repeated a few times a second: says that the sender lives, and whom it hears.
struct Hello {
    Side side = Side::operator_side;
    std::uint8_t scenario = 4;       // 2 traditional, 4 model-mediated (design: 1 … 5)
    Nanoseconds period = 1'000'000;  // of the sender's tick, > 0
    std::uint64_t heard_epoch = 0;   // the epoch of the other side, as heard last; 0: never
    std::uint32_t object_count = 0;  // objects that the sender has described or is about to
    Vec3 gravity{0.0, -9.81, 0.0};   // (unit: meters per second squared)
    // Versions that the sender speaks: the two use the newest that both do.
    std::uint8_t oldest_version = oldest_wire_version;
    std::uint8_t newest_version = wire_version;
    // Of the other side's epoch: packets that have come up to a sequence, without copies, and that sequence,
    // far enough back that what was overtaken has come as well (SequenceWindow::settled). Tells it what is
    // lost on its way here.
    std::uint64_t heard_packets = 0;
    std::uint64_t heard_sequence = 0;
};

// The sender stops: nothing of its epoch follows.
struct Bye {};

// Four timestamps: t0 the asking side's, t1 and t2 the answering side's, t3 the arrival of the answer.
struct ClockRequest {
    std::uint32_t number = 0;
    Nanoseconds t0 = 0;
};
struct ClockAnswer {
    std::uint32_t number = 0;  // of the request
    Nanoseconds t0 = 0;        // from the request
    Nanoseconds t1 = 0;        // arrival of the request
    Nanoseconds t2 = 0;        // departure of this answer
};

// 128 bits of BLAKE2b over the bytes of a description: what was described, and whether all of it arrived.
using ContentHash = std::array<std::uint8_t, 16>;

// A piece of an encoded ObjectDescription. All pieces but the last are of max_fragment_bytes.
struct DiscoveryFragment {
    ObjectId object = no_object;
    std::uint32_t revision = 0;  // the highest for an object is the one that holds
    ContentHash hash{};
    std::uint32_t total_bytes = 0;     // of the whole description, 1 … max_description_bytes
    std::uint32_t offset = 0;          // of this piece in it, a multiple of max_fragment_bytes
    std::span<const std::byte> bytes;  // points into the datagram
};
inline constexpr std::size_t max_fragment_bytes = 1024;
inline constexpr std::uint32_t max_description_bytes = 16u << 20;

// The object does not exist any more. `hash`: of its last description.
struct ObjectRemoval {
    ObjectId object = no_object;
    std::uint32_t revision = 0;  // higher than that of its description
    ContentHash hash{};
};

enum class DiscoveryVerdict : std::uint8_t {
    known = 0,    // complete and in the model
    refused = 1,  // complete, but what it says cannot be built
    no_room = 2,  // too large, or too many
    removed = 3,  // answers an ObjectRemoval
};

struct DiscoveryAcknowledgement {
    ObjectId object = no_object;
    ContentHash hash{};
    DiscoveryVerdict verdict = DiscoveryVerdict::known;
};

struct ObjectState {
    ObjectId object = no_object;
    bool asleep = false;
    Pose pose;
    Vec3 linear_velocity{0.0};   // of the centre of mass (unit: meters per second)
    Vec3 angular_velocity{0.0};  // (unit: radians per second)
};

// Newest wins, for each object: the one with the later `true_at`. States of more objects than one message
// holds follow in further messages of the same times.
struct ObjectStates {
    static constexpr std::size_t max_count = 16;

    Nanoseconds true_at = 0;                            // after the tick of this time
    SampleSequence newest_operator_sample = no_sample;  // that had been applied by then
    std::uint8_t count = 0;                             // 0 … max_count
    std::array<ObjectState, max_count> states{};
};

// What a hand does at one tick of the operator.
struct PointerSample {
    SampleSequence sequence = no_sample;
    Nanoseconds time = 0;
    std::uint16_t pointer = 0;  // which of the operator's pointers, from 0
    bool connected = false;     // the device is there
    std::uint32_t buttons = 0;  // bit i: button i is held
    Vec3 position{0.0};         // of the hand (unit: meters)
    Vec3 velocity{0.0};         // (unit: meters per second)
    Vec3 force{0.0};            // on the hand (unit: newtons)
    ObjectId nearest_object = no_object;
    Vec3 position_in_object{0.0};  // of the hand, in the frame of the nearest object (unit: meters)
};

// The same of a hand that may hold a tool: then position, velocity and rotation are those of the tool where
// the hand would have it. Tools have pointer numbers of their own, from first_tool on.
struct OperatorSample : PointerSample {
    bool has_turn = false;  // else a fingertip's, and what follows means nothing
    Quat rotation{1.0, 0.0, 0.0, 0.0};
    Vec3 spin{0.0};  // how it turns (unit: radians per second)
};
inline constexpr std::uint16_t first_tool = 16;

// What is sent often is rounded to these.
inline constexpr double position_quantum = 1e-9;  // (unit: meters)
inline constexpr double velocity_quantum = 1e-6;  // (unit: meters per second)
inline constexpr double force_quantum = 1e-4;     // (unit: newtons)
inline constexpr double spin_quantum = 1e-6;      // (unit: radians per second)
inline constexpr double torque_quantum = 1e-6;    // (unit: newton meters)

// What the other side reads of a position, a velocity, and of how a hand with a tool is turned and turns.
// Rounds once: of what it gives it gives the same.
Vec3 position_as_sent(const Vec3& position);
Vec3 velocity_as_sent(const Vec3& velocity);
Quat rotation_as_sent(const Quat& rotation);
Vec3 spin_as_sent(const Vec3& spin);

// Of any pointers: the newest sample and, where the sender wants to survive losses, some older ones. What
// follows a sample of the same pointer is told as what differs from it: newest first takes fewest bytes.
// Tools' are in packets of their own, which a reader that knows no tools refuses.
struct OperatorSamples {
    static constexpr std::size_t max_count = 16;

    Nanoseconds period = 1'000'000;  // of the sender's tick, > 0
    std::uint8_t count = 0;          // 1 … max_count
    std::array<OperatorSample, max_count> samples{};
};

// The force that the far side gives back to a pointer (scenarios 2 and 3).
struct ForceSample {
    std::uint16_t pointer = 0;
    Nanoseconds true_at = 0;
    SampleSequence newest_operator_sample = no_sample;  // that the force answers
    Vec3 force{0.0};                                    // on the hand (unit: newtons)
    Vec3 proxy{0.0};                                    // where the far side's fingertip is (unit: meters)
    ObjectId object = no_object;                        // that is touched
    // That the far end has taken in so far from the environment (unit: energy_quantum); begins again after
    // 2^32. In an extension: 0 where a side of an older version has told none.
    std::uint32_t taken = 0;
};
inline constexpr double energy_quantum = 1e-7;  // (unit: joules)
// `energy` >= 0 (unit: joules). Rounded down: no more is told than there is.
inline std::uint32_t told_energy(double energy) {
    return static_cast<std::uint32_t>(static_cast<std::uint64_t>(energy / energy_quantum));
}

struct ForceSamples {
    static constexpr std::size_t max_count = 16;
    static constexpr std::uint8_t taken_tag = 1;  // of the extension with `taken` of each sample

    std::uint8_t count = 0;  // 1 … max_count
    std::array<ForceSample, max_count> samples{};
};

// The same for a tool, with its torque.
struct WrenchSample {
    std::uint16_t pointer = 0;
    Nanoseconds true_at = 0;
    SampleSequence newest_operator_sample = no_sample;  // that the wrench answers
    Vec3 force{0.0};                                    // on the hand (unit: newtons)
    Vec3 torque{0.0};             // likewise, about where it would have the tool (unit: newton meters)
    Pose tool;                    // where the far side's tool is
    ObjectId object = no_object;  // that is touched
    bool fixed = false;           // what holds it there cannot turn: nor does the operator's
};

struct WrenchSamples {
    static constexpr std::size_t max_count = 8;

    std::uint8_t count = 0;  // 1 … max_count
    std::array<WrenchSample, max_count> samples{};
};

// A fingertip of another operator in the same environment: something to be seen, nothing to be felt.
struct Ghost {
    std::uint16_t pointer = 0;  // of the environment's pointers, from 0
    bool touches = false;
    Vec3 position{0.0};   // of its centre (unit: meters)
    double radius = 0.0;  // (unit: meters), 0 … max_ghost_radius
};
inline constexpr double max_ghost_radius = 1e3;
inline constexpr double radius_quantum = 1e-6;       // (unit: meters)
inline constexpr double fine_radius_quantum = 1e-9;  // where both sides must agree (unit: meters)
// Of wave variables, as it is sent, and the most that is (unit: newton-seconds per meter).
inline constexpr double impedance_quantum = 1e-6, max_impedance = 1e6;

// All that there are. Nothing is said where there are none.
struct Ghosts {
    static constexpr std::size_t max_count = 16;

    std::uint8_t count = 0;  // 1 … max_count
    std::array<Ghost, max_count> ghosts{};
};

// What the far side has found out about an object, and how sure it is.
struct ObjectEstimate {
    ObjectId object = no_object;
    bool has_doubt = false;  // its places are seen, with `doubt`; else they are known
    PoseDoubt doubt;
    // Of those that are known:
    TouchValue stiffness;  // (unit: newtons per meter)
    TouchValue friction;   // of a pointer on it, while it slides (dimensionless)
    TouchValue mass;       // (unit: kilograms)
};
inline constexpr double max_estimate = 1e6;  // of any of these

struct ObjectEstimates {
    static constexpr std::size_t max_count = 8;

    std::uint8_t count = 0;  // 1 … max_count
    std::array<ObjectEstimate, max_count> estimates{};
};

// The newest sample of each hand that has come and stands (core/teleop/deadband.hpp): the operator need not
// repeat it any more.
struct SampleAcknowledgement {
    std::uint16_t pointer = 0;
    SampleSequence sequence = no_sample;
};
struct SampleAcknowledgements {
    static constexpr std::size_t max_count = 24;

    std::uint8_t count = 0;  // 1 … max_count
    std::array<SampleAcknowledgement, max_count> samples{};
};

using Message = std::variant<Hello, Bye, ClockRequest, ClockAnswer, DiscoveryFragment, ObjectRemoval,
                             DiscoveryAcknowledgement, ObjectStates, OperatorSamples, ForceSamples, Ghosts,
                             ObjectEstimates, WrenchSamples, SampleAcknowledgements, Terms>;

struct Packet {
    PacketHeader header;
    Message message;
};

// Why a datagram was not believed.
enum class Refusal : std::uint8_t {
    none,
    truncated,    // shorter than what it says it is
    oversized,    // longer than what it says it is, or than a message may be
    wrong_magic,  // not one of ours
    sealed,       // encrypted, and this side has no key
    wrong_version,
    unknown_type,
    not_finite,    // a NaN or an infinity
    out_of_range,  // a number outside its documented range
    count
};

// Counts by reason. Belongs to one thread; publish a copy.
struct RefusalCounts {
    std::array<std::uint64_t, static_cast<std::size_t>(Refusal::count)> by_reason{};

    void add(Refusal refusal) { ++by_reason[static_cast<std::size_t>(refusal)]; }
    std::uint64_t of(Refusal refusal) const { return by_reason[static_cast<std::size_t>(refusal)]; }
    std::uint64_t total() const;  // without `none`
};

// The bytes written, at most max_message_bytes; 0 where `into` is too short or the message breaks a range
// that is documented above (a NaN from a broken device must not travel).
std::size_t encode(const PacketHeader& header, const Message& message, std::span<std::byte> into);

// `packet` is valid only where the result is none. A DiscoveryFragment points into `datagram`.
Refusal decode(std::span<const std::byte> datagram, Packet& packet);

// Everything the far side needs to build an object of its own.
struct ObjectDescription {
    ObjectId object = no_object;
    std::string name;  // UTF-8, at most max_name_bytes: the node's path below its HapticWorld
    BodyDescription body;
    std::vector<PlacedShape> touch_shapes;  // what is touched, in the body's frame; empty: the body's shapes
    TouchMaterial touch;                    // its detail, if any, points to `detail`
    std::shared_ptr<const TouchDetail> detail;  // but for surfaces
};
inline constexpr std::size_t max_name_bytes = 1024;

// Off the loop. Empty where the description breaks a range (see docs/wire_format.md) or would be longer than
// max_description_bytes.
std::vector<std::byte> encode_description(const ObjectDescription& description);

// Off the loop. `description` is valid only where the result is none.
Refusal decode_description(std::span<const std::byte> bytes, ObjectDescription& description);

// What joins two objects, or one and the scene. The frames are those of the two objects, or of the scene;
// where one came from may be no more: it joins again what is described again.
struct ObjectJoint {
    ObjectId object = no_object;  // is_joint()
    ObjectId first = no_object;
    ObjectId second = no_object;  // no_object: the scene
    JointDescription joint;       // with a second frame
};

inline constexpr double max_motor_torque = 1e9;  // (unit: newton meters)

// Off the loop. Empty where it breaks a range.
std::vector<std::byte> encode_joint(const ObjectJoint& joint);

// Off the loop. `joint` is valid only where the result is none.
Refusal decode_joint(std::span<const std::byte> bytes, ObjectJoint& joint);

ContentHash content_hash(std::span<const std::byte> bytes);

}  // namespace tactus
