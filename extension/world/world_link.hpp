// A running world as one side of a teleoperation: opens the way to the far side and keeps it, passes on what
// changes on either side, and says in words how it stands.
//
// Threads: all of it belongs to the session's owner; a way is opened by a worker. The loop meets it in the
// port (session/teleop_port.hpp) and in the route (link_way.hpp) only.
#pragma once

#include <array>
#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "realtime/workers.hpp"
#include "session/environment_teller.hpp"
#include "session/model_builder.hpp"
#include "session/session.hpp"
#include "session/side_plan.hpp"
#include "world/link_way.hpp"

namespace tactus {

struct PointerShare;

enum class LinkState : std::uint8_t {
    off,        // one machine, or nothing runs
    opening,    // addresses are looked up
    failed,     // there is no way to the far side
    waiting,    // nothing has been heard yet
    one_way,    // the far side is heard, and does not hear this one
    connected,  // both hear each other
    refused,    // what comes is not believed, or does not go together with this side
    lost,       // nothing has been heard for a second
    left        // the far side has said good-bye
};

// As the user has set the link. Every field but the scenario and the history may change while it runs.
struct LinkPlan {
    bool is_operator = true;
    std::uint8_t scenario = 0;
    std::string problem;         // why there can be no way to the far side, and what to do; or empty
    std::uint64_t revision = 0;  // another one after every change of what is below
    TeleopSettings teleop;
    double history = 1.024;  // operator: how much of its past the model keeps (unit: seconds)
    NetworkSettings network;
    std::string key_file;
    std::shared_ptr<MemoryLinkPair> wire;  // to a far side in this program; null: over the network
    std::string partner;                   // the name of that far side
    std::shared_ptr<const DelayTrace> trace;
    std::string trace_problem;  // why the emulated network has none; or empty
};

// With the port that a side listens at when nothing else is said, here and at the far side, for each that is
// 0.
UdpSettings with_usual_ports(UdpSettings udp, bool is_operator);

// What keeps the two addresses from being those of two sides, and what to do; empty where nothing does.
std::string problem_of_addresses(const UdpSettings& udp);

// How the loop is doing, once a frame.
struct LinkMoment {
    Nanoseconds now = 0;      // of the session
    bool ticks_here = false;  // the caller's thread makes the ticks, or nobody does
    bool waits = false;       // for what takes a while: stepped time
};

struct LinkReport {
    LinkState state = LinkState::off;
    std::string text;
    TeleopStatistics teleop;
    NetworkFigures network;
    std::int64_t objects = 0;  // operator: in the model; far side: described
};

class WorldLink {
public:
    // `ahead`: see UdpWay. It is destroyed after the session, which attach() is for.
    WorldLink(const LinkPlan& plan, Session& session, const Vec3& gravity, const Pose& frame,
              const std::atomic<Nanoseconds>* ahead);
    ~WorldLink();
    WorldLink(const WorldLink&) = delete;
    WorldLink& operator=(const WorldLink&) = delete;

    // To a session that is new: an operator's one link, or those of an environment to each of its operators,
    // who have its pointers in turn.
    static void attach(Session& session, const std::vector<WorldLink*>& links);

    bool is_operator() const { return plan_.is_operator; }

    // Operator: called with each object before it is built.
    void set_distortion(ModelBuilder::Distortion distortion) {
        builder_->set_distortion(std::move(distortion));
    }
    const std::vector<ModelObject>& objects() const { return builder_->objects(); }
    // Operator: the far side has told all that it had.
    bool is_described() const;

    // Passes on what has changed on either side. No plan: whoever has set it is gone, and with it the way.
    // True where objects() are other ones.
    bool synchronise(const std::optional<LinkPlan>& plan, const Vec3& gravity, Workers& workers,
                     const LinkMoment& moment);

