#include "nodes/world_run.hpp"

#include <algorithm>
#include <godot_cpp/classes/engine.hpp>
#include <map>
#include <span>

#include "core/haptics/measured_field.hpp"
#include "core/haptics/touch_values.hpp"
#include "nodes/conversions.hpp"
#include "nodes/haptic_device.hpp"
#include "nodes/haptic_effect.hpp"
#include "nodes/haptic_recorder.hpp"
#include "nodes/haptic_vibration_sound.hpp"
#include "nodes/haptic_world.hpp"
#include "nodes/mmt_link.hpp"
#include "nodes/roll.hpp"
#include "nodes/scene_warnings.hpp"
#include "nodes/tree_walk.hpp"
#include "realtime/workers.hpp"
#include "world/scene_telling.hpp"

namespace tactus {

using namespace godot;

namespace {

constexpr const char* too_many_recordings =
    "eight recorders and feedbacks listen to this world already: take one of them away";

constexpr const char* only_here =
    "the other side does not have it, so that hands pass through it: add it there, or take it away here";

// Marks a time in which the same is not to be begun again.
class Busy {
public:
    explicit Busy(bool& flag) : flag_(flag), before_(std::exchange(flag, true)) {}
    ~Busy() { flag_ = before_; }
    Busy(const Busy&) = delete;
    Busy& operator=(const Busy&) = delete;

private:
    bool& flag_;
    bool before_;
};

std::vector<LinkPlan> plans_of(const std::vector<MMTLink*>& links) {
    std::vector<LinkPlan> plans;
    for (MMTLink* link : links) {
        plans.push_back(link->plan());
    }
    return plans;
}

}  // namespace

// Of millions of triangles, that takes longer than a frame has. A run takes tens of megabytes, and scenes may
// open and close worlds in every frame.
void WorldRun::DestroyedAside::operator()(RunningWorld* running) const {
    static BoundedDiscard discard(3);
    discard([running] { delete running; });
}

WorldRun::WorldRun(HapticWorld& world, RunSettings settings)
    : world_(world),
      running_(new RunningWorld(settings.session, settings.real_time, pose_of(world.get_global_transform()),
                                plans_of(settings.links), std::move(settings.inputs))),
      engine_moves_(settings.engine_moves),
      bodies_(world, settings.session.max_bodies, settings.real_time, settings.engine_moves, complaints_) {
    for (const MMTLink* link : settings.links) {
        link_nodes_.push_back(link->get_instance_id());
    }
    if (running_->is_operator()) {
        start_model(*settings.links.front());
    }
    // At the far side the hand is the operator's: what is plugged in here has no part in it, but for robots.
    const bool stands_in =
        !settings.links.empty() && model_ == nullptr && !settings.links.front()->has_robots();
    hands_ = std::make_unique<HandMirrors>(world_, stands_in ? std::make_shared<StandInDevice>() : nullptr);
}

WorldRun::~WorldRun() {
    end();
}

void WorldRun::end() {
    if (is_over()) {
        return;
    }
    running_->end();
    view().release(session());
    for (const std::uint64_t id : link_nodes_) {
        if (auto* link = node_of_id<MMTLink>(id)) {
            link->clear_report();
        }
    }
    hands_->release();
}

void WorldRun::pause() {
    running_->pause();
    hands_->show_devices(session().snapshot());
    hands_->clear_forces();
}

// --- from Godot to the session

void WorldRun::synchronise(double seconds) {
    const Busy busy(is_busy_);
    running_->collect();  // trees that the loop has let go of can be refitted
    synchronise_links();
    if (model_ == nullptr) {
        synchronise_bodies(seconds);
    }
    // A script that has added the world may still be adding the devices that its hands lack.
    complaints_.mute(std::exchange(is_starting_, false));
    hands_->synchronise(session(), complaints_, !loop().is_real_time());
    complaints_.mute(false);
    look_at_scene();
    synchronise_recorders();
    for (HapticVibrationSound* feedback : Roll<HapticVibrationSound>::all()) {
        if (!feedback->is_wanted()) {
            running_->listeners().end(session(), feedback->get_instance_id());
        } else if (HapticWorld::of(feedback) == &world_) {
            give_ticks(*feedback, feedback->ring(), no_handle);
        }
    }
    if (running_->collect()) {
        hands_->forget_retired();
    }
}

bool WorldRun::may_start_anew(const std::string& need) {
    const bool may = hands_->touched().empty();
    complaints_.say(world_, may ? std::string()
                                : "Godot's own physics is to move its bodies, because " + need +
                                      ": it takes over as soon as no hand touches anything");
    return may;
}

// Once the scene has had time to come together: a second of frames, or when a script advances time again.
void WorldRun::look_at_scene() {
    constexpr std::uint32_t frames_between = 64;
    const std::uint32_t first = loop().is_real_time() ? frames_between : 2;
    if (++looks_ < first || (looks_ - first) % frames_between != 0 || model_ != nullptr) {
        return;
    }
    const BodyMirrors& mirrors = bodies_.mirrors();
    if (mirrors.without_place() > 0) {
        complaints_.say(world_,
                        "it has more bodies than it takes, and some are left out: raise 'max_bodies' "
                        "(get_problems() counts them)");
    }
    for (const auto& [body, problem] : mirrors.fallen_through()) {
        body->say(problem);
    }
    const SceneFacts facts = mirrors.facts();
    hands_->look_at_scene(facts, complaints_);
    if (mirrors.bodies().empty() && !engine_moves_) {
        complaints_.say(world_, problem_of_emptiness(world_));
    } else if (looks_ == first) {
        complaints_.say(world_, problem_of_outside(world_));
        for (const std::string& problem :
             engine_moves_ ? std::vector<std::string>() : problems_across(world_)) {
            complaints_.say(world_, problem);
        }
    }
}

void WorldRun::synchronise_bodies(double seconds) {
    running_->push_for(seconds);
    complaints_.say(world_, problem_of_time());
    const BodyDefaults defaults = world_.body_defaults();
    if (!same_values(defaults.touch, defaults_.touch) || !same_detail(defaults.detail, defaults_.detail)) {
        bodies_.mirrors().note_all_changed();
    }
    defaults_ = defaults;
    bodies_.mirrors().touched(hands_->touched());
    // In real time a tick may be under way that has already taken its commands.
    const std::uint64_t takes_effect = loop().ticks() + (loop().is_real_time() ? 2 : 1);
    MirrorContext context{session(), Workers::shared(), defaults_, seconds, takes_effect};
    context.touch_radius = hands_->smallest_radius();
    context.ticks = loop().ticks() > 0 || !loop().is_real_time();
    context.together = loop().is_real_time();
    context.engine_moves = engine_moves_;
    if (engine_moves_) {  // it moves them no more often
        context.seconds = std::max(seconds, frame_seconds());
    }
    bodies_.synchronise(context);
    waited_ += context.ticks || trees_building() == 0 ? 0.0 : seconds;
}

// --- the far side

void WorldRun::start_model(const MMTLink& link) {
    model_ = std::make_unique<ModelView>(world_);
    running_->links().front()->set_distortion(
        [this, errors = link.model_errors()](ObjectDescription& object) {
            if (const auto error = errors.find(object.name); error != errors.end()) {
                distort(error->second, object);
            }
            model_->note(object);
        });
}

void WorldRun::synchronise_links() {
    const auto& links = running_->links();
    for (std::size_t i = 0; i < links.size(); ++i) {
        auto* const node = node_of_id<MMTLink>(link_nodes_[i]);
        const bool has_new_objects =
            running_->synchronise(*links[i], node != nullptr ? std::optional(node->plan()) : std::nullopt,
                                  from_godot(world_.get_gravity()));
        if (has_new_objects || (model_ != nullptr && model_->takes_scene_change())) {
            std::ranges::move(model_->update(links[i]->objects()), std::back_inserter(model_news_));
            model_changed_ = loop().now();
            is_model_compared_ = false;
        }
    }
    compare_model();
    if (model_ == nullptr) {
        tell(bodies_.mirrors(), links, session().snapshot(), loop().now());
    }
}

// All that was sent so far is there in the first tick.
bool WorldRun::may_begin() {
    const bool is_new = loop().ticks() == 0;
    if (is_new && trees_building() > 0) {
        return false;
    }
    if (is_new) {
        session().settle();
    }
    return true;
}

// Once the far side has described nothing more for a while.
void WorldRun::compare_model() {
    constexpr Nanoseconds settled_after = 2 * nanoseconds_per_second;
    if (model_ == nullptr || model_->body_count() == 0 || loop().now() - model_changed_ < settled_after ||
        std::exchange(is_model_compared_, true)) {
        return;
    }
    for (const Node* const body : model_->bodies_only_here()) {
        complaints_.say(*body, only_here);
    }
}

// --- recording

void WorldRun::synchronise_recorders() {
    for (HapticRecorder* recorder : Roll<HapticRecorder>::all()) {
        if (!recorder->is_recording() || HapticWorld::of(recorder) != &world_) {
            continue;
        }
        if (running_->recording() == nullptr) {
            recorder_ = recorder->get_instance_id();
            complaints_.say(world_, running_->record(recorder->recording()));
        }
        if (running_->recording() == recorder->recording()) {
            give_ticks(*recorder, recorder->recording()->ring(), body_of(recorder->object_node()));
        } else {
            complaints_.say(*recorder, "another HapticRecorder, " + name_of(*node_of_id<Node>(recorder_)) +
                                           ", records this world already: stop that one first");
        }
        recorder->tell_state();
    }
}

template <class NodeType>
void WorldRun::give_ticks(const NodeType& node, const std::shared_ptr<TickRing>& ring, SessionHandle body) {
    complaints_.say(node, node.problem());
    const SessionHandle proxy = hands_->handle_of(node.hand_node());
    if (proxy != no_handle &&
        !running_->listeners().listen(session(), node.get_instance_id(), ring, proxy, body)) {
        complaints_.say(node, too_many_recordings);
    }
}

// --- what leaves

void WorldRun::node_removed(Node& node) {
    const std::uint64_t id = node.get_instance_id();
    hands_->end_contacts(id);
    hands_->forget(id, session());
    running_->listeners().end(session(), id);
    std::ranges::replace(link_nodes_, id, std::uint64_t{0});
    view().scene_changed(node, false);
}

void WorldRun::finish(HapticRecorder& recorder) {
    if (recorder.recording() == running_->recording()) {
        running_->finish_recording();
        running_->listeners().end(session(), recorder_);
    }
}

// --- from the session to Godot

void WorldRun::show() {
    const Busy busy(is_busy_);
    running_->drain();
    std::vector<LinkReport> reports;
    for (const auto& link : running_->links()) {
        reports.push_back(link->report());
    }
    const std::vector<ModelNews> news = std::exchange(model_news_, {});
    is_fresh_ |= session().refresh();
    if (std::exchange(is_fresh_, false)) {
        const SessionSnapshot& snapshot = session().snapshot();
        hands_->show_devices(snapshot);
        if (!engine_moves_) {
            show_bodies(snapshot);
        }
        if (!is_over()) {
            hands_->show_pointers(snapshot, [this](SessionHandle body) { return view().node_of(body); });
        }
    }
    // A script may have freed some of them by now.
    for (std::size_t i = 0; i < reports.size(); ++i) {
        if (auto* node = node_of_id<MMTLink>(link_nodes_[i])) {
            node->take_report(reports[i], news);
        }
    }
}

// Engine.time_scale changes how far a step goes and not how often it comes. A script that advances a world
// gives it the game's time.
double WorldRun::frame_seconds() const {
    return loop().is_real_time() ? 1.0 / Engine::get_singleton()->get_physics_ticks_per_second()
                                 : world_.get_physics_process_delta_time();
}

void WorldRun::exchange() {
    const double seconds = frame_seconds();
    if (seconds <= 0.0) {
        return;
    }
    is_fresh_ |= session().refresh();
    const SessionSnapshot& snapshot = session().snapshot();
    hand_places_.clear();
    for (const ProxyState& proxy : std::span(snapshot.proxies).first(snapshot.proxy_count)) {
        hand_places_.push_back(proxy.position);
    }
    for (const ToolState& tool : std::span(snapshot.tools).first(snapshot.tool_count)) {
        hand_places_.push_back(tool.pose.position);
    }
    const bool keeps_time = !loop().is_real_time() || Engine::get_singleton()->get_time_scale() == 1.0;
    bodies_.exchange({session(), hand_places_, {}, seconds, world_.tick_seconds(), keeps_time});
}

// A script that is called as a body moves may end all this.
void WorldRun::show_bodies(const SessionSnapshot& snapshot) {
    view().begin_to_show();
    for (std::size_t i = 0; i < snapshot.body_count && !is_over(); ++i) {
        view().show(snapshot.bodies[i], snapshot.tick, session());
    }
}

// Of a device position; nothing where the hand is not in the session yet.
std::optional<HandMotion> WorldRun::motion_of(SessionHandle handle, const Node3D* hand) {
    const SessionSnapshot& snapshot = session().snapshot();
    if (const ProxyState* const state = tactus::state_of(snapshot.proxies, snapshot.proxy_count, handle)) {
        return HandMotion{state->hand, state->hand_velocity};
    }
    const auto* const tool = Object::cast_to<HapticTool>(hand);
    const HapticDevice* const device = tool != nullptr && handle != no_handle ? tool->device_node() : nullptr;
    return device != nullptr ? std::optional(HandMotion{from_godot(device->get_hand_position()),
                                                        from_godot(device->get_hand_velocity())})
                             : std::nullopt;
}

// Where a script may free any of them, and the world.
void WorldRun::ask_effects() {
    if (Roll<HapticEffect>::all().empty() || is_over()) {
        asked_.clear();
        return;
    }
    const Busy busy(is_busy_);
    std::vector<std::uint64_t> ids;
    for (const HapticEffect* effect : Roll<HapticEffect>::all()) {
        if (HapticWorld::of(effect) == &world_) {
            ids.push_back(effect->get_instance_id());
        }
    }
    struct Hand {
        HandMotion motion;
        std::vector<std::uint64_t> effects;
    };
    std::map<SessionHandle, Hand> hands;
    const double time = to_seconds(session().snapshot().time);
    for (const std::uint64_t id : ids) {
        auto* const effect = node_of_id<HapticEffect>(id);
        if (effect == nullptr || is_over()) {
            continue;
        }
        complaints_.say(*effect, effect->problem());
        const SessionHandle handle = hands_->handle_of(effect->hand_node());
        const std::optional<HandMotion> motion = motion_of(handle, effect->hand_node());
        if (motion && effect->begin_frame()) {
            Hand& hand = hands[handle];
            hand.motion = *motion;
            hand.effects.push_back(id);
        }
    }
    std::map<SessionHandle, FieldMoment> before = std::exchange(asked_, {});
    for (const auto& [proxy, hand] : hands) {
        const auto known = before.find(proxy);
        const FieldMoment last = known != before.end() ? known->second : FieldMoment{hand.motion.position};
        const std::optional<FieldMoment> moment = ask_effects(hand.effects, hand.motion, time, last);
        if (moment && !is_over()) {
            asked_[proxy] = *moment;
            session().set_hand_field(proxy, *moment);
        }
    }
}

// What several say of one hand adds up; nothing if one of them is switched off by that, or the world stops.
std::optional<FieldMoment> WorldRun::ask_effects(const std::vector<std::uint64_t>& effects,
                                                 const HandMotion& hand, double time,
                                                 const FieldMoment& before) {
    const auto sum = [&](const HandMotion& at) -> std::optional<Vec3> {
        Vec3 force(0.0);
        for (const std::uint64_t id : effects) {
            auto* const effect = node_of_id<HapticEffect>(id);
            const auto answer = effect != nullptr && !is_over() ? effect->ask(at, time) : std::nullopt;
            if (!answer) {
                return std::nullopt;
            }
            force += *answer;
        }
        return force;
    };
    const std::optional<FieldMoment> moment = measured_field(hand, before, sum);
    bool are_on = true;
    for (const std::uint64_t id : effects) {
        auto* const effect = node_of_id<HapticEffect>(id);
        are_on = effect != nullptr && effect->end_frame() && are_on;
    }
    return are_on ? moment : std::nullopt;
}

// Devices and hands have the time of the clock.
std::string WorldRun::problem_of_time() const {
    if (!loop().is_real_time() || Engine::get_singleton()->get_time_scale() == 1.0) {
        return {};
    }
    const std::string so = engine_moves_ ? "hands feel its bodies and push none"
                                         : "what scripts move and what it moves disagree";
    return "'Engine.time_scale' is not 1, and a HapticWorld in real time keeps to the clock: " + so +
           "; leave it at 1, or set the world's clock to CLOCK_STEPPED and advance it";
}

namespace {

// An error of a body that the far side has not described changes nothing.
std::vector<std::string> problems_of_errors(const MMTLink& link, const std::vector<ModelObject>& objects) {
    std::vector<std::string> problems;
    std::string known;
    for (const ModelObject& object : objects) {
        known += (known.empty() ? "" : ", ") + object.name;
    }
    for (const auto& [name, error] : link.model_errors()) {
        if (!objects.empty() && std::ranges::find(objects, name, &ModelObject::name) == objects.end()) {
            problems.push_back(from_godot(name_of(link)) + ": model_errors names '" + name +
                               "', which the other side does not have: it has " + known);
        }
    }
    return problems;
}

}  // namespace

std::vector<std::string> WorldRun::problems() const {
    std::vector<std::string> all;
    for (const auto& link : running_->links()) {
        std::ranges::move(link->problems(), std::back_inserter(all));
    }
    if (model_ == nullptr) {
        std::ranges::move(bodies_.problems(), std::back_inserter(all));
        if (!engine_moves_) {
            std::ranges::move(problems_across(world_), std::back_inserter(all));
        }
    }
    if (std::string slow = problem_of_time(); !slow.empty()) {
        all.push_back(std::move(slow));
    }
    if (model_ != nullptr && model_->body_count() > 0 && running_->links().front()->is_described()) {
        for (const Node* const body : model_->bodies_only_here()) {
            all.push_back(from_godot(name_of(*body)) + ": " + only_here);
        }
    }
    const auto* const link = model_ != nullptr ? node_of_id<MMTLink>(link_nodes_.front()) : nullptr;
    if (link != nullptr) {
        std::ranges::move(problems_of_errors(*link, running_->links().front()->objects()),
                          std::back_inserter(all));
    }
    return all;
}

}  // namespace tactus
