#include "nodes/haptic_world.hpp"

#include <algorithm>
#include <godot_cpp/classes/engine.hpp>
#include <godot_cpp/classes/project_settings.hpp>
#include <godot_cpp/classes/rigid_body3d.hpp>
#include <godot_cpp/classes/scene_tree.hpp>
#include <godot_cpp/core/error_macros.hpp>
#include <godot_cpp/variant/callable_method_pointer.hpp>
#include <godot_cpp/variant/packed_float64_array.hpp>

#include "nodes/body_reading.hpp"
#include "nodes/conversions.hpp"
#include "nodes/editor_probe.hpp"
#include "nodes/godot_joint.hpp"
#include "nodes/haptic_recorder.hpp"
#include "nodes/messages.hpp"
#include "nodes/mmt_link.hpp"
#include "nodes/passed_over.hpp"
#include "nodes/project_settings.hpp"
#include "nodes/roll.hpp"
#include "nodes/scene_warnings.hpp"
#include "nodes/signals.hpp"
#include "nodes/tree_walk.hpp"
#include "nodes/whole_path.hpp"
#include "nodes/world_run.hpp"
#include "world/status_words.hpp"

namespace tactus {

using namespace godot;

namespace {

constexpr double report_interval = 1.0;  // (unit: seconds)

constexpr double max_advance = 3600.0;  // (unit: seconds)

// Bodies of Godot's own physics lie in each other by up to this, by its own engine or by Jolt (unit: meters).
constexpr double engine_slop = 0.02;

// Frames take turns of very different length; a body that moves on Godot's side is given at least this long
// for its way (unit: seconds).
constexpr double shortest_way = 1e-3;

// That wake-ups of a loop without a force may be put off by, for the processor's rest (unit: nanoseconds).
constexpr Nanoseconds relaxed_slack = 50'000;

// HapticWorld::hold_arrived() is to be called in this frame.
bool is_hold_posted = false;

double project_number(const char* name, double otherwise) {
    return ProjectSettings::get_singleton()->get_setting(name, otherwise);
}

Vector3 project_gravity() {
    const Vector3 direction =
        ProjectSettings::get_singleton()->get_setting("physics/3d/default_gravity_vector", Vector3(0, -1, 0));
    return direction * static_cast<real_t>(project_number("physics/3d/default_gravity", 9.8));
}

Dictionary distribution(const DurationHistogram& periods) {
    PackedFloat64Array durations;
    PackedFloat64Array shares;
    for (const DurationHistogram::Step& step : periods.cumulative()) {
        durations.push_back(step.duration * 1e-3);
        shares.push_back(step.share);
    }
    Dictionary result;
    result["period_us"] = durations;
    result["share"] = shares;
    return result;
}

// Of the first node below that asks for Godot's own physics; empty: none does.
std::string need_below(const Node& world) {
    std::string need;
    find_below(world, [&need](const Node& node) {
        need = need_of_godot(node);
        return !need.empty();
    });
    return need;
}

// What the editor already knows to be wrong with a node of a world.
void warn_of(Node& node, bool engine_moves, PackedStringArray& warnings) {
    const String name = "'" + String(node.get_name()) + "'";
    if (is_solid_body(&node)) {
        for (const std::string& problem :
             problems_of(read_form(*Object::cast_to<CollisionObject3D>(&node), engine_moves))) {
            warn(warnings, name + String(" cannot be touched as it should be"), to_godot(problem));
        }
    } else if (const auto* joint = Object::cast_to<Joint3D>(&node)) {
        warn(warnings, name + String(" does not join as it should"),
             to_godot(problem_of_joint(*joint, engine_moves)));
    } else {
        for (const std::string& problem : passed_over(node, engine_moves)) {
            warn(warnings, name + String(" is not carried out as Godot has it"), to_godot(problem));
        }
    }
}

}  // namespace

HapticWorld::HapticWorld() : gravity_(project_gravity()) {}
HapticWorld::~HapticWorld() = default;

// --- properties

void HapticWorld::gravity_changed() {
    if (run_ != nullptr) {
        run_->session().set_gravity(from_godot(gravity_));
    }
}

// Both sides of a teleoperation have to come to the same result.
bool HapticWorld::may_choose_godot() const {
    return authority_ != AUTHORITY_HAPTIC && MMTLink::of(*this).empty();
}

bool HapticWorld::chooses_godot() {
    if (!may_choose_godot() || authority_ == AUTHORITY_GODOT) {
        return may_choose_godot();
    }
    const std::string need = need_below(*this);
    if (!need.empty()) {
        UtilityFunctions::print(name_of(*this), ": Godot's own physics moves its bodies, because ",
                                to_godot(need), ". Set 'authority' to Godot or Haptic to choose yourself.");
    }
    return !need.empty();
}

// Scripts add nodes and connect signals after the world has started. A world that starts anew lets go of what
// hands touch, so that it waits until they touch nothing.
void HapticWorld::look_at_arrivals() {
    std::vector<std::uint64_t> arrivals = std::exchange(arrivals_, {});
    if (run_ == nullptr || run_->engine_moves() || authority_ != AUTHORITY_AUTOMATIC || !may_choose_godot()) {
        return;
    }
    std::string need;
    std::erase_if(arrivals, [&](std::uint64_t id) {
        Node* const node = node_of_id<Node>(id);
        const bool is_below = node != nullptr && (node == this || is_ancestor_of(node));
        const std::string its = !is_below ? "" : node == this ? need_below(*this) : need_of_godot(*node);
        need = need.empty() ? its : need;
        return its.empty();
    });
    if (need.empty()) {
        return;
    }
    if (run_->may_start_anew(need)) {
        world_changed();
    } else {
        arrivals_ = std::move(arrivals);
    }
}

HapticWorld::Authority HapticWorld::get_authority_in_use() const {
    const bool is_godots =
        run_ != nullptr ? run_->engine_moves()
                        : may_choose_godot() && (authority_ == AUTHORITY_GODOT || !need_below(*this).empty());
    return is_godots ? AUTHORITY_GODOT : AUTHORITY_HAPTIC;
}

BodyDefaults HapticWorld::body_defaults() const {
    BodyDefaults defaults;
    defaults.linear_damping = project_number("physics/3d/default_linear_damp", defaults.linear_damping);
    defaults.angular_damping = project_number("physics/3d/default_angular_damp", defaults.angular_damping);
    defaults.touch = MaterialValues().touch;
    if (default_material_.is_valid()) {
        defaults.touch = default_material_->touch();
        defaults.detail = default_material_->detail();
    }
    return defaults;
}

// --- life

HapticWorld* HapticWorld::of(const Node* node) {
    for (HapticWorld* world = above(node); world != nullptr; world = above(world)) {
        if (world->is_running()) {
            return world;
        }
    }
    // One that is to start yet has its nodes for itself.
    const std::vector<HapticWorld*>& running = Roll<HapticWorld>::all();
    return running.empty() || above(node) != nullptr ? nullptr : running.front();
}

HapticWorld* HapticWorld::above(const Node* node) {
    for (Node* above = node->get_parent(); above != nullptr; above = above->get_parent()) {
        if (auto* world = Object::cast_to<HapticWorld>(above)) {
            return world;
        }
    }
    return nullptr;
}

void HapticWorld::start() {
    if (const HapticWorld* outer = above(this)) {
        UtilityFunctions::push_warning(
            name_of(*this), ": it stands inside another HapticWorld, ", name_of(*outer),
            ", and stays inactive; what is in it belongs to the outer one. Remove one of "
            "the two, or put them side by side.");
        told_.tell(*this);
        return;
    }
    RunSettings settings;
    settings.real_time = clock_ == CLOCK_REAL_TIME;
    settings.session.period = nanoseconds_per_second / tick_rate_;
    settings.session.max_bodies = static_cast<std::uint32_t>(max_bodies_);
    settings.session.max_parts = 4 * settings.session.max_bodies;
    settings.session.physics.gravity = from_godot(gravity_);
    settings.links = MMTLink::of(*this);
    settings.engine_moves = chooses_godot();
    if (settings.engine_moves) {
        settings.session.physics.penetration_slop = engine_slop;
    }
    // Both sides of a teleoperation have to come to the same result.
    settings.session.full_rate_bodies = !settings.links.empty() ? 0 : settings.session.full_rate_bodies;
    settings.inputs = record_inputs(settings.session);
    change_ = Change::none;
    place_.begin(get_global_transform());
    run_ = std::make_shared<WorldRun>(*this, std::move(settings));
    Roll<HapticWorld>::enter(this);
    run_->synchronise(shortest_way);
    start_loop();
    set_process_internal(true);
    set_physics_process_internal(run_->engine_moves() || authority_ == AUTHORITY_AUTOMATIC);
    arrivals_ = {get_instance_id()};
    post_signal(*this, "started");
}

// A world that starts anew does not write over what it has recorded before.
std::unique_ptr<InputRecording> HapticWorld::record_inputs(const SessionSettings& settings) {
    if (inputs_path_.is_empty()) {
        return nullptr;
    }
    ++starts_;
    inputs_problem_ = String();
    const String path = starts_ == 1 ? inputs_path_
                                     : inputs_path_.get_basename() + "_" + String::num_int64(starts_) + "." +
                                           inputs_path_.get_extension();
    return InputRecording::open(
        whole_path(path), settings, [id = get_instance_id()](const std::string& what) {
            if (auto* const world = node_of_id<HapticWorld>(id)) {
                world->inputs_problem_ = to_godot(what);
                UtilityFunctions::push_warning(name_of(*world), ": ", to_godot(what), ".");
            }
        });
}

TickLoopSettings HapticWorld::loop_settings() const {
    TickLoopSettings settings;
    settings.period = nanoseconds_per_second / tick_rate_;
    settings.realtime = realtime_;
    if (!is_urgent()) {
        settings.realtime.fifo_priority = 0;
        settings.realtime.lock_memory = false;
        settings.realtime.keep_awake = false;
        settings.realtime.timer_slack = relaxed_slack;
        settings.sleep.spin_limit = 0;
    }
    return settings;
}

// A tick that is late by some milliseconds is felt by a hand that is given forces, and by no other: the mean
// stays the period.
bool HapticWorld::is_urgent() const {
    return project_wants_real_time() && (measure_baseline_ || run_->displays_forces());
}

void HapticWorld::start_loop() {
    if (clock_ != CLOCK_REAL_TIME || !can_process()) {
        return;
    }
    if (!run_->may_begin()) {
        loop_changed();  // in the next frame, again
        return;
    }
    const std::string error = run_->loop().start(loop_settings(), measure_baseline_);
    loop_error_ = to_godot(error);
    if (!error.empty()) {
        UtilityFunctions::push_error(name_of(*this), ": the haptic loop could not start: ", to_godot(error),
                                     ".");
    }
}

void HapticWorld::stop() {
    if (run_ == nullptr) {
        return;
    }
    Roll<HapticWorld>::leave(this);
    run_->end();
    former_.reset();
    run_.reset();
    loop_error_ = String();
    post_signal(*this, "stopped");
    told_.tell(*this);
}

// What crosses a link is relative to the worlds of both sides: one that has been moved begins anew where it
// is.
void HapticWorld::look_at_place() {
    if (run_ != nullptr && run_->is_linked() && place_.is_elsewhere(get_global_transform())) {
        world_changed();
    }
}

// The old run goes when the new one has built what it needs: trees and meshes of both are built once.
void HapticWorld::catch_up() {
    look_at_place();
    look_at_arrivals();
    const Change what = std::exchange(change_, Change::none);
    if (run_ == nullptr || what == Change::none) {
        return;
    }
    if (what == Change::loop) {
        run_->running().stop_loop();
        start_loop();
        return;
    }
    const std::shared_ptr<WorldRun> before = run_;
    stop();
    former_ = before;
    start();
}

void HapticWorld::_notification(int what) {
    switch (what) {
        case NOTIFICATION_ENTER_TREE:
            get_tree()->connect("node_added", Callable(this, "_node_added"));
            get_tree()->connect("node_removed", Callable(this, "_node_removed"));
            if (is_edited()) {
                watch_warnings(*this);
            }
            break;
        case NOTIFICATION_POST_ENTER_TREE:
            if (!is_edited()) {
                start();
                show_to_editor(*this);
            }
            break;
        case NOTIFICATION_EXIT_TREE:
            get_tree()->disconnect("node_added", Callable(this, "_node_added"));
            get_tree()->disconnect("node_removed", Callable(this, "_node_removed"));
            stop();
            break;
        case NOTIFICATION_INTERNAL_PROCESS:
            process(frame_seconds());
            break;
        case NOTIFICATION_INTERNAL_PHYSICS_PROCESS:
            physics_process();
            break;
        case NOTIFICATION_PAUSED:
            if (run_ != nullptr) {
                run_->pause();
                told_.tell(*this);
            }
            break;
        case NOTIFICATION_UNPAUSED:
            if (run_ != nullptr) {
                start_loop();
            }
            break;
        default:
            break;
    }
}

void HapticWorld::node_added(const Variant& added) {
    auto* const node = object_in<Node>(added);
    if (node != nullptr && run_ != nullptr) {
        run_->node_added(*node);
        if (Object::cast_to<RigidBody3D>(node) != nullptr && !run_->engine_moves() &&
            !std::exchange(is_hold_posted, true)) {
            callable_mp_static(&HapticWorld::hold_arrived).call_deferred();
        }
        if (authority_ == AUTHORITY_AUTOMATIC && !run_->engine_moves()) {
            arrivals_.push_back(node->get_instance_id());
        }
    }
}

// When scripts have added all that they add in this frame, and before Godot's next step. Whether Godot is to
// move the bodies is known by then: held and let go, they would go on otherwise than without a world.
void HapticWorld::hold_arrived() {
    is_hold_posted = false;
    std::vector<std::uint64_t> worlds;
    for (const HapticWorld* const world : Roll<HapticWorld>::all()) {
        worlds.push_back(world->get_instance_id());
    }
    for (const std::uint64_t id : worlds) {
        auto* const world = node_of_id<HapticWorld>(id);
        if (world != nullptr && world->authority_ == AUTHORITY_AUTOMATIC) {
            world->catch_up();
        }
        if (world != nullptr && world->run_ != nullptr) {
            world->run_->hold_arrived();
        }
    }
}

void HapticWorld::node_removed(const Variant& removed) {
    auto* const node = object_in<Node>(removed);
    if (node == nullptr || run_ == nullptr) {
        return;
    }
    run_->node_removed(*node);
    const std::uint64_t id = node->get_instance_id();
    if (const auto* link = Object::cast_to<MMTLink>(node); link != nullptr && link->is_networked()) {
        if (is_ancestor_of(node)) {
            link_changed();
        }
    }
    deliver_signals_of(id);  // last: what they call may free this node
}

void HapticWorld::finish_recording(HapticRecorder& recorder) {
    for (HapticWorld* world : Roll<HapticWorld>::all()) {
        world->run_->finish(recorder);
    }
}

// --- time

// Since the last frame, by the clock: Engine.time_scale changes the game's time alone.
double HapticWorld::frame_seconds() const {
    const double scale = Engine::get_singleton()->get_time_scale();
    return scale > 0.0 ? get_process_delta_time() / scale : 0.0;
}

// Scripts that are called on the way, when bodies move, may stop the world: the run stays until its work is
// done.
void HapticWorld::process(double seconds) {
    catch_up();
    const std::shared_ptr<WorldRun> run = run_;
    if (run == nullptr || clock_ != CLOCK_REAL_TIME) {
        return;
    }
    run->synchronise(std::max(seconds, shortest_way));
    if (run->trees_building() == 0) {
        former_.reset();
    }
    if (run->loop().is_running() && is_urgent() != run->loop().settings().realtime.keep_awake) {
        loop_changed();
    }
    report_status(seconds);
    told_.tell(*this);
    run->show();
    run->ask_effects();
}

// Before Godot's first step: it would find bodies that the world holds and then leaves to it.
void HapticWorld::physics_process() {
    if (run_ != nullptr && !run_->engine_moves() && !run_->is_busy()) {
        catch_up();
    }
    if (run_ != nullptr && run_->engine_moves() && !run_->is_over()) {
        run_->exchange();
    }
}

int64_t HapticWorld::advance(double seconds) {
    ERR_FAIL_COND_V_MSG(run_ == nullptr, 0,
                        "This HapticWorld does not run: put it into the scene tree first.");
    ERR_FAIL_COND_V_MSG(
        clock_ != CLOCK_STEPPED, 0,
        "This HapticWorld runs in real time: set its clock to CLOCK_STEPPED to advance it by hand.");
    ERR_FAIL_COND_V_MSG(!(seconds >= 0.0 && seconds <= max_advance), 0,
                        "The time to advance must be between 0 and 3,600 s.");
    ERR_FAIL_COND_V_MSG(run_->is_busy(), 0,
                        "This HapticWorld is moving its bodies: advance it when that is done, for example "
                        "with call_deferred().");
    catch_up();
    const std::shared_ptr<WorldRun> run = run_;
    run->synchronise(std::max(seconds, 1.0 / tick_rate_));
    former_.reset();
    const int64_t ticks = run->running().advance(seconds);
    report_status(seconds);
    told_.tell(*this);
    run->show();
    run->ask_effects();
    deliver_signals();  // last: what they call may free this node
    return ticks;
}

void HapticWorld::report_status(double seconds) {
    since_report_ += seconds;
    if (since_report_ < report_interval) {
        return;
    }
    since_report_ = 0.0;
    if (const TickStatus status = run_->loop().take_status(); status != 0) {
        post_signal(*this, "status_reported", {static_cast<int64_t>(status), to_godot(status_words(status))});
    }
}

// --- looking at it

int64_t HapticWorld::get_ticks() const {
    return run_ != nullptr ? static_cast<int64_t>(run_->loop().ticks()) : 0;
}

double HapticWorld::get_time() const {
    return run_ != nullptr ? to_seconds(run_->loop().now()) : 0.0;
}

HapticWorld::State HapticWorld::get_state() const {
    const bool is_inside_other = is_inside_tree() && !is_edited() && above(this) != nullptr;
    const bool works = run_ != nullptr && (clock_ == CLOCK_STEPPED || run_->loop().is_running());
    return tactus::state_of<State>(is_inside_other || !loop_error_.is_empty(), works, run_ != nullptr);
}

String HapticWorld::get_state_text() const {
    switch (get_state()) {
        case STATE_OFF:
            return "off";
        case STATE_FAILED:
            return loop_error_.is_empty()
                       ? String(
                             "it stands inside another HapticWorld: remove one of the two, or put them "
                             "side by side")
                       : loop_error_;
        case STATE_WAITING:
            return can_process() ? String("waits for the triangle trees of its bodies") : String("paused");
        case STATE_WORKING:
            return "working";
    }
    return String();
}

void HapticWorld::reset_statistics() {
    if (run_ == nullptr) {
        return;
    }
    run_->loop().loop().statistics().request_clear();
    if (BaselineLoop* baseline = run_->loop().baseline()) {
        baseline->statistics().request_clear();
    }
}

Dictionary HapticWorld::get_period_distribution() const {
    return run_ != nullptr ? distribution(run_->loop().loop().statistics().periods()) : Dictionary();
}

Dictionary HapticWorld::get_baseline_period_distribution() const {
    const bool measured = run_ != nullptr && run_->loop().baseline() != nullptr;
    return measured ? distribution(run_->loop().baseline()->statistics().periods()) : Dictionary();
}

PackedStringArray HapticWorld::get_problems() const {
    if (run_ == nullptr) {
        return _get_configuration_warnings();
    }
    PackedStringArray problems = to_godot(run_->problems());
    if (!inputs_problem_.is_empty()) {
        problems.push_back(inputs_problem_);
    }
    return problems;
}

PackedStringArray HapticWorld::_get_configuration_warnings() const {
    PackedStringArray warnings;
    if (const HapticWorld* outer = above(this)) {
        warnings.push_back("This HapticWorld stands inside another one, '" + String(outer->get_name()) +
                           "', and stays inactive: remove one of the two, or put them side by side.");
        return warnings;
    }
    const bool engine_moves = get_authority_in_use() == AUTHORITY_GODOT;
    for_each_below(*this, [&](Node& node) { warn_of(node, engine_moves, warnings); });
    if (is_inside_tree()) {
        warn(warnings, "This HapticWorld leaves something out", problem_of_outside(*this));
        for (const std::string& problem :
             engine_moves ? std::vector<std::string>() : problems_across(*this)) {
            warn(warnings, "This HapticWorld leaves something out", to_godot(problem));
        }
    }
    // Where Godot's own physics moves the bodies, those of no node are felt as well.
    const auto is_solid = [](const Node& node) { return is_solid_body(&node); };
    if (!engine_moves && find_below(*this, is_solid) == nullptr) {
        warn(warnings, "This HapticWorld is empty", problem_of_emptiness(*this));
    }
    return warnings;
}

}  // namespace tactus
