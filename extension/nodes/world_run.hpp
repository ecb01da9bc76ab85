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

#include "nodes/body_mirror.hpp"
#include "nodes/joint_mirror.hpp"
#include "nodes/link_run.hpp"
#include "nodes/messages.hpp"
#include "nodes/proxy_pointer.hpp"
#include "realtime/baseline_loop.hpp"
#include "realtime/tick_loop.hpp"
#include "session/session.hpp"

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

    void bodies_changed() { bodies_changed_ = true; }
    void forget(HapticDevice* device);
    void forget(ProxyPointer* proxy);
    void forget(HapticRecorder* recorder);
    void forget(MMTLink* link);
    // The recorder is about to close its files: gives it what is there, then lets it go.
    void finish(HapticRecorder* recorder);

    Session& session() { return session_; }
    TickLoop& loop() { return loop_; }
    const TickLoop& loop() const { return loop_; }
    BaselineLoop* baseline() { return baseline_.get(); }
    Nanoseconds now() const { return static_cast<Nanoseconds>(ticks()) * settings_.session.period; }
    std::uint64_t ticks() const { return ticks_.load(std::memory_order_acquire); }
    TickStatus take_status();
    std::size_t body_count() const {
        return link_ && link_->is_operator() ? link_->body_count() : mirrors_.size();
    }
    std::size_t trees_building() const;         // bodies that wait for theirs
    std::vector<std::string> problems() const;  // each names its node

private:
    struct DeviceLink {
        HapticDevice* node = nullptr;
        std::shared_ptr<Device> port;
        SessionHandle handle = no_handle;
        Workspace sent;
    };
    struct ProxyLink {
        ProxyPointer* node = nullptr;
        SessionHandle handle = no_handle;
        ProxyDescription sent;
    };

    static TickStatus tick_loop_function(void* self, Nanoseconds scheduled);
    TickStatus tick(Nanoseconds now);

    void collect_nodes(godot::Node* node, std::vector<godot::CollisionObject3D*>& bodies,
                       std::vector<godot::Joint3D*>& joints) const;
    template <class Mirror, class NodeType>
    void match(std::vector<std::unique_ptr<Mirror>>& mirrors, const std::vector<NodeType*>& found);
    void find_nodes();
    void synchronise_joints();
    void synchronise_bodies(double seconds);
    void finish_building(const MirrorContext& context);
    void synchronise_devices();
    void synchronise_proxies();
    void synchronise_recorder();
    void synchronise_link();
    void connect_device(DeviceLink& link);
    void drop_device(DeviceLink& link);
    void want_trace();
    void drain();
    BodyMirror* mirror_of(std::uint64_t id);
    BodyMirror* mirror_of_handle(SessionHandle handle);
    SessionHandle body_of(const godot::Node* node);
    std::uint64_t node_of(SessionHandle body);
    SessionHandle device_handle(const HapticDevice* node) const;
    ProxyPointer::BodyIds body_ids(const ProxyState& state);
    void show_bodies(const SessionSnapshot& snapshot);
    void show_devices(const SessionSnapshot& snapshot);
    void show_proxies(const SessionSnapshot& snapshot);

    HapticWorld& world_;
    RunSettings settings_;
    std::atomic<Nanoseconds> clock_offset_{
        0};                          // a tick's time on the monotonic clock less its time in the session
    std::unique_ptr<LinkRun> link_;  // null: nobody at a far side. Above the session, whose side uses it
    Session session_;
    Workers workers_;  // below the session, which their jobs use
    std::unique_ptr<TickTrace> trace_;
    TickLoop loop_;
    TickLoopSettings loop_settings_;  // as it was started last
    std::unique_ptr<BaselineLoop> baseline_;
    bool is_over_ = false;
    bool is_busy_ = false;

    // The session's clock starts at zero and stands still while the loop does.
    std::atomic<std::uint64_t> ticks_{0};
    Nanoseconds next_time_ = 0;  // of the session, for the next tick
    bool loop_is_new_ = true;
    Nanoseconds epoch_of_monotonic_clock_;  // its zero, since the epoch
    TickStatus stepped_status_ = 0;

    std::vector<std::unique_ptr<BodyMirror>> mirrors_;
    std::unordered_map<std::uint64_t, BodyMirror*> mirror_by_id_;
    std::vector<BodyMirror*> mirror_by_handle_;
    std::vector<std::unique_ptr<JointMirror>> joints_;
    bool bodies_changed_ = true;
    std::vector<DeviceLink> devices_;
    std::vector<ProxyLink> proxies_;
    HapticRecorder* recorder_ = nullptr;
    SessionHandle recorded_proxy_ = no_handle;
    SessionHandle recorded_object_ = no_handle;
    std::vector<std::shared_ptr<void>> retired_;  // lives until the loop has let go of it
    std::shared_ptr<Device> stand_in_;            // far side: the hand is the operator's
    BodyDefaults defaults_;
    Complaints complaints_;
};

}  // namespace tactus
