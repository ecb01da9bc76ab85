// What the owner of a session and a side of its teleoperation say to each other while the loop runs.
//
// Threads: into settings, bindings, announced and withdrawn the owner writes and the loop reads; statistics
// and released go the other way; `discovery` says itself who calls what. Nobody waits.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "core/ports/link.hpp"
#include "core/safety/force_exit.hpp"
#include "core/teleop/control_scheme.hpp"
#include "core/teleop/deadband.hpp"
#include "core/teleop/derivation.hpp"
#include "core/teleop/errors.hpp"
#include "core/teleop/felt_pointer.hpp"
#include "core/teleop/jitter_buffer.hpp"
#include "core/teleop/parameter_estimate.hpp"
#include "core/teleop/passive_update.hpp"
#include "core/teleop/passivity.hpp"
#include "core/teleop/pose_filter.hpp"
#include "core/teleop/residual_motion.hpp"
#include "core/teleop/seen_pose.hpp"
#include "core/teleop/stealth.hpp"
#include "network/discovery_receiver.hpp"
#include "network/discovery_sender.hpp"
#include "network/endpoint.hpp"
#include "realtime/spsc_ring.hpp"
#include "realtime/triple_buffer.hpp"
#include "session/ghosts.hpp"
#include "session/session_types.hpp"

namespace tactus {

// All of it may change while the loop runs.
struct TeleopSettings {
    bool traditional = false;  // scenarios 2 and 3: positions one way, forces back
    bool robot = false;        // scenarios 3 and 5: the environment is real, and a robot is there
    Derivation derivation = Derivation::resimulate;
    Correction correction = Correction::stealthy_direction;
    ControlScheme control = ControlScheme::spring;
    MotionThreshold threshold;
    StealthSettings stealth;
    EstimateSettings estimate;              // with re-simulation
    ResidualSettings residual;              // with re-simulation
    PoseFilterSettings filter;              // with re-simulation
    SeenPoseSettings seen;                  // of what the far side says how surely it sees
    ForceLimits limits;                     // of what leaves for the devices
    Passivity passivity = Passivity::none;  // of traditional touch
    PassivitySettings passive;
    PassiveUpdateSettings update;  // with Correction::passive
    StandInSettings stand_in;
    DeadbandSettings deadband;
    std::uint32_t buffer_depth = 0;     // samples that the far side keeps in hand at the start, 0 … 200
    bool newest_wins = false;           // far side: the newest sample is played at once, without a playout
    std::uint32_t states_every = 5;     // ticks between states of what moves, >= 1
    std::uint32_t refresh_every = 200;  // ticks between states of what rests, >= 1
    std::uint32_t repeats = 16;         // samples in one packet, the newest and older ones, 1 … 16
    Vec3 gravity{0.0, -9.81, 0.0};      // far side: of its world (unit: meters per square second)
    ClockSkew skew;                     // of this side's clock, as an experiment
    Pose frame;            // of this side's world in its scene: what is sent is relative to it, on both sides
    bool leaving = false;  // says bye, once
    std::uint32_t replay_steps = 32;  // ticks of the past that are replayed in one tick, >= 1
    // Far side: that states and descriptions of bodies keep to, with all headers (unit: bits per second), >=
    // 0; 0: no limit; see least_body_rate.
    double body_rate = 0.0;
};

// As the two sides tell each other.
inline std::uint8_t scenario_of(const TeleopSettings& settings) {
    return settings.traditional ? (settings.robot ? 3 : 2) : (settings.robot ? 5 : 4);
}

// What a pointer feels besides its model.
struct FeltFigures {
    FeltState state = FeltState::together;
    double offset = 0.0;  // how far it is carried (unit: meters)
    double hidden = 0.0;  // what is hidden of its force (unit: newtons)
};

// What a far side has to say of where its bodies are.
struct StateLoad {
    double wanted = 0.0;  // that all that is due would take (unit: bits per second)
    double oldest = 0.0;  // since a body that is due was said last (unit: seconds)
};

// How far the far side is with its first description of what it has.
enum class FirstDescription : std::uint8_t { awaited, begun, whole };

struct TeleopStatistics {
    std::uint64_t sample = 0;  // operator: the newest of its own; far side: the newest applied
    LinkStatistics link;
    DiscoveryCounts discovery;          // far side
    StateLoad load;                     // far side
    std::uint64_t unknown_objects = 0;  // states of objects that are not there
    std::uint64_t stale_states = 0;     // older than what is known
    std::uint64_t corrections = 0;      // ticks in which the model was corrected
    std::uint64_t replays = 0;          // that were begun
    double round_trip = 0.0;            // from a sample to what answers it (unit: seconds)
    CorrectionCost cost;                // of the last tick
    CorrectionCost spent;               // the sum over all ticks before
    double largest_force_step = 0.0;    // (unit: newtons)
    // What has left for a hand changed by in a tick, besides what the hand's own motion has done (unit:
    // newtons).
    double largest_unexplained_step = 0.0;
    double offset = 0.0;  // how far the pointers are carried (unit: meters)
    std::array<FeltFigures, max_proxies> pointers;
    std::uint64_t let_go = 0;  // times that a pointer has begun to let go of what was too large to hide
    EnergyFigures energy;
    std::uint64_t without_past = 0;  // states of moving bodies for which there is no room in the model's past
    std::uint64_t beyond_history = 0;  // operator: states of moving bodies older than the model's past
    FirstDescription description = FirstDescription::awaited;  // operator: the far side's first
    SeenGhosts ghosts;                                         // operator: the hands of others
    double doubt = 0.0;  // operator: of a place that is touched, as the far side sees it, standard
                         // deviation (unit: meters)
    BufferCounts buffer;
    std::uint64_t buffer_depth = 0;
    Disagreement disagreement;  // see Channel
    Terms own_terms, peer_terms;
};

// An object of the far side and the body that it is here; no_handle: none any more.
struct ObjectBinding {
    ObjectId object = no_object;
    SessionHandle body = no_handle;
};
// The far side's first description has begun, and is whole.
inline constexpr ObjectBinding description_begins{no_object, 0};
inline constexpr ObjectBinding description_is_whole{no_object, no_handle};

// Hears what crosses a port to the loop, for a recording of it (input_recorder.hpp).
class PortTap {
public:
    virtual ~PortTap() = default;

    // --- loop: it has taken these
    virtual void took(const TeleopSettings& settings) = 0;
    virtual void took(const ObjectBinding& binding) = 0;
    virtual void took(const DiscoveryAcknowledgement& acknowledgement) = 0;
    virtual void took_announced() = 0;
    virtual void took_withdrawn(ObjectId object) = 0;

    // --- owner: it has put this in
    virtual void announced(const PreparedDiscovery& discovery) = 0;
};

struct TeleopPort {
    PortTap* tap = nullptr;  // null: nobody hears it. Set before anything crosses

    TripleBuffer<TeleopSettings> settings;
    TripleBuffer<TeleopStatistics> statistics;

    // Operator: what the far side describes, and which body that is here.
    DiscoveryReceiver discovery;
    SpscRing<ObjectBinding> bindings{1024};

    // Far side: what is to be described, what is gone, and contents to be destroyed.
    SpscRing<PreparedDiscovery> announced{1024};
    SpscRing<ObjectId> withdrawn{1024};
    SpscRing<std::shared_ptr<const std::vector<std::byte>>> released{2048};
};

}  // namespace tactus