    // Far side: a body that is there to be touched; its revision is another one when it is to be described
    // anew.
    struct Told {
        SessionHandle body = no_handle;
        std::uint64_t revision = 0;
    };
    struct Description {
        std::string name;
        BodyAddition addition;
    };
    using Describe = std::function<Description(std::size_t index)>;
    using Name = std::function<std::string(std::size_t index)>;
    // A joint of the session, as it was given to it (Session::add_joint).
    struct ToldJoint {
        SessionHandle joint = no_handle, first = no_handle, second = no_handle;
        const JointDescription* description = nullptr;
        // Both together are others when it is to be described anew.
        std::uint64_t source = 0, revision = 0;
    };
    // Far side: all that there is to touch, and what joins it; `describe` is asked for those bodies that are
    // to be told, `name` for a few in turn: nothing says that a node was renamed or has another parent.
    void tell(const std::vector<Told>& bodies, const Describe& describe, const Name& name,
              const std::vector<ToldJoint>& joints, const SessionSnapshot& snapshot, Nanoseconds now);

    // The far side is told in the next tick, which is this side's last.
    void leave();

    // Nothing ticks any more: ports are free again.
    void end();

    LinkReport report() const;
    std::size_t body_count() const { return builder_ ? builder_->objects().size() : tellings_.size(); }
    // What cannot be described or built, each with what to do.
    std::vector<std::string> problems() const;

private:
    // A way that is being opened. Shared with the thread that does it.
    struct Opening {
        NetworkSettings settings;
        std::unique_ptr<UdpWay> way;
        std::string error;
        std::atomic<bool> done{false};
    };
    // What a way is opened with: where one of these is another, so is the way.
    struct WayPlan {
        std::string local_address, remote_address, key_file;
        std::uint16_t local_port = 0, remote_port = 0;
        std::uint64_t seed = 0;
        std::shared_ptr<MemoryLinkPair> wire;
        bool operator==(const WayPlan&) const = default;
    };
    struct Telling {
        std::uint64_t revision = 0;  // that was told
        Nanoseconds at = 0;
        std::string name;
        std::string problem;
    };
    struct Standing {
        LinkState state = LinkState::off;
        std::string text;
    };

    static WayPlan way_of(const LinkPlan& plan);
    LinkEnd end_of(const SessionSettings& session, const PointerShare& share);
    void tell_bodies(const std::vector<Told>& bodies, const Describe& describe, const Name& name,
                     Nanoseconds now);
    bool has_other_name(const Telling& telling, std::size_t index, std::size_t of, const Name& name) const;
    void tell_joints(const std::vector<ToldJoint>& joints);
    void pass_on_settings(const Vec3& gravity);
    void let_go_of_way();
    void look_after_way(Workers& workers, const LinkMoment& moment);
    void open(Workers& workers, const LinkMoment& moment);
    void take_opened(const LinkMoment& moment);
    void put(std::unique_ptr<LinkWay> way);
    void keep_trace();
    void note_refusals(Nanoseconds now);
    Standing standing() const;
    Standing standing_of_peer() const;
    std::string unfinished_model() const;
    std::string short_history() const;
    std::string narrow_states() const;

    LinkPlan plan_;
    bool is_planned_ = true;  // false: nobody wants it any more
    const std::atomic<Nanoseconds>* ahead_;
    Vec3 gravity_;  // as passed on
    Pose frame_;    // of the world when the link began
    TeleopSettings settings_;
    std::shared_ptr<TeleopPort> port_ = std::make_shared<TeleopPort>();
    LinkRoute route_;
    std::unique_ptr<ModelBuilder> builder_;      // operator
    bool builds_elsewhere_ = false;              // in real time it does not hold frames up
    std::unique_ptr<EnvironmentTeller> teller_;  // far side
    std::unordered_map<SessionHandle, Telling> tellings_;
    std::size_t names_from_ = 0;  // of the bodies whose names are asked for next
    std::unordered_map<SessionHandle, std::pair<std::uint64_t, std::uint64_t>>
        told_joints_;  // source, revision

    std::uint64_t revision_ = 0;          // of the plan, that has been passed on
    std::optional<WayPlan> way_planned_;  // that the way is opened with
    std::unique_ptr<LinkWay> way_;
    std::unique_ptr<LinkWay> past_way_;                      // until the loop has let go of it
    std::vector<std::shared_ptr<const DelayTrace>> traces_;  // that conditions have pointed to
    std::shared_ptr<Opening> opening_;
    std::string way_error_;
    Nanoseconds next_try_ = 0;

    NetworkFigures figures_;
    std::array<std::uint64_t, 5> refusals_{};
    Nanoseconds refused_until_ = 0;
    std::string refusal_;  // the last one, in words
    Nanoseconds now_ = 0;
};

}  // namespace tactus
