#include "nodes/link_run.hpp"

#include <algorithm>
#include <unordered_set>

#include "network/key_source.hpp"
#include "nodes/conversions.hpp"
#include "nodes/haptic_world.hpp"
#include "nodes/messages.hpp"
#include "session/operator_side.hpp"
#include "session/teleoperator_side.hpp"

namespace tactus {

using namespace godot;

namespace {

// A way that could not be opened is tried again so much later: the port may have become free.
constexpr Nanoseconds try_again_after = 2'000'000'000;

// So long what is not believed counts as the state of the link.
constexpr Nanoseconds refusal_lasts = 1'000'000'000;

// A body whose values change in every frame is not described in every frame.
constexpr Nanoseconds tell_again_after = 250'000'000;

std::string ports(const NetworkSettings& settings) {
    return settings.udp.remote_address + ":" + std::to_string(settings.udp.remote_port) +
           " (this side listens on port " + std::to_string(settings.udp.local_port) + ")";
}

// { "Ground": { "turn": [1, 0, 0, 10], "mass": 1.2 } }: what an experiment makes wrong about the model.
Vec3 vector_of(const Array& numbers) {
    Vec3 v(0.0);
    for (int i = 0; i < 3 && i < numbers.size(); ++i) {
        v[i] = static_cast<double>(numbers[i]);
    }
    return v;
}

void distort(const Dictionary& errors, ObjectDescription& description) {
    const Variant wrong = errors.get(to_godot(description.name), Variant());
    if (wrong.get_type() != Variant::DICTIONARY) {
        return;
    }
    const Dictionary error = wrong;
    const auto factor = [&error](const char* what) {
        const double value = error.get(what, 1.0);
        return is_at_least_zero(value) ? value : 1.0;
    };
    BodyDescription& body = description.body;
    if (error.has("move")) {
        body.pose.position += vector_of(error["move"]);
    }
    if (error.has("turn")) {  // axis, degrees
        const Array turn = error["turn"];
        const Vec3 axis = vector_of(turn);
        if (turn.size() == 4 && glm::length(axis) > 0.0) {
            const double angle = glm::radians(static_cast<double>(turn[3]));
            body.pose.rotation = glm::angleAxis(angle, glm::normalize(axis)) * body.pose.rotation;
        }
    }
    body.mass *= factor("mass");
    body.material.friction *= factor("friction");
    description.touch.static_friction *= factor("touch_friction");
    description.touch.dynamic_friction *= factor("touch_friction");
    description.touch.stiffness *= factor("stiffness");
}

}  // namespace

LinkRun::LinkRun(MMTLink& node, HapticWorld& world, Session& session, const std::atomic<Nanoseconds>* ahead)
    : node_(&node),
      operator_(node.is_operator()),
      ahead_(ahead),
      world_(world),
      session_settings_(session.settings()),
      gravity_(from_godot(world.get_gravity())),
      frame_(pose_of(world.get_global_transform())),
      port_(std::make_shared<TeleopPort>()) {
    if (operator_) {
        view_ = std::make_unique<ModelView>(world);
        builder_ = std::make_unique<ModelBuilder>(session, port_);
        builder_->set_frame(frame_);
        builder_->set_distortion([this, errors = node.get_model_errors()](ObjectDescription& description) {
            distort(errors, description);
            view_->note(description);
        });
    } else {
        teller_ = std::make_unique<EnvironmentTeller>(port_);
        teller_->set_frame(frame_);
    }
}

LinkRun::~LinkRun() = default;

void LinkRun::end() {
    if (node_ != nullptr) {
        node_->clear_report();
    }
    node_ = nullptr;
    route_.put(nullptr);
    route_.take();
    opening_.reset();
    past_way_.reset();
    way_.reset();
}

std::unique_ptr<TeleopSide> LinkRun::make_side(const PointerShare& share) {
    EndpointSettings endpoint;
    endpoint.side = operator_ ? Side::operator_side : Side::teleoperator_side;
    endpoint.scenario = static_cast<std::uint8_t>(node_->get_scenario());
    endpoint.epoch = random_epoch();
    endpoint.period = session_settings_.period;
    settings_ = node_->teleop_settings();
    settings_.gravity = gravity_;
    settings_.frame = frame_;
    if (operator_) {
        return std::make_unique<OperatorSide>(session_settings_, OperatorRoom{}, settings_, route_, port_,
                                              endpoint);
    }
    return std::make_unique<TeleoperatorSide>(session_settings_, settings_, route_, port_, endpoint, share);
}

// --- the way
// ---------------------------------------------------------------------------------------------------------

void LinkRun::let_go_of_way() {
    route_.put(nullptr);
    opening_.reset();
    if (way_ != nullptr) {
        past_way_ = std::move(way_);
    }
    way_error_.clear();
    figures_ = {};
}

void LinkRun::put(std::unique_ptr<LinkWay> way) {
    way_ = std::move(way);
    route_.put(way_.get());
}

// The loop may look at it as long as the run lasts.
void LinkRun::keep_trace() {
    if (traces_.empty() || traces_.back() != node_->trace()) {
        traces_.push_back(node_->trace());
    }
}

// A way is opened anew only when the loop has let go of the one before: both may want the same port.
void LinkRun::look_after_way(Workers& workers, const LinkMoment& moment) {
    if (node_ != nullptr && node_->way_revision() != way_revision_) {
        way_revision_ = node_->way_revision();
        let_go_of_way();
        next_try_ = moment.now;
    }
    if (node_ == nullptr || !node_->problem().is_empty()) {
        if (way_ != nullptr || opening_ != nullptr) {
            let_go_of_way();
        }
        return;
    }
    if (moment.ticks_here) {
        route_.take();
    }
    if (past_way_ != nullptr && route_.is_taken()) {
        past_way_.reset();
    }
    if (opening_ != nullptr) {
        take_opened(moment);
    } else if (way_ == nullptr && past_way_ == nullptr && moment.now >= next_try_) {
        open(workers, moment);
    }
}

void LinkRun::open(Workers& workers, const LinkMoment& moment) {
    NetworkSettings settings = node_->network_settings();
    keep_trace();
    if (node_->partner_node() != nullptr) {
        put(std::make_unique<InProcessWay>(node_->wire(), operator_, settings.conditions, settings.seed));
        return;
    }
    KeySource key = read_key(from_godot(node_->get_key_file()));
    if (!key.error.empty()) {
        way_error_ = std::move(key.error);
        next_try_ = moment.now + try_again_after;
        return;
    }
    settings.key = std::move(key.text);
    opening_ = std::make_shared<Opening>();
    opening_->settings = std::move(settings);
    opening_->way = std::make_unique<UdpWay>(ahead_);
    workers.add([opening = opening_] {
        opening->error = opening->way->open(opening->settings);
        opening->done.store(true, std::memory_order_release);
    });
    if (moment.waits) {
        workers.wait();
        take_opened(moment);
    }
}

void LinkRun::take_opened(const LinkMoment& moment) {
    if (!opening_->done.load(std::memory_order_acquire)) {
        return;
    }
    const std::shared_ptr<Opening> opened = std::move(opening_);
    opening_.reset();
    way_error_ = opened->error;
    if (way_error_.empty()) {
        put(std::move(opened->way));
        way_->change(node_->conditions());
    } else {
        next_try_ = moment.now + try_again_after;
    }
}

// --- what has changed
// ------------------------------------------------------------------------------------------------

void LinkRun::pass_on_settings() {
    const Vec3 gravity = from_godot(world_.get_gravity());
    if (node_ == nullptr || (node_->revision() == revision_ && gravity == gravity_)) {
        return;
    }
    revision_ = node_->revision();
    gravity_ = gravity;
    settings_ = node_->teleop_settings();
    settings_.gravity = gravity_;
    settings_.frame = frame_;
    port_->settings.publish(settings_);
    if (way_ != nullptr) {
        keep_trace();
        way_->change(node_->conditions());
    }
}

void LinkRun::leave() {
    settings_.leaving = true;
    port_->settings.publish(settings_);
}

void LinkRun::synchronise(Workers& workers, const LinkMoment& moment) {
    now_ = moment.now;
    look_after_way(workers, moment);
    pass_on_settings();
    port_->statistics.refresh();
    if (way_ != nullptr) {
        figures_ = way_->figures();
    }
    note_refusals(moment.now);
    if (builder_ != nullptr && !builds_elsewhere_ && !moment.waits) {
        builds_elsewhere_ = true;
        builder_->set_run([&workers](std::function<void()> job) { workers.add(std::move(job)); });
    }
    if (builder_ != nullptr && builder_->update(moment.now, port_->statistics.front().link)) {
        for (ModelNews& news : view_->update(builder_->objects())) {
            object_news_.push_back(std::move(news));
        }
    }
}

void LinkRun::tell(const BodyMirrors& scene, const SessionSnapshot& snapshot, Nanoseconds now) {
    tell_bodies(scene, now);
    tell_joints(scene);
    teller_->update(snapshot, port_->statistics.front().link.peer_epoch);
}

void LinkRun::tell_joints(const BodyMirrors& scene) {
    std::unordered_set<SessionHandle> there;
    for (const auto& mirror : scene.joints()) {
        if (mirror->handle() == no_handle) {
            continue;
        }
        there.insert(mirror->handle());
        const std::pair<std::uint64_t, std::uint64_t> now{mirror->id(), mirror->revision()};
        const auto [told, is_new] = told_joints_.try_emplace(mirror->handle());
        if (is_new || told->second != now) {
            told->second = now;
            teller_->tell_joint(mirror->handle(), mirror->joined(), mirror->first(), mirror->second());
        }
    }
    std::erase_if(told_joints_, [&](const auto& told) {
        const bool gone = !there.contains(told.first);
        if (gone) {
            teller_->forget_joint(told.first);
        }
        return gone;
    });
}

void LinkRun::tell_bodies(const BodyMirrors& scene, Nanoseconds now) {
    std::unordered_set<SessionHandle> there;
    for (const auto& mirror : scene.bodies()) {
        CollisionObject3D* body = mirror->body();
        if (mirror->handle() == no_handle || body == nullptr) {
            continue;
        }
        there.insert(mirror->handle());
        const auto told = tellings_.find(mirror->handle());
        const bool is_new = told == tellings_.end();
        if (is_new ||
            (told->second.revision != mirror->revision() && now - told->second.at >= tell_again_after)) {
            const std::string name = from_godot(String(world_.get_path_to(body)));
            tellings_[mirror->handle()] = {mirror->revision(), now,
                                           teller_->tell(mirror->handle(), name, mirror->addition())};
        }
    }
    std::erase_if(tellings_, [&](const auto& telling) {
        const bool gone = !there.contains(telling.first);
        if (gone) {
            teller_->forget(telling.first);
        }
        return gone;
    });
}

std::vector<std::string> LinkRun::problems() const {
    std::vector<std::string> all;
    for (const auto& [handle, telling] : tellings_) {
        if (!telling.problem.empty()) {
            all.push_back(telling.problem);
        }
    }
    if (builder_ != nullptr) {
        all = builder_->joints().problems();
        for (const ModelObject& object : builder_->objects()) {
            if (!object.problem.empty()) {
                all.push_back("\"" + object.name + "\" of the far side: " + object.problem);
            }
        }
    }
    return all;
}

// --- in words
// --------------------------------------------------------------------------------------------------------

// Which of the counters for what is not believed have grown.
void LinkRun::note_refusals(Nanoseconds now) {
    const LinkStatistics& link = port_->statistics.front().link;
    const bool unmet = figures_.udp.sealed && !figures_.udp.met;
    const std::array<std::uint64_t, 5> counts = {
        unmet ? figures_.udp.secure.wrong_key : 0, unmet ? figures_.udp.secure.not_sealed : 0,
        link.refused.of(Refusal::sealed), link.refused.of(Refusal::wrong_version), figures_.udp.refused};
    constexpr const char* words[] = {
        "the far side has another key: give both sides the same",
        "the far side has no key: give both sides the same, or none",
        "the far side has a key and this side has none: give both sides the same",
        "the far side speaks another version of the protocol: install the same version of Tactus on both "
        "sides",
        "the far side expects somebody else at that port: set its 'remote_address' and 'remote_port' to this "
        "side's, or give this operator an MMTLink of its own there",
    };
    for (std::size_t i = 0; i < counts.size(); ++i) {
        if (counts[i] > refusals_[i]) {
            refused_until_ = now + refusal_lasts;
            refusal_ = words[i];
        }
    }
    refusals_ = counts;
}

std::pair<MMTLink::State, std::string> LinkRun::state() const {
    if (const String wrong = node_->problem(); !wrong.is_empty()) {
        return {MMTLink::STATE_FAILED, from_godot(wrong)};
    }
    if (!way_error_.empty()) {
        return {MMTLink::STATE_FAILED, way_error_};
    }
    if (way_ == nullptr) {
        return {MMTLink::STATE_OPENING, "opening the way to " + ports(node_->network_settings())};
    }
    if (figures_.udp.state == UdpState::failed) {
        return {MMTLink::STATE_FAILED, "the system refuses to send to " + ports(node_->network_settings())};
    }
    const PeerState peer = port_->statistics.front().link.peer;
    if (peer != PeerState::connected && now_ < refused_until_) {
        return {MMTLink::STATE_REFUSED, refusal_};
    }
    return state_of_peer();
}

std::pair<MMTLink::State, std::string> LinkRun::state_of_peer() const {
    const LinkStatistics& link = port_->statistics.front().link;
    const bool in_process = node_->partner_node() != nullptr;
    const std::string there =
        in_process ? from_godot(name_of(*node_->partner_node())) : ports(node_->network_settings());
    switch (link.peer) {
        case PeerState::silent:
            return {
                MMTLink::STATE_WAITING,
                (figures_.udp.state == UdpState::unreachable ? "nobody listens yet at " : "waiting for ") +
                    there};
        case PeerState::one_way:
            return {MMTLink::STATE_ONE_WAY,
                    "the far side is heard and does not hear this one yet; if that lasts, its "
                    "'remote_address' or "
                    "'remote_port' is not this side's"};
        case PeerState::wrong_side:
            return {MMTLink::STATE_REFUSED, "the far side plays the same side: set 'side' of one of the two"};
        case PeerState::vanished:
            return {MMTLink::STATE_LOST, "nothing has been heard for a second from " + there};
        case PeerState::left:
            return {MMTLink::STATE_LEFT, "the far side has ended"};
        case PeerState::connected:
            break;
    }
    if (link.peer_hello.scenario != node_->get_scenario()) {
        return {MMTLink::STATE_REFUSED, "the far side is set to scenario " +
                                            std::to_string(link.peer_hello.scenario) + " and this side to " +
                                            std::to_string(node_->get_scenario()) + ": set both alike"};
    }
    const String trace = node_->trace_problem();
    return {MMTLink::STATE_CONNECTED,
            trace.is_empty() ? std::string("connected") : "connected; " + from_godot(trace)};
}

LinkReport LinkRun::report() const {
    const auto [state, text] = this->state();
    return {state, to_godot(text), port_->statistics.front(), figures_,
            static_cast<std::int64_t>(body_count())};
}

LinkRun::News LinkRun::take_news() {
    News news;
    if (node_ != nullptr) {
        news.node = node_->get_instance_id();
        news.report = report();
        news.objects = std::exchange(object_news_, {});
    }
    return news;
}

void LinkRun::News::deliver() const {
    if (auto* link = Object::cast_to<MMTLink>(ObjectDB::get_instance(node))) {
        link->take_report(report, objects);
    }
}

}  // namespace tactus
