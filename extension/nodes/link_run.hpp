// What a WorldRun owns while its world is a side of a teleoperation: the way to the far side, and what the
// two sides say to each other beyond the tick.
//
// Threads: all of it belongs to the main thread; a way is opened by a worker. The loop meets it in the port
// (session/teleop_port.hpp) and in the route (link_route.hpp) only.
#pragma once

#include <array>
#include <atomic>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

#include "nodes/body_mirrors.hpp"
#include "nodes/link_route.hpp"
#include "nodes/mmt_link.hpp"
#include "nodes/model_view.hpp"
#include "realtime/workers.hpp"
#include "session/environment_teller.hpp"
#include "session/model_builder.hpp"
#include "session/session.hpp"
#include "session/teleoperator_side.hpp"

namespace tactus {

class HapticWorld;

// How the loop is doing, once a frame.
struct LinkMoment {
    Nanoseconds now = 0;      // of the session
    bool ticks_here = false;  // the caller's thread makes the ticks, or nobody does
    bool waits = false;       // for what takes a while: stepped time
};

class LinkRun {
public:
    // `ahead`: see UdpWay. It is destroyed after the session, which is new.
    LinkRun(MMTLink& node, HapticWorld& world, Session& session, const std::atomic<Nanoseconds>* ahead);

    ~LinkRun();
    LinkRun(const LinkRun&) = delete;
    LinkRun& operator=(const LinkRun&) = delete;

    // For the session to attach. The far side has that share of its pointers.
    std::unique_ptr<TeleopSide> make_side(const PointerShare& share);

    bool is_operator() const { return operator_; }
    bool is_of(const MMTLink* node) const { return node_ == node; }
    void forget_node() { node_ = nullptr; }

    // Operator: the bodies of the scene, which show those of the far side.
    ModelView* view() { return view_.get(); }
    std::size_t body_count() const { return builder_ ? builder_->objects().size() : tellings_.size(); }

    // Passes on what has changed on either side.
    void synchronise(Workers& workers, const LinkMoment& moment);
    // Far side: what there is to touch.
    void tell(const BodyMirrors& scene, const SessionSnapshot& snapshot, Nanoseconds now);

    // The far side is told in the next tick, which is this side's last.
    void leave();

    // Nothing ticks any more: ports are free again, and the node is told.
    void end();

    // What the node is to be told, to be passed to it when nothing of the run is used any more.
    struct News {
        std::uint64_t node = 0;
        LinkReport report;
        std::vector<ModelNews> objects;
        void deliver() const;
    };
    News take_news();

    // A body of the far side that cannot be described, each with what to do.
    std::vector<std::string> problems() const;

private:
    // A way that is being opened. Shared with the thread that does it.
    struct Opening {
        NetworkSettings settings;
        std::unique_ptr<UdpWay> way;
        std::string error;
        std::atomic<bool> done{false};
    };
    struct Telling {
        std::uint64_t revision = 0;  // BodyMirror::revision() that was told
        Nanoseconds at = 0;
        std::string problem;
    };

    void tell_bodies(const BodyMirrors& scene, Nanoseconds now);
    void tell_joints(const BodyMirrors& scene);
    void pass_on_settings();
    void let_go_of_way();
    void look_after_way(Workers& workers, const LinkMoment& moment);
    void open(Workers& workers, const LinkMoment& moment);
    void take_opened(const LinkMoment& moment);
    void put(std::unique_ptr<LinkWay> way);
    void keep_trace();
    void note_refusals(Nanoseconds now);
    LinkReport report() const;
    std::pair<MMTLink::State, std::string> state() const;
    std::pair<MMTLink::State, std::string> state_of_peer() const;

    MMTLink* node_;  // null: it has left
    bool operator_;
    const std::atomic<Nanoseconds>* ahead_;
    HapticWorld& world_;
    const SessionSettings& session_settings_;
    Vec3 gravity_;  // as passed on
    Pose frame_;    // of the world's node when the link began
    TeleopSettings settings_;
    std::shared_ptr<TeleopPort> port_;
    LinkRoute route_;
    std::unique_ptr<ModelView> view_;            // operator
    std::unique_ptr<ModelBuilder> builder_;      // operator
    bool builds_elsewhere_ = false;              // in real time it does not hold frames up
    std::unique_ptr<EnvironmentTeller> teller_;  // far side
    std::unordered_map<SessionHandle, Telling> tellings_;
    std::unordered_map<SessionHandle, std::pair<std::uint64_t, std::uint64_t>>
        told_joints_;  // node, revision

    std::uint64_t revision_ = 0;      // of the node, that has been passed on
    std::uint64_t way_revision_ = 0;  // that the way was opened with
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
    std::vector<ModelNews> object_news_;
};

}  // namespace tactus
