#include "nodes/haptic_world.hpp"

#include <cmath>
#include <godot_cpp/classes/engine.hpp>
#include <godot_cpp/classes/project_settings.hpp>
#include <godot_cpp/classes/scene_tree.hpp>
#include <godot_cpp/core/class_db.hpp>
#include <godot_cpp/variant/packed_float64_array.hpp>

#include "nodes/conversions.hpp"
#include "nodes/haptic_device.hpp"
#include "nodes/haptic_recorder.hpp"
#include "nodes/messages.hpp"
#include "nodes/mmt_link.hpp"
#include "nodes/proxy_pointer.hpp"
#include "nodes/roll.hpp"
#include "nodes/world_run.hpp"

namespace tactus {

using namespace godot;

namespace {

constexpr double report_interval = 1.0;  // (unit: seconds)

// Frames take turns of very different length; a body that moves on Godot's side is given at least this long
// for its way (unit: seconds).
constexpr double shortest_way = 1e-3;

struct StatusWord {
    TickStatus bit;
    const char* text;
};

constexpr StatusWord status_words[] = {
    {session_step_pairs_full, "too many bodies near each other at once: some contacts were lost"},
    {session_step_contacts_full, "too many contacts at once: some were lost"},
    {session_step_memory_full, "the physics step needed more memory than it had set aside"},
    {session_full, "a body, device or proxy found no place: raise most_bodies or remove some"},
    {session_force_limited, "a force was longer than its device's limit and was shortened"},
    {session_proxy_unfinished, "a proxy needed more than one tick to find its place"},
    {session_record_lost, "a recorder could not keep up"},
    {session_body_lost, "a body left the range of numbers: it was put back where it was, asleep"},
    {session_commands_waiting, "many changes at once: they take effect over several ticks"},
    {tick_late, "a tick ended after the next one was due"},
    {tick_rebased, "the program stood still for so long that the schedule was moved"},
};

String status_text(TickStatus status) {
    PackedStringArray words;
    for (const StatusWord& word : status_words) {
        if ((status & word.bit) != 0) {
            words.push_back(word.text);
        }
    }
    return String("; ").join(words);
}

Vector3 project_gravity() {
    const ProjectSettings* project = ProjectSettings::get_singleton();
    const double size = project->get_setting("physics/3d/default_gravity", 9.8);
    const Vector3 direction = project->get_setting("physics/3d/default_gravity_vector", Vector3(0, -1, 0));
    return direction * static_cast<real_t>(size);
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

bool is_mirrored(const Node* node) {
    return is_solid_body(node) || Object::cast_to<Joint3D>(node) != nullptr;
}

// Bodies that the editor already knows cannot be touched, each with what to do.
void find_problems(const Node& node, PackedStringArray& problems) {
    for (int i = 0; i < node.get_child_count(); ++i) {
        Node* child = node.get_child(i);
        if (is_solid_body(child)) {
            for (const std::string& problem :
                 problems_of(read_shapes(*Object::cast_to<CollisionObject3D>(child)))) {
                problems.push_back("'" + String(child->get_name()) +
                                   "' cannot be touched as it should be: " + to_godot(problem) + ".");
            }
        }
        if (const auto* joint = Object::cast_to<Joint3D>(child)) {
            if (const std::string problem = problem_of_joint(*joint); !problem.empty()) {
                problems.push_back("'" + String(child->get_name()) +
                                   "' does not join as it should: " + to_godot(problem) + ".");
            }
        }
        find_problems(*child, problems);
    }
}

}  // namespace

HapticWorld::HapticWorld() : gravity_(project_gravity()) {}
HapticWorld::~HapticWorld() = default;

// --- properties
// ------------------------------------------------------------------------------------------------------

void HapticWorld::set_tick_rate(int hertz) {
    if (hertz < 10 || hertz > 20000) {
        refuse(*this, "tick_rate", hertz, "between 10 and 20,000 Hz");
        return;
    }
    tick_rate_ = hertz;
    restart();
}

void HapticWorld::set_clock(Clock clock) {
    if (clock_ != clock) {
        clock_ = clock;
        restart();
    }
}

void HapticWorld::set_gravity(const Vector3& gravity) {
    if (!gravity.is_finite()) {
        refuse(*this, "gravity", gravity, "made of finite numbers");
        return;
    }
    gravity_ = gravity;
    if (run_ != nullptr) {
        run_->session().set_gravity(from_godot(gravity_));
    }
}

void HapticWorld::set_most_bodies(int count) {
    if (count < 1 || count > 65536) {
        refuse(*this, "most_bodies", count, "between 1 and 65,536");
        return;
    }
    most_bodies_ = count;
    restart();
}

void HapticWorld::set_realtime_priority(int priority) {
    if (priority < 0 || priority > 99) {
        refuse(*this, "realtime_priority", priority, "between 0 (ordinary scheduling) and 99");
        return;
    }
    realtime_priority_ = priority;
    restart();
}

void HapticWorld::set_processor(int processor) {
    if (processor < last_processor) {
        refuse(*this, "processor", processor, "-2 (the last one), -1 (any), or a processor's number");
        return;
    }
    processor_ = processor;
    restart();
}

void HapticWorld::set_lock_memory(bool lock) {
    lock_memory_ = lock;
    restart();
}

void HapticWorld::set_measure_baseline(bool measure) {
    measure_baseline_ = measure;
    restart();
}

TouchMaterial HapticWorld::default_touch() const {
    return default_material_.is_valid() ? default_material_->touch() : TouchMaterial{};
}

std::shared_ptr<const HeightImage> HapticWorld::default_texture() const {
    return default_material_.is_valid() ? default_material_->heights() : nullptr;
}

// --- life
// ------------------------------------------------------------------------------------------------------------

HapticWorld* HapticWorld::of(const Node* node) {
    for (Node* above = node->get_parent(); above != nullptr; above = above->get_parent()) {
        auto* world = Object::cast_to<HapticWorld>(above);
        if (world != nullptr && world->is_running()) {
            return world;
        }
    }
    const std::vector<HapticWorld*>& running = Roll<HapticWorld>::all();
    return running.empty() ? nullptr : running.front();
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
        return;
    }
    RunSettings settings;
    settings.real_time = clock_ == CLOCK_REAL_TIME;
    settings.baseline = settings.real_time && measure_baseline_;
    settings.session.period = nanoseconds_per_second / tick_rate_;
    settings.session.most_bodies = static_cast<std::uint32_t>(most_bodies_);
    settings.session.most_parts = 4 * settings.session.most_bodies;
    settings.session.physics.gravity = from_godot(gravity_);
    settings.loop.period = settings.session.period;
    settings.loop.realtime.fifo_priority = realtime_priority_;
    settings.loop.realtime.lock_memory = lock_memory_;
    settings.loop.realtime.cpu = processor_;
    settings.link = MMTLink::of(*this);
    // Both sides of a teleoperation have to come to the same result.
    settings.session.full_rate_bodies = settings.link != nullptr ? 0 : settings.session.full_rate_bodies;
    run_ = std::make_unique<WorldRun>(*this, settings);
    Roll<HapticWorld>::enter(this);
    owed_seconds_ = 0.0;
    run_->synchronise(shortest_way);
    if (settings.real_time && can_process()) {
        if (const std::string error = run_->start_loop(); !error.empty()) {
            UtilityFunctions::push_error(name_of(*this),
                                         ": the haptic loop could not start: ", to_godot(error), ".");
        }
    }
    set_process(settings.real_time);
    emit_signal("started");
}

void HapticWorld::stop() {
    if (run_ == nullptr) {
        return;
    }
    Roll<HapticWorld>::leave(this);
    run_.reset();
    emit_signal("stopped");
}

void HapticWorld::restart() {
    if (run_ != nullptr) {
        stop();
        start();
    }
}

void HapticWorld::_notification(int what) {
    switch (what) {
        case NOTIFICATION_ENTER_TREE:
            get_tree()->connect("node_added", Callable(this, "_node_added"));
            get_tree()->connect("node_removed", Callable(this, "_node_removed"));
            break;
        case NOTIFICATION_POST_ENTER_TREE:
            if (!Engine::get_singleton()->is_editor_hint()) {
                start();
            }
            break;
        case NOTIFICATION_EXIT_TREE:
            get_tree()->disconnect("node_added", Callable(this, "_node_added"));
            get_tree()->disconnect("node_removed", Callable(this, "_node_removed"));
            stop();
            break;
        case NOTIFICATION_PAUSED:
            if (run_ != nullptr) {
                run_->pause();
            }
            break;
        case NOTIFICATION_UNPAUSED:
            if (run_ != nullptr && clock_ == CLOCK_REAL_TIME) {
                run_->start_loop();
            }
            break;
        default:
            break;
    }
}

// In the editor what comes and goes changes what there is to warn of.
void HapticWorld::node_added(Node* node) {
    if (Engine::get_singleton()->is_editor_hint() && is_ancestor_of(node)) {
        update_configuration_warnings();
    }
    if (run_ != nullptr && is_mirrored(node)) {
        run_->bodies_changed();
    }
}

void HapticWorld::node_removed(Node* node) {
    if (Engine::get_singleton()->is_editor_hint() && is_ancestor_of(node)) {
        update_configuration_warnings();
    }
    if (run_ == nullptr) {
        return;
    }
    if (auto* device = Object::cast_to<HapticDevice>(node)) {
        run_->forget(device);
    } else if (auto* proxy = Object::cast_to<ProxyPointer>(node)) {
        run_->forget(proxy);
    } else if (auto* recorder = Object::cast_to<HapticRecorder>(node)) {
        run_->forget(recorder);
    } else if (auto* link = Object::cast_to<MMTLink>(node)) {
        run_->forget(link);
        if (link->is_networked() && is_ancestor_of(link)) {
            call_deferred("_link_changed");
        }
    } else if (is_mirrored(node)) {
        run_->bodies_changed();
    }
}

void HapticWorld::shape_changed() {
    if (run_ != nullptr) {
        run_->shapes_changed();
    }
}

void HapticWorld::finish_recording(HapticRecorder* recorder) {
    for (HapticWorld* world : Roll<HapticWorld>::all()) {
        world->run_->finish(recorder);
    }
}

// --- time
// ------------------------------------------------------------------------------------------------------------

void HapticWorld::_process(double seconds) {
    if (run_ == nullptr || clock_ != CLOCK_REAL_TIME) {
        return;
    }
    run_->synchronise(std::max(seconds, shortest_way));
    report_status(seconds);
    run_->show();  // last: it emits signals, and what they call may remove this node
}

int64_t HapticWorld::advance(double seconds) {
    ERR_FAIL_COND_V_MSG(run_ == nullptr, 0,
                        "This HapticWorld does not run: put it into the scene tree first.");
    ERR_FAIL_COND_V_MSG(
        clock_ != CLOCK_STEPPED, 0,
        "This HapticWorld runs in real time: set its clock to CLOCK_STEPPED to advance it by hand.");
    ERR_FAIL_COND_V_MSG(!is_at_least_zero(seconds), 0,
                        "The time to advance must be a finite number, 0 or more.");
    // A hundredth of a tick covers what adding up many small times loses to rounding.
    constexpr double rounding = 0.01;
    owed_seconds_ += seconds;
    const auto ticks = static_cast<int64_t>(owed_seconds_ * tick_rate_ + rounding);
    owed_seconds_ -= static_cast<double>(ticks) / tick_rate_;
    run_->synchronise(std::max(seconds, 1.0 / tick_rate_));
    run_->advance(ticks);
    report_status(seconds);
    run_->show();
    return ticks;
}

void HapticWorld::report_status(double seconds) {
    since_report_ += seconds;
    if (since_report_ < report_interval) {
        return;
    }
    since_report_ = 0.0;
    if (const TickStatus status = run_->take_status(); status != 0) {
        emit_signal("status_reported", static_cast<int64_t>(status), status_text(status));
    }
}

// --- looking at it
// ---------------------------------------------------------------------------------------------------

int64_t HapticWorld::get_ticks() const {
    return run_ != nullptr ? static_cast<int64_t>(run_->ticks()) : 0;
}

double HapticWorld::get_time() const {
    return static_cast<double>(get_ticks()) / tick_rate_;
}

Dictionary HapticWorld::get_statistics() const {
    Dictionary result;
    if (run_ == nullptr) {
        return result;
    }
    result["ticks"] = get_ticks();
    result["bodies"] = static_cast<int64_t>(run_->body_count());
    result["trees_building"] = static_cast<int64_t>(run_->trees_building());
    const SessionSnapshot& snapshot = run_->session().snapshot();
    result["awake_bodies"] = static_cast<int64_t>(snapshot.awake_bodies);
    result["slowed_bodies"] = static_cast<int64_t>(snapshot.slowed_bodies);
    result["physics_steps"] = static_cast<int64_t>(snapshot.physics_steps);
    if (clock_ != CLOCK_REAL_TIME) {
        return result;
    }
    const TickFigures figures = run_->loop().statistics().figures();
    result["measured_ticks"] = static_cast<int64_t>(figures.ticks);
    result["mean_period_us"] = figures.mean_period_us;
    result["tick_period_p10_us"] = figures.period_p10_us;
    result["tick_period_p50_us"] = figures.period_p50_us;
    result["tick_period_p90_us"] = figures.period_p90_us;
    result["tick_period_p99_us"] = figures.period_p99_us;
    result["tick_period_p999_us"] = figures.period_p999_us;
    result["tick_period_max_us"] = figures.period_max_us;
    result["tick_lateness_p50_us"] = figures.lateness_p50_us;
    result["tick_lateness_p99_us"] = figures.lateness_p99_us;
    result["tick_lateness_max_us"] = figures.lateness_max_us;
    result["tick_compute_p50_us"] = figures.compute_p50_us;
    result["tick_compute_p90_us"] = figures.compute_p90_us;
    result["tick_compute_p99_us"] = figures.compute_p99_us;
    result["tick_compute_p999_us"] = figures.compute_p999_us;
    result["tick_compute_max_us"] = figures.compute_max_us;
    result["missed_deadlines"] = static_cast<int64_t>(figures.missed_deadlines);
    result["time_lost_us"] = static_cast<double>(run_->loop().time_lost()) * 1e-3;
    result["realtime"] = to_godot(run_->loop().realtime_report().text);
    result["fifo"] = run_->loop().realtime_report().fifo;
    result["memory_locked"] = run_->loop().realtime_report().memory_locked;
    if (const BaselineLoop* baseline = run_->baseline()) {
        const TickFigures bare = baseline->statistics().figures();
        result["baseline_mean_period_us"] = bare.mean_period_us;
        result["baseline_period_p50_us"] = bare.period_p50_us;
        result["baseline_period_p90_us"] = bare.period_p90_us;
        result["baseline_period_p99_us"] = bare.period_p99_us;
        result["baseline_period_p999_us"] = bare.period_p999_us;
        result["baseline_period_max_us"] = bare.period_max_us;
        result["baseline_missed_deadlines"] = static_cast<int64_t>(bare.missed_deadlines);
    }
    return result;
}

void HapticWorld::reset_statistics() {
    if (run_ == nullptr) {
        return;
    }
    run_->loop().statistics().request_clear();
    if (BaselineLoop* baseline = run_->baseline()) {
        baseline->statistics().request_clear();
    }
}

Dictionary HapticWorld::get_period_distribution() const {
    return run_ != nullptr ? distribution(run_->loop().statistics().periods()) : Dictionary();
}

Dictionary HapticWorld::get_baseline_period_distribution() const {
    const bool measured = run_ != nullptr && run_->baseline() != nullptr;
    return measured ? distribution(run_->baseline()->statistics().periods()) : Dictionary();
}

PackedStringArray HapticWorld::get_problems() const {
    PackedStringArray problems;
    if (run_ != nullptr) {
        for (const std::string& problem : run_->problems()) {
            problems.push_back(to_godot(problem));
        }
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
    find_problems(*this, warnings);
    return warnings;
}

void HapticWorld::_bind_methods() {
    ClassDB::bind_method(D_METHOD("get_warnings"), &HapticWorld::_get_configuration_warnings);
    ClassDB::bind_method(D_METHOD("set_tick_rate", "hertz"), &HapticWorld::set_tick_rate);
    ClassDB::bind_method(D_METHOD("get_tick_rate"), &HapticWorld::get_tick_rate);
    ClassDB::bind_method(D_METHOD("set_clock", "clock"), &HapticWorld::set_clock);
    ClassDB::bind_method(D_METHOD("get_clock"), &HapticWorld::get_clock);
    ClassDB::bind_method(D_METHOD("set_gravity", "gravity"), &HapticWorld::set_gravity);
    ClassDB::bind_method(D_METHOD("get_gravity"), &HapticWorld::get_gravity);
    ClassDB::bind_method(D_METHOD("set_default_material", "material"), &HapticWorld::set_default_material);
    ClassDB::bind_method(D_METHOD("get_default_material"), &HapticWorld::get_default_material);
    ClassDB::bind_method(D_METHOD("set_most_bodies", "count"), &HapticWorld::set_most_bodies);
    ClassDB::bind_method(D_METHOD("get_most_bodies"), &HapticWorld::get_most_bodies);
    ClassDB::bind_method(D_METHOD("set_realtime_priority", "priority"), &HapticWorld::set_realtime_priority);
    ClassDB::bind_method(D_METHOD("get_realtime_priority"), &HapticWorld::get_realtime_priority);
    ClassDB::bind_method(D_METHOD("set_processor", "processor"), &HapticWorld::set_processor);
    ClassDB::bind_method(D_METHOD("get_processor"), &HapticWorld::get_processor);
    ClassDB::bind_method(D_METHOD("set_lock_memory", "lock"), &HapticWorld::set_lock_memory);
    ClassDB::bind_method(D_METHOD("is_locking_memory"), &HapticWorld::is_locking_memory);
    ClassDB::bind_method(D_METHOD("set_measure_baseline", "measure"), &HapticWorld::set_measure_baseline);
    ClassDB::bind_method(D_METHOD("is_measuring_baseline"), &HapticWorld::is_measuring_baseline);
    ClassDB::bind_method(D_METHOD("advance", "seconds"), &HapticWorld::advance);
    ClassDB::bind_method(D_METHOD("is_running"), &HapticWorld::is_running);
    ClassDB::bind_method(D_METHOD("get_ticks"), &HapticWorld::get_ticks);
    ClassDB::bind_method(D_METHOD("get_time"), &HapticWorld::get_time);
    ClassDB::bind_method(D_METHOD("get_statistics"), &HapticWorld::get_statistics);
    ClassDB::bind_method(D_METHOD("reset_statistics"), &HapticWorld::reset_statistics);
    ClassDB::bind_method(D_METHOD("get_period_distribution"), &HapticWorld::get_period_distribution);
    ClassDB::bind_method(D_METHOD("get_baseline_period_distribution"),
                         &HapticWorld::get_baseline_period_distribution);
    ClassDB::bind_method(D_METHOD("get_problems"), &HapticWorld::get_problems);
    ClassDB::bind_method(D_METHOD("_node_added", "node"), &HapticWorld::node_added);
    ClassDB::bind_method(D_METHOD("_node_removed", "node"), &HapticWorld::node_removed);
    ClassDB::bind_method(D_METHOD("_shape_changed"), &HapticWorld::shape_changed);
    ClassDB::bind_method(D_METHOD("_link_changed"), &HapticWorld::link_changed);

    ADD_PROPERTY(PropertyInfo(Variant::INT, "tick_rate", PROPERTY_HINT_RANGE,
                              "100,4000,1,or_less,or_greater,suffix:Hz"),
                 "set_tick_rate", "get_tick_rate");
    ADD_PROPERTY(PropertyInfo(Variant::INT, "clock", PROPERTY_HINT_ENUM, "Real time,Stepped"), "set_clock",
                 "get_clock");
    ADD_PROPERTY(PropertyInfo(Variant::VECTOR3, "gravity", PROPERTY_HINT_NONE, String::utf8("suffix:m/s²")),
                 "set_gravity", "get_gravity");
    ADD_PROPERTY(
        PropertyInfo(Variant::OBJECT, "default_material", PROPERTY_HINT_RESOURCE_TYPE, "HapticMaterial"),
        "set_default_material", "get_default_material");
    ADD_GROUP("Limits", "");
    ADD_PROPERTY(PropertyInfo(Variant::INT, "most_bodies", PROPERTY_HINT_RANGE, "1,65536,1"),
                 "set_most_bodies", "get_most_bodies");
    ADD_GROUP("Haptic Thread", "");
    ADD_PROPERTY(PropertyInfo(Variant::INT, "realtime_priority", PROPERTY_HINT_RANGE, "0,99,1"),
                 "set_realtime_priority", "get_realtime_priority");
    ADD_PROPERTY(PropertyInfo(Variant::INT, "processor", PROPERTY_HINT_RANGE, "-2,63,1,or_greater"),
                 "set_processor", "get_processor");
    ADD_PROPERTY(PropertyInfo(Variant::BOOL, "lock_memory"), "set_lock_memory", "is_locking_memory");
    ADD_PROPERTY(PropertyInfo(Variant::BOOL, "measure_baseline"), "set_measure_baseline",
                 "is_measuring_baseline");

    ADD_SIGNAL(MethodInfo("started"));
    ADD_SIGNAL(MethodInfo("stopped"));
    ADD_SIGNAL(MethodInfo("status_reported", PropertyInfo(Variant::INT, "flags"),
                          PropertyInfo(Variant::STRING, "text")));

    BIND_ENUM_CONSTANT(CLOCK_REAL_TIME);
    BIND_ENUM_CONSTANT(CLOCK_STEPPED);
}

}  // namespace tactus
