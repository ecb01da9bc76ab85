// What a HapticWorld owns while it runs: a running world, and what of the scene tree stands in it.
//
// Threads: the main thread; the haptic thread is that of the loop (world/world_loop.hpp).
#pragma once

#include <godot_cpp/classes/node3d.hpp>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "core/haptics/hand_field.hpp"
#include "nodes/hand_mirrors.hpp"
#include "nodes/messages.hpp"
#include "nodes/model_view.hpp"
#include "nodes/proxy_pointer.hpp"
#include "nodes/scene_bodies.hpp"
#include "world/running_world.hpp"

namespace tactus {

class HapticRecorder;
class HapticWorld;
class MMTLink;

struct RunSettings {
    SessionSettings session;
    bool real_time = true;
    bool engine_moves = false;               // Godot's own physics moves the bodies
    std::vector<MMTLink*> links;             // empty: nobody at a far side
    std::unique_ptr<InputRecording> inputs;  // null: they are not recorded
};

class WorldRun {
public:
    WorldRun(HapticWorld& world, RunSettings settings);
    ~WorldRun();
    WorldRun(const WorldRun&) = delete;
    WorldRun& operator=(const WorldRun&) = delete;

    // Gives everything back; nothing ticks after it. A caller at work in the run keeps it, and finds out by
    // is_over().
    void end();
    bool is_over() const { return running_->is_over(); }
    // While scene and session are brought together. Godot may call scripts then, as bodies move.
    bool is_busy() const { return is_busy_; }

    // Ticks stop for a while: nothing pushes the hand meanwhile.
    void pause();
    // Real time: whether the loop may make its first tick. Nothing moves, and no proxy, before the trees are
    // built that were there when the world began.
    bool may_begin();
    // For these trees, so far (unit: seconds).
    double waited() const { return waited_; }

    // Passes on what changed in the scene tree; `seconds`: since the last call.
    void synchronise(double seconds);
    // Godot's own physics moves the bodies and is about to step.
    void exchange();
    // Shows in the scene tree what the loop has done.
    void show();
    // Lets scripts say what forces are on the hands. Last: they may do anything, and end all this.
    void ask_effects();

    // A node has come; one is about to go.
    void node_added(godot::Node& node) { view().scene_changed(node, true); }
    // Bodies that have come so far are Godot's no more, if this is to move them.
    void hold_arrived() { bodies_.hold_arrived(); }
    void node_removed(godot::Node& node);
    // The recorder is about to close its files: gives it what is there, then lets it go.
    void finish(HapticRecorder& recorder);

    // no_handle where the node is no body of this world.
    SessionHandle body_of(const godot::Node* node) {
        return node != nullptr ? view().body_of(node->get_instance_id()) : no_handle;
    }
    bool engine_moves() const { return engine_moves_; }
    // Whether Godot's own physics may take over now, which `need` asks for; it is said why not.
    bool may_start_anew(const std::string& need);
    bool is_linked() const { return !link_nodes_.empty(); }
    BodyState state_of(const godot::Node* node) { return running_->state_of(body_of(node)); }

    const SceneBodies& bodies() const { return bodies_; }
    RunningWorld& running() { return *running_; }
    Session& session() { return running_->session(); }
    WorldLoop& loop() { return running_->loop(); }
    const WorldLoop& loop() const { return running_->loop(); }
    std::size_t body_count() { return view().body_count(); }
    std::size_t trees_building() const { return bodies_.mirrors().building(); }  // bodies wait
    std::vector<std::string> problems() const;                                   // each names its node
    // The loop has to be on time: a hand of this world is given forces.
    bool displays_forces() const { return hands_->displays_forces() || !running_->links().empty(); }

private:
    // By a worker. All else is destroyed by the main thread: what is freed of Godot's in another is freed
    // later, or never.
    struct DestroyedAside {
        void operator()(RunningWorld* running) const;
    };

    SceneView& view() { return model_ != nullptr ? static_cast<SceneView&>(*model_) : bodies_; }
    std::string problem_of_time() const;
    void synchronise_bodies(double seconds);
    double frame_seconds() const;  // from one step of Godot's own physics to the next, by the loop's clock
    void look_at_scene();
    void compare_model();
    void synchronise_recorders();
    template <class NodeType>
    void give_ticks(const NodeType& node, const std::shared_ptr<TickRing>& ring, SessionHandle body);
    void start_model(const MMTLink& link);
    void synchronise_links();
    void show_bodies(const SessionSnapshot& snapshot);
    std::optional<HandMotion> motion_of(SessionHandle handle, const godot::Node3D* hand);
    std::optional<FieldMoment> ask_effects(const std::vector<std::uint64_t>& effects, const HandMotion& hand,
                                           double time, const FieldMoment& before);

    HapticWorld& world_;
    std::vector<std::uint64_t> link_nodes_;  // ids of the MMTLinks of its links; 0: it has left
    std::unique_ptr<RunningWorld, DestroyedAside> running_;  // ends last: what follows asks it
    std::unique_ptr<ModelView> model_;                       // at the operator; else null
    std::vector<ModelNews> model_news_;                      // for its link's node
    Nanoseconds model_changed_ = 0;                          // when it did last
    bool is_model_compared_ = false;                         // since then
    bool is_busy_ = false;
    const bool engine_moves_;        // see RunSettings
    bool is_starting_ = true;        // nothing has been looked at yet
    bool is_fresh_ = false;          // the snapshot is shown in the next frame
    std::vector<Vec3> hand_places_;  // of this frame; keeps its memory

    std::map<SessionHandle, FieldMoment> asked_;  // what effects have answered in this frame

    Complaints complaints_;
    SceneBodies bodies_;
    std::unique_ptr<HandMirrors> hands_;
    std::uint64_t recorder_ = 0;  // id of the HapticRecorder that records this world
    BodyDefaults defaults_;       // as of the last frame
    std::uint32_t looks_ = 0;     // synchronise() so far
    double waited_ = 0.0;
};

}  // namespace tactus
