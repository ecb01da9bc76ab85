// What a HapticWorld owns while it runs: the session, its loop, and what of the scene tree stands in it.
//
// Threads: everything but tick() belongs to the main thread. tick() is called by the haptic thread in real
// time and by advance() in stepped time; it touches the session's loop side, the trace and the clock's own
// members, nothing else.
#pragma once

#include <atomic>
#include <godot_cpp/classes/node3d.hpp>
#include <memory>
#include <unordered_map>
#include <vector>

#include "nodes/body_mirrors.hpp"
#include "nodes/hand_mirrors.hpp"
#include "nodes/messages.hpp"
#include "nodes/model_view.hpp"
#include "nodes/proxy_pointer.hpp"
#include "realtime/baseline_loop.hpp"
#include "realtime/tick_loop.hpp"
#include "session/session.hpp"
#include "world/world_link.hpp"

namespace tactus {

class HapticDevice;
class HapticRecorder;
class HapticWorld;
class MMTLink;

struct RunSettings {
    SessionSettings session;
    bool real_time = true;
    MMTLink* link = nullptr;  // null: nobody at a far side
};

class WorldRun {
public:
    WorldRun(HapticWorld& world, const RunSettings& settings);
    ~WorldRun();
    WorldRun(const WorldRun&) = delete;
    WorldRun& operator=(const WorldRun&) = delete;

    // Gives everything back; nothing ticks after it. The run itself may be destroyed later: whoever is at
    // work in it finds out by is_over().
    void end();
    bool is_over() const { return is_over_; }
    // While scene and session are brought together. Godot may call scripts then, as bodies move.
    bool is_busy() const { return is_busy_; }

    // Real time only. The text is empty, or why the loop could not start. With `baseline` a bare loop runs
    // beside.
    std::string start_loop(const TickLoopSettings& settings, bool baseline);
    void stop_loop();
    // Ticks stop for a while: nothing pushes the hand meanwhile.
    void pause();

    // Passes on what changed in the scene tree; `seconds`: since the last call.
    void synchronise(double seconds);
    // Shows in the scene tree what the loop has done.
    void show();
    // Stepped time only: ticks at once, here.
    void advance(std::int64_t ticks);

    // A node has come or gone.
    void scene_changed(const godot::Node& node);
    void forget(HapticDevice* device) { hands_->forget(device, session_); }
    void forget(ProxyPointer* proxy) { hands_->forget(proxy, session_); }
    void forget(HapticRecorder* recorder);
    void forget(MMTLink* link);
    // The recorder is about to close its files: gives it what is there, then lets it go.
    void finish(HapticRecorder* recorder);

    // Gives a body an impulse in the next tick; `for_a_frame`: the force of that size, and its torque, for as
    // long as the next frame is.
    void push(SessionHandle body, const BodyPush& push, bool for_a_frame);
    // no_handle where the node is no body of this world.
    SessionHandle body_of(const godot::Node* node);
    // Of one that can move, as shown last; null where there is none.
    const BodyState* state_of(const godot::Node* node);

    const BodyMirrors& bodies() const { return bodies_; }
    Session& session() { return session_; }
    TickLoop& loop() { return loop_; }
    const TickLoop& loop() const { return loop_; }
    BaselineLoop* baseline() { return baseline_.get(); }
    Nanoseconds now() const { return static_cast<Nanoseconds>(ticks()) * settings_.session.period; }
    std::uint64_t ticks() const { return ticks_.load(std::memory_order_acquire); }
    TickStatus take_status();
    std::size_t body_count() const { return view_ ? link_->body_count() : bodies_.bodies().size(); }
    std::size_t trees_building() const { return bodies_.building(); }  // bodies that wait for theirs
    std::vector<std::string> problems() const;                         // each names its node

private:
    static TickStatus tick_loop_function(void* self, Nanoseconds scheduled);
    TickStatus tick(Nanoseconds now);

    void synchronise_bodies(double seconds);
    void look_at_scene();
    void synchronise_recorder();
    void start_link();
    void synchronise_link();
    void tell_far_side(Nanoseconds now);
    void want_trace();
    void drain();
    std::uint64_t node_of(SessionHandle body);
    void show_bodies(const SessionSnapshot& snapshot);

    HapticWorld& world_;
    RunSettings settings_;
    std::atomic<Nanoseconds> clock_offset_{
        0};                            // a tick's time on the monotonic clock less its time in the session
    std::unique_ptr<WorldLink> link_;  // null: nobody at a far side. Above the session, whose side uses it
    Session session_;
    std::unique_ptr<TickTrace> trace_;
    TickLoop loop_;
    TickLoopSettings loop_settings_;  // as it was started last
    std::unique_ptr<BaselineLoop> baseline_;
    MMTLink* link_node_ = nullptr;       // null: there is none, or it has left
    std::unique_ptr<ModelView> view_;    // at the operator; else null
    std::vector<ModelNews> model_news_;  // for the link's node
    bool is_over_ = false;
    bool is_busy_ = false;

    // The session's clock starts at zero and stands still while the loop does.
    std::atomic<std::uint64_t> ticks_{0};
    Nanoseconds next_time_ = 0;  // of the session, for the next tick
    bool loop_is_new_ = true;
    Nanoseconds epoch_of_monotonic_clock_;  // its zero, since the epoch
    TickStatus stepped_status_ = 0;

    std::vector<std::pair<SessionHandle, BodyPush>> forces_;  // until the next frame
    BodyMirrors bodies_;
    std::unique_ptr<HandMirrors> hands_;
    HapticRecorder* recorder_ = nullptr;
    SessionHandle recorded_proxy_ = no_handle;
    SessionHandle recorded_object_ = no_handle;
    std::vector<std::shared_ptr<void>> retired_;  // lives until the loop has let go of it
    BodyDefaults defaults_;
    std::uint32_t looks_ = 0;  // synchronise() so far
    Complaints complaints_;
};

}  // namespace tactus
