#include "world/world_link.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <unordered_set>

#include "network/key_source.hpp"

namespace tactus {

namespace {

// A way that could not be opened is tried again so much later: the port may have become free.
constexpr Nanoseconds try_again_after = 2'000'000'000;

// So long what is not believed counts as the state of the link.
constexpr Nanoseconds refusal_lasts = 1'000'000'000;

// A body whose values change in every frame is not described in every frame.
constexpr Nanoseconds tell_again_after = 250'000'000;

// Bodies whose names are asked for in a frame.
constexpr std::size_t names_at_once = 16;

std::string ports(const NetworkSettings& settings) {
    return settings.udp.remote_address + ":" + std::to_string(settings.udp.remote_port) +
           " (this side listens on port " + std::to_string(settings.udp.local_port) + ")";
}

}  // namespace

UdpSettings with_usual_ports(UdpSettings udp, bool is_operator) {
    constexpr std::uint16_t of_operator = 47001;
    constexpr std::uint16_t of_far_side = 47002;
    udp.local_port = udp.local_port > 0 ? udp.local_port : is_operator ? of_operator : of_far_side;
    udp.remote_port = udp.remote_port > 0 ? udp.remote_port : is_operator ? of_far_side : of_operator;
    return udp;
}

std::string problem_of_addresses(const UdpSettings& udp) {
    if (udp.remote_address.empty()) {
        return "the other side has no address: set 'remote_address'";
    }
    const bool loops =
        udp.remote_address == "127.0.0.1" || udp.remote_address == "localhost" || udp.remote_address == "::1";
    return loops && udp.local_port == udp.remote_port
               ? "it would talk to itself: on one machine the two sides need different ports"
               : std::string();
}

WorldLink::WorldLink(const LinkPlan& plan, Session& session, const Vec3& gravity, const Pose& frame,
                     const std::atomic<Nanoseconds>* ahead)
    : plan_(plan), ahead_(ahead), gravity_(gravity), frame_(frame) {
    if (is_operator()) {
        builder_ = std::make_unique<ModelBuilder>(session, port_);
        builder_->set_frame(frame_);
    } else {
        teller_ = std::make_unique<EnvironmentTeller>(port_);
        teller_->set_frame(frame_);
    }
}

WorldLink::~WorldLink() = default;

void WorldLink::end() {
    is_planned_ = false;
    route_.put(nullptr);
    route_.take();
    opening_.reset();
    past_way_.reset();
    way_.reset();
}

void WorldLink::attach(Session& session, const std::vector<WorldLink*>& links) {
    std::vector<LinkEnd> ends;
    for (WorldLink* const link : links) {
        ends.push_back(link->end_of(session.settings(), PointerShare{ends.size(), links.size()}));
    }
    if (!ends.empty()) {
        session.attach(ends);
    }
}

LinkEnd WorldLink::end_of(const SessionSettings& session, const PointerShare& share) {
    EndpointSettings endpoint;
    endpoint.side = is_operator() ? Side::operator_side : Side::teleoperator_side;
    endpoint.scenario = plan_.scenario;
    endpoint.epoch = random_epoch();
    endpoint.period = session.period;
    settings_ = plan_.teleop;
    settings_.gravity = gravity_;
    settings_.frame = frame_;
    const SidePlan::Kind kind = is_operator()     ? SidePlan::Kind::operator_side
                                : settings_.robot ? SidePlan::Kind::robot
                                                  : SidePlan::Kind::environment;
    OperatorRoom room;
    room.samples =
        static_cast<std::size_t>(std::max(1.0, std::ceil(plan_.history / to_seconds(session.period))));
    return {{kind, settings_, endpoint, room, share}, &route_, port_};
}

// --- the way
// ---------------------------------------------------------------------------------------------------------

void WorldLink::let_go_of_way() {
    route_.put(nullptr);
    opening_.reset();
    if (way_ != nullptr) {
        past_way_ = std::move(way_);
    }
    way_error_.clear();
    figures_ = {};
}

void WorldLink::put(std::unique_ptr<LinkWay> way) {
    way_ = std::move(way);
    route_.put(way_.get());
}

// The loop may look at it as long as the run lasts.
void WorldLink::keep_trace() {
    if (traces_.empty() || traces_.back() != plan_.trace) {
        traces_.push_back(plan_.trace);
    }
}

WorldLink::WayPlan WorldLink::way_of(const LinkPlan& plan) {
    const UdpSettings& udp = plan.network.udp;
    return {udp.local_address, udp.remote_address, plan.key_file, udp.local_port,
            udp.remote_port,   plan.network.seed,  plan.wire};
}

// A way is opened anew only when the loop has let go of the one before: both may want the same port.
void WorldLink::look_after_way(Workers& workers, const LinkMoment& moment) {
    if (const std::optional<WayPlan> way = way_of(plan_); is_planned_ && way != way_planned_) {
        way_planned_ = way;
        let_go_of_way();
        next_try_ = moment.now;
    }
    if (!is_planned_ || !plan_.problem.empty()) {
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

void WorldLink::open(Workers& workers, const LinkMoment& moment) {
    NetworkSettings settings = plan_.network;
    keep_trace();
    if (plan_.wire != nullptr) {
        put(std::make_unique<InProcessWay>(plan_.wire, is_operator(), settings.conditions, settings.seed));
        return;
    }
    KeySource key = read_key(plan_.key_file);
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

void WorldLink::take_opened(const LinkMoment& moment) {
    if (!opening_->done.load(std::memory_order_acquire)) {
        return;
    }
    const std::shared_ptr<Opening> opened = std::move(opening_);
    opening_.reset();
    way_error_ = opened->error;
    if (way_error_.empty()) {
        put(std::move(opened->way));
        way_->change(plan_.network.conditions);
    } else {
        next_try_ = moment.now + try_again_after;
    }
}

// --- what has changed
// ------------------------------------------------------------------------------------------------

void WorldLink::pass_on_settings(const Vec3& gravity) {
    if (!is_planned_ || (plan_.revision == revision_ && gravity == gravity_)) {
        return;
    }
    revision_ = plan_.revision;
    gravity_ = gravity;
    settings_ = plan_.teleop;
    settings_.gravity = gravity_;
    settings_.frame = frame_;
    port_->settings.publish(settings_);
    if (way_ != nullptr) {
        keep_trace();
        way_->change(plan_.network.conditions);
    }
}

void WorldLink::leave() {
    settings_.leaving = true;
    port_->settings.publish(settings_);
}

bool WorldLink::synchronise(const std::optional<LinkPlan>& plan, const Vec3& gravity, Workers& workers,
                            const LinkMoment& moment) {
    now_ = moment.now;
    is_planned_ = plan.has_value();
    if (plan) {
        plan_ = *plan;
    }
    look_after_way(workers, moment);
    pass_on_settings(gravity);
    port_->statistics.refresh();
    if (way_ != nullptr) {
        figures_ = way_->figures();
    }
    note_refusals(moment.now);
    if (builder_ == nullptr) {
        return false;
    }
    if (!builds_elsewhere_ && !moment.waits) {
        builds_elsewhere_ = true;
        builder_->set_run([&workers](std::function<void()> job) { workers.add(std::move(job)); });
    }
    return builder_->update(moment.now, port_->statistics.front().link);
}

void WorldLink::tell(const std::vector<Told>& bodies, const Describe& describe, const Name& name,
                     const std::vector<ToldJoint>& joints, const SessionSnapshot& snapshot, Nanoseconds now) {
    tell_bodies(bodies, describe, name, now);
    tell_joints(joints);
    teller_->update(snapshot, port_->statistics.front().link.peer_epoch);
}

void WorldLink::tell_joints(const std::vector<ToldJoint>& joints) {
    std::unordered_set<SessionHandle> there;
    for (const ToldJoint& joint : joints) {
        there.insert(joint.joint);
        const std::pair<std::uint64_t, std::uint64_t> now{joint.source, joint.revision};
        const auto [told, is_new] = told_joints_.try_emplace(joint.joint);
        if (is_new || told->second != now) {
            told->second = now;
            teller_->tell_joint(joint.joint, *joint.description, joint.first, joint.second);
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

// Of `of` bodies, names_at_once are asked for in a frame.
bool WorldLink::has_other_name(const Telling& telling, std::size_t index, std::size_t of,
                               const Name& name) const {
    const std::size_t from = names_from_ % of;
    return (index + of - from) % of < names_at_once && name(index) != telling.name;
}

void WorldLink::tell_bodies(const std::vector<Told>& bodies, const Describe& describe, const Name& name,
                            Nanoseconds now) {
    std::unordered_set<SessionHandle> there;
    std::vector<std::pair<const Told*, Description>> due;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        const Told& told = bodies[i];
        there.insert(told.body);
        const auto before = tellings_.find(told.body);
        if (before == tellings_.end() ||
            (before->second.revision != told.revision && now - before->second.at >= tell_again_after) ||
            has_other_name(before->second, i, bodies.size(), name)) {
            due.emplace_back(&told, describe(i));
        }
    }
    // What others rest on comes first.
    std::ranges::stable_partition(
        due, [](const auto& one) { return one.second.addition.description.motion != Motion::Dynamic; });
    for (const auto& [told, description] : due) {
        tellings_[told->body] = {told->revision, now, description.name,
                                 teller_->tell(told->body, description.name, description.addition)};
    }
    names_from_ = bodies.empty() ? 0 : (names_from_ + names_at_once) % bodies.size();
    std::erase_if(tellings_, [&](const auto& telling) {
        const bool gone = !there.contains(telling.first);
        if (gone) {
            teller_->forget(telling.first);
        }
        return gone;
    });
}

std::vector<std::string> WorldLink::problems() const {
    std::vector<std::string> all;
    for (const auto& [handle, telling] : tellings_) {
        if (!telling.problem.empty()) {
            all.push_back(telling.problem);
        }
    }
    if (builder_ != nullptr) {
        std::ranges::move(builder_->joints().problems(), std::back_inserter(all));
        for (const ModelObject& object : builder_->objects()) {
            if (!object.problem.empty()) {
                all.push_back("\"" + object.name + "\" of the other side: " + object.problem);
            }
        }
    }
    return all;
}

// --- in words
// --------------------------------------------------------------------------------------------------------

// Which of the counters for what is not believed have grown.
void WorldLink::note_refusals(Nanoseconds now) {
    const LinkStatistics& link = port_->statistics.front().link;
    const bool unmet = figures_.udp.sealed && !figures_.udp.met;
    const std::array<std::uint64_t, 5> counts = {
        unmet ? figures_.udp.secure.wrong_key : 0, unmet ? figures_.udp.secure.not_sealed : 0,
        link.refused.of(Refusal::sealed), link.refused.of(Refusal::wrong_version), figures_.udp.refused};
    constexpr const char* refusal_words[] = {
        "the other side has another key: give both sides the same",
        "the other side has no key: give both sides the same, or none",
        "the other side has a key and this side has none: give both sides the same",
        "the other side speaks another version of the protocol: install the same version of Tactus on both "
        "sides",
        "the other side expects another peer at that port: set its 'remote_address' and 'remote_port' to "
        "this "
        "side's, or give this operator an MMTLink of its own there",
    };
    for (std::size_t i = 0; i < counts.size(); ++i) {
        if (counts[i] > refusals_[i]) {
            refused_until_ = now + refusal_lasts;
            refusal_ = refusal_words[i];
        }
    }
    refusals_ = counts;
}

WorldLink::Standing WorldLink::standing() const {
    if (!plan_.problem.empty()) {
        return {LinkState::failed, plan_.problem};
    }
    if (!way_error_.empty()) {
        return {LinkState::failed, way_error_};
    }
    if (way_ == nullptr) {
        return {LinkState::opening, "opening the way to " + ports(plan_.network)};
    }
    if (figures_.udp.state == UdpState::failed) {
        return {LinkState::failed, "the system refuses to send to " + ports(plan_.network)};
    }
    const PeerState peer = port_->statistics.front().link.peer;
    if (peer != PeerState::connected && now_ < refused_until_) {
        return {LinkState::refused, refusal_};
    }
    return standing_of_peer();
}

WorldLink::Standing WorldLink::standing_of_peer() const {
    const LinkStatistics& link = port_->statistics.front().link;
    const std::string there = plan_.wire != nullptr ? plan_.partner : ports(plan_.network);
    switch (link.peer) {
        case PeerState::silent:
            return {LinkState::waiting,
                    (figures_.udp.state == UdpState::unreachable ? "no program listens yet at "
                                                                 : "waiting for ") +
                        there};
        case PeerState::one_way:
            return {LinkState::one_way,
                    "the other side is heard and does not hear this one yet; if that lasts, its "
                    "'remote_address' or "
                    "'remote_port' is not this side's"};
        case PeerState::wrong_side:
            return {LinkState::refused, "the other side plays the same side: set 'side' of one of the two"};
        case PeerState::vanished:
            return {LinkState::lost, "nothing has been heard for a second from " + there};
        case PeerState::left:
            return {LinkState::left, "the other side has ended"};
        case PeerState::connected:
            break;
    }
    const TeleopStatistics& teleop = port_->statistics.front();
    const std::string differs = explain(teleop.disagreement, teleop.own_terms, teleop.peer_terms,
                                        is_operator() ? Side::operator_side : Side::teleoperator_side);
    if (teleop.disagreement.whole && !differs.empty()) {
        return {LinkState::refused, differs};
    }
    std::string text = "connected";
    for (const std::string& besides :
         {differs, unfinished_model(), short_history(), narrow_states(), plan_.trace_problem}) {
        text += besides.empty() ? "" : "; " + besides;
    }
    return {LinkState::connected, text};
}

bool WorldLink::is_described() const {
    return port_->statistics.front().description == FirstDescription::whole;
}

// No hand touches a model that lacks what is there.
std::string WorldLink::unfinished_model() const {
    const TeleopStatistics& teleop = port_->statistics.front();
    if (is_operator()) {
        return teleop.description == FirstDescription::begun && !plan_.teleop.traditional
                   ? "the teleoperator describes its bodies: pointers and tools touch nothing until the "
                     "model has all of them"
                   : "";
    }
    const std::uint32_t missing = plan_.teleop.traditional ? 0 : teleop.discovery.unanswered;
    return missing == 0
               ? ""
               : "the operator's model has " + std::to_string(missing) +
                     " bodies less than this world: pointers and tools touch nothing until it has them";
}

// States that are older than the model's history are brought to the present by their velocity alone.
std::string WorldLink::short_history() const {
    const TeleopStatistics& teleop = port_->statistics.front();
    if (!is_operator() || teleop.beyond_history == 0 || teleop.round_trip <= plan_.history) {
        return "";
    }
    char text[240];
    std::snprintf(
        text, sizeof(text),
        "the teleoperator answers after %.2f s, and the model's history is %.2f s: moving bodies are "
        "corrected by velocity, and only while they are not pressed; set 'history' to %.1f s",
        teleop.round_trip, plan_.history, std::ceil(10.0 * teleop.round_trip + 1.0) / 10.0);
    return text;
}

// More is due of its bodies than the bandwidth that the user gives them.
std::string WorldLink::narrow_states() const {
    const StateLoad& load = port_->statistics.front().load;
    const double rate = plan_.teleop.body_rate;
    if (is_operator() || rate <= 0.0 || load.wanted <= rate) {
        return "";
    }
    char text[200];
    std::snprintf(
        text, sizeof(text),
        "the states of its bodies would take %.1f Mbit/s, and 'body_bandwidth' is %.1f: what is far "
        "from a hand is sent up to %.2f s late",
        1e-6 * load.wanted, 1e-6 * rate, load.oldest);
    return text;
}

LinkReport WorldLink::report() const {
    Standing now = standing();
    return {now.state, std::move(now.text), port_->statistics.front(), figures_,
            static_cast<std::int64_t>(body_count())};
}

}  // namespace tactus
