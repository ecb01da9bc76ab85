#include "nodes/world_run.hpp"

#include <algorithm>
#include <godot_cpp/classes/project_settings.hpp>
#include <godot_cpp/core/object.hpp>

#include "core/haptics/touch_values.hpp"
#include "nodes/conversions.hpp"
#include "nodes/haptic_feedback.hpp"
#include "nodes/haptic_recorder.hpp"
#include "nodes/haptic_world.hpp"
#include "nodes/mmt_link.hpp"
#include "nodes/roll.hpp"
#include "nodes/scene_warnings.hpp"
#include "nodes/tree_walk.hpp"
#include "world/scene_telling.hpp"

namespace tactus {

using namespace godot;

namespace {

double project_number(const char* name, double otherwise) {
    return ProjectSettings::get_singleton()->get_setting(name, otherwise);
}

constexpr const char* too_many_recordings =
    "eight recorders and feedbacks listen to this world already: take one of them away";

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

}  // namespace

WorldRun::WorldRun(HapticWorld& world, const RunSettings& settings)
    : world_(world),
      settings_(settings),
      session_(settings.session),
      loop_(session_, settings.real_time),
      bodies_(world, settings.session.most_bodies, settings.real_time, complaints_) {
    defaults_.linear_damping = project_number("physics/3d/default_linear_damp", 0.1);
    defaults_.angular_damping = project_number("physics/3d/default_angular_damp", 0.1);
    start_links();
    // At the far side the hand is the operator's: what is plugged in here has no part in it, but for robots.
    const bool stands_in = !links_.empty() && model_ == nullptr && !links_.front().node->has_robots();
    hands_ = std::make_unique<HandMirrors>(world_, stands_in ? std::make_shared<StandInDevice>() : nullptr);
}

WorldRun::~WorldRun() {
    end();
}

void WorldRun::end() {
    if (std::exchange(is_over_, true)) {
        return;
    }
    stop_loop();
    for (const OwnLink& link : links_) {
        link.link->leave();
    }
    if (!links_.empty()) {
        loop_.tick_once();
    }
    session_.rest();
    view().release(session_);
    for (const OwnLink& link : links_) {
        link.link->end();
        if (link.node != nullptr) {
            link.node->clear_report();
        }
    }
    hands_->release();
    recording_.reset();  // whoever closes its files is not to wait for this run to go
}

// --- time

void WorldRun::stop_loop() {
    loop_.stop();
    drain();
}

void WorldRun::pause() {
    stop_loop();
    session_.rest();
    session_.refresh();
    hands_->show_devices(session_.snapshot());
    hands_->clear_forces();
}

void WorldRun::advance(std::int64_t ticks) {
    loop_.advance(ticks, [this] {
        session_.collect();
        drain();
    });
}

// --- from Godot to the session

void WorldRun::synchronise(double seconds) {
    const Busy busy(is_busy_);
    session_.collect();  // trees that the loop has let go of can be refitted
    synchronise_links();
    if (model_ != nullptr) {
        model_->hold_still();
    } else {
        synchronise_bodies(seconds);
    }
    hands_->synchronise(session_, complaints_);
    look_at_scene();
    synchronise_recorders();
    for (HapticFeedback* feedback : Roll<HapticFeedback>::all()) {
        if (!feedback->is_wanted()) {
            forget(*feedback);
        } else if (HapticWorld::of(feedback) == &world_) {
            give_ticks(*feedback, feedback->ring(), no_handle);
        }
    }
    if (!session_.collect()) {
        listeners_.forget_retired();
        hands_->forget_retired();
    }
}

// Once the scene has had time to come together: a second of frames, or when a script advances time again.
void WorldRun::look_at_scene() {
    constexpr std::uint32_t frames_between = 64;
    const std::uint32_t first = settings_.real_time ? frames_between : 2;
    if (++looks_ < first || (looks_ - first) % frames_between != 0 || model_ != nullptr) {
        return;
    }
    const BodyMirrors& mirrors = bodies_.mirrors();
    const SceneFacts facts = mirrors.facts();
    hands_->look_at_scene(facts, complaints_);
    if (mirrors.bodies().empty()) {
        complaints_.say(world_, problem_of_emptiness(world_));
    } else if (looks_ == first) {
        complaints_.say(world_, problem_of_outside(world_));
    }
}

void WorldRun::push(SessionHandle body, const BodyPush& push, bool for_a_frame) {
    if (for_a_frame) {
        forces_.emplace_back(body, push);
    } else {
        session_.push_body(body, push);
    }
}

void WorldRun::synchronise_bodies(double seconds) {
    for (auto& [body, push] : forces_) {
        push.impulse *= seconds;
        push.turn *= seconds;
        session_.push_body(body, push);
    }
    forces_.clear();
    const TouchMaterial touch = world_.default_touch();
    const std::shared_ptr<const HeightImage> texture = world_.default_texture();
    if (!same_values(touch, defaults_.touch) || texture != defaults_.texture) {
        bodies_.mirrors().note_all_changed();
    }
    defaults_.touch = touch;
    defaults_.texture = texture;
    bodies_.mirrors().touched(hands_->touched());
    // In real time a tick may be under way that has already taken its commands.
    const std::uint64_t takes_effect = loop_.ticks() + (settings_.real_time ? 2 : 1);
    bodies_.synchronise({session_, Workers::shared(), defaults_, seconds, takes_effect});
}

// --- the far side

void WorldRun::start_links() {
    std::vector<WorldLink*> attached;
    for (MMTLink* const node : settings_.links) {
        auto link = std::make_unique<WorldLink>(node->plan(), session_, from_godot(world_.get_gravity()),
                                                pose_of(world_.get_global_transform()), loop_.ahead());
        attached.push_back(link.get());
        links_.push_back({node, std::move(link)});
    }
    WorldLink::attach(session_, attached);
    if (links_.empty() || !links_.front().link->is_operator()) {
        return;
    }
    model_ = std::make_unique<ModelView>(world_);
    const OwnLink& link = links_.front();
    link.link->set_distortion([this, errors = link.node->model_errors()](ObjectDescription& description) {
        if (const auto error = errors.find(description.name); error != errors.end()) {
            distort(error->second, description);
        }
        model_->note(description);
    });
}

void WorldRun::synchronise_links() {
    const Nanoseconds now = loop_.now();
    for (const OwnLink& link : links_) {
        const bool has_new_objects =
            link.link->synchronise(link.node != nullptr ? std::optional(link.node->plan()) : std::nullopt,
                                   from_godot(world_.get_gravity()), Workers::shared(),
                                   {now, !loop_.is_running(), !settings_.real_time});
        if (has_new_objects) {
            std::ranges::move(model_->update(link.link->objects()), std::back_inserter(model_news_));
        }
    }
    if (!links_.empty() && model_ == nullptr) {
        std::vector<WorldLink*> all;
        std::ranges::transform(links_, std::back_inserter(all),
                               [](const OwnLink& own) { return own.link.get(); });
        tell(bodies_.mirrors(), all, session_.snapshot(), now);
    }
}

// --- recording

void WorldRun::synchronise_recorders() {
    for (HapticRecorder* recorder : Roll<HapticRecorder>::all()) {
        if (!recorder->is_recording() || HapticWorld::of(recorder) != &world_) {
            continue;
        }
        if (recording_ == nullptr) {
            recorder_ = recorder->get_instance_id();
            recording_ = recorder->recording();
            if (recording_->has_trace()) {
                complaints_.say(world_, loop_.trace_ticks());
            }
        }
        if (recording_ == recorder->recording()) {
            give_ticks(*recorder, recording_->ring(), body_of(recorder->object_node()));
        } else {
            complaints_.say(*recorder, "another HapticRecorder, " + name_of(*node_of_id<Node>(recorder_)) +
                                           ", records this world already: stop that one first");
        }
    }
}

template <class NodeType>
void WorldRun::give_ticks(const NodeType& node, const std::shared_ptr<TickRing>& ring, SessionHandle body) {
    complaints_.say(node, node.problem());
    const SessionHandle proxy = hands_->handle_of(node.proxy_node());
    if (proxy != no_handle && !listeners_.listen(session_, node.get_instance_id(), ring, proxy, body)) {
        complaints_.say(node, too_many_recordings);
    }
}

void WorldRun::drain() {
    if (recording_ == nullptr) {
        return;
    }
    recording_->drain(loop_.epoch());
    if (TickTrace* trace = loop_.trace()) {
        recording_->drain(*trace);
    }
}

// --- what leaves

void WorldRun::forget(HapticFeedback& feedback) {
    listeners_.end(session_, feedback.get_instance_id());
}

void WorldRun::forget(MMTLink& link) {
    for (OwnLink& one : links_) {
        one.node = one.node == &link ? nullptr : one.node;
    }
}

void WorldRun::finish(HapticRecorder& recorder) {
    if (recorder.recording() == recording_) {
        drain();
        listeners_.end(session_, recorder_);
        recording_.reset();
    }
}

// --- from the session to Godot

const BodyState* WorldRun::state_of(const Node* node) {
    const SessionHandle body = body_of(node);
    const SessionSnapshot& snapshot = session_.snapshot();
    for (std::size_t i = 0; body != no_handle && i < snapshot.body_count; ++i) {
        if (snapshot.bodies[i].handle == body) {
            return &snapshot.bodies[i];
        }
    }
    return nullptr;
}

void WorldRun::show() {
    const Busy busy(is_busy_);
    drain();
    std::vector<std::pair<std::uint64_t, LinkReport>> reports;
    for (const OwnLink& link : links_) {
        if (link.node != nullptr) {
            reports.emplace_back(link.node->get_instance_id(), link.link->report());
        }
    }
    const std::vector<ModelNews> news = std::exchange(model_news_, {});
    if (session_.refresh()) {
        const SessionSnapshot& snapshot = session_.snapshot();
        hands_->show_devices(snapshot);
        show_bodies(snapshot);
        if (!is_over_) {
            hands_->show_proxies(snapshot, [this](SessionHandle body) { return view().node_of(body); });
        }
    }
    // A script may have freed some of them by now.
    for (const auto& [id, report] : reports) {
        if (auto* node = node_of_id<MMTLink>(id)) {
            node->take_report(report, news);
        }
    }
}

// A script that is called as a body moves may end all this.
void WorldRun::show_bodies(const SessionSnapshot& snapshot) {
    for (std::size_t i = 0; i < snapshot.body_count && !is_over_; ++i) {
        view().show(snapshot.bodies[i], snapshot.tick);
    }
}

std::vector<std::string> WorldRun::problems() const {
    std::vector<std::string> all;
    for (const OwnLink& link : links_) {
        std::ranges::move(link.link->problems(), std::back_inserter(all));
    }
    std::ranges::move(bodies_.mirrors().problems(), std::back_inserter(all));
    return all;
}

}  // namespace tactus
