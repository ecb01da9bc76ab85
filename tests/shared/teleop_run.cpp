#include "shared/teleop_run.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <glm/geometric.hpp>
#include <memory>
#include <optional>
#include <utility>

#include "network/link_emulator.hpp"
#include "network/memory_link.hpp"
#include "session/environment_teller.hpp"
#include "session/model_builder.hpp"
#include "session/operator_side.hpp"
#include "session/teleoperator_side.hpp"
#include "shared/teleop_links.hpp"
#include "shared/teleop_place.hpp"
#include "shared/teleop_robot.hpp"

namespace tactus::shared {

namespace {

constexpr Nanoseconds period = 1'000'000;
constexpr double tick_seconds = 1e-3;

// Of what only the model has: an object that is no body of the far side.
constexpr SessionHandle ghosts_from = 40;

OperatorRoom room_for(const TeleopCase& experiment) {
    OperatorRoom room;
    room.max_tracked = 16;
    room.samples = static_cast<std::size_t>(experiment.history / tick_seconds + 0.5);
    room.memento_bytes = 16384;
    room.pointers = 1;
    const bool never = experiment.settings.correction == Correction::none && experiment.events.empty();
    room.replays = !never && !experiment.settings.traditional &&
                   experiment.settings.derivation == Derivation::resimulate;
    return room;
}

class TeleopRun {
public:
    TeleopRun(const TeleopScene& scene, const TeleopCase& experiment);
    TeleopFigures run(TeleopBins* bins);

private:
    EndpointSettings endpoint(Side side, std::uint64_t epoch) const;
    void attach_far_side(std::uint64_t epoch);
    std::unique_ptr<Device> far_hand();
    void describe_all();
    const TeleopBody* body_named(const std::string& name) const;
    SessionHandle object_id(const TeleopBody& body) const;
    void distort(ObjectDescription& description) const;
    void happen(const TeleopEvent& event);
    void tell_anew(const std::string& name);
    void tick_far_side(Nanoseconds now);
    void note_model(std::size_t tick);
    void note_answer();
    std::optional<Pose> modelled(std::size_t moving) const;
    LinkCounts counts() const;
    TeleopFigures figures(TeleopBins* bins);

    const TeleopScene& scene_;
    const TeleopCase& experiment_;
    MemoryLinkPair wire_{4096};
    LinkEmulator emulated_forth_, emulated_back_;
    CutLink at_far_, cut_back_;
    RoughSight at_operator_;
    std::shared_ptr<TeleopPort> operator_port_ = std::make_shared<TeleopPort>();
    std::shared_ptr<TeleopPort> far_port_ = std::make_shared<TeleopPort>();
    RobotTip* tip_ = nullptr;  // the hand of truth_, where a robot is there
    TeleopPlace model_, truth_, direct_, local_;
    std::unique_ptr<TeleopRobot> robot_;
    ModelBuilder builder_;
    EnvironmentTeller teller_;
    TeleopSettings settings_;        // of the operator, as they are now
    std::vector<std::string> told_;  // bodies that are described as they are
    std::vector<TeleopRow> rows_;
    std::vector<std::optional<Pose>> believed_;  // by tick and moving body
    std::uint64_t answered_ = 0;
    Nanoseconds away_until_ = 0;  // the far side starts anew then; 0: it does not
};

TeleopRun::TeleopRun(const TeleopScene& scene, const TeleopCase& experiment)
    : scene_(scene),
      experiment_(experiment),
      emulated_forth_(wire_.second(), experiment.forth, luck_of(experiment.seed, Way::to_teleoperator)),
      emulated_back_(wire_.first(), experiment.back, luck_of(experiment.seed, Way::to_operator)),
      at_far_(emulated_forth_),
      cut_back_(emulated_back_),
      at_operator_(cut_back_, experiment.pose_noise, scattered(experiment.seed)),
      model_(experiment, hand_of(scene, experiment)),
      truth_(experiment, far_hand()),
      direct_(experiment, std::make_unique<FollowingDevice>(model_.device)),
      local_(experiment, hand_of(scene, experiment)),
      builder_(model_.session, operator_port_),
      teller_(far_port_),
      settings_(experiment.settings),
      rows_(static_cast<std::size_t>(experiment.seconds / tick_seconds)) {
    const bool corrects_later =
        experiment.correct_from_touch ||
        std::ranges::count(experiment.events, TeleopEvent::Kind::correct, &TeleopEvent::kind) > 0;
    settings_.correction = corrects_later ? Correction::none : settings_.correction;
    model_.session.attach(std::make_unique<OperatorSide>(teleop_session_settings(), room_for(experiment),
                                                         settings_, at_operator_, operator_port_,
                                                         endpoint(Side::operator_side, 11)));
    attach_far_side(12);
    truth_.fill(scene, experiment, false);
    direct_.fill(scene, experiment, false);
    if (experiment.uses_arm) {
        local_.fill(scene, experiment, false);
    }
    if (experiment.discovers) {
        model_.add_hand(scene);
        builder_.set_distortion([this](ObjectDescription& description) { distort(description); });
        describe_all();
    } else {
        model_.fill(scene, experiment, true);
        for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
            operator_port_->bindings.try_push({static_cast<ObjectId>(i), model_.handles[i]});
        }
    }
    believed_.resize(rows_.size() * truth_.moving.size());
}

EndpointSettings TeleopRun::endpoint(Side side, std::uint64_t epoch) const {
    EndpointSettings one;
    one.side = side;
    one.scenario = scenario_of(experiment_.settings);
    one.epoch = epoch;
    one.period = period;
    return one;
}

// Of the environment: the stand-in puts it where it is to be, or a robot does.
std::unique_ptr<Device> TeleopRun::far_hand() {
    if (!experiment_.robot) {
        return hand_of(scene_, experiment_);
    }
    auto tip = std::make_unique<RobotTip>();
    tip_ = tip.get();
    return tip;
}

void TeleopRun::attach_far_side(std::uint64_t epoch) {
    TeleopSettings settings = experiment_.settings;
    settings.gravity = experiment_.gravity_believed;
    if (experiment_.robot) {
        EmulatedRobotSettings robot;
        robot.believed_mass = experiment_.robot_mass;
        robot.believed_friction = experiment_.robot_friction;
        robot_ = std::make_unique<TeleopRobot>(truth_, *tip_, robot, settings, at_far_, far_port_,
                                               endpoint(Side::teleoperator_side, epoch));
        return;
    }
    truth_.session.attach(std::make_unique<TeleoperatorSide>(
        teleop_session_settings(), settings, at_far_, far_port_, endpoint(Side::teleoperator_side, epoch)));
}

void TeleopRun::describe_all() {
    for (const TeleopBody& body : scene_.bodies) {
        const auto wrong = experiment_.wrong.find(body.name);
        if (wrong == experiment_.wrong.end() || !wrong->second.absent) {
            teller_.tell(object_id(body), body.name, body.addition);
        }
    }
}

const TeleopBody* TeleopRun::body_named(const std::string& name) const {
    const auto found = std::ranges::find(scene_.bodies, name, &TeleopBody::name);
    if (found == scene_.bodies.end()) {
        std::fprintf(stderr, "%s: no body of the scene\n", name.c_str());
        std::exit(1);
    }
    return &*found;
}

SessionHandle TeleopRun::object_id(const TeleopBody& body) const {
    const auto index = static_cast<std::size_t>(&body - scene_.bodies.data());
    const SessionHandle handle = truth_.handles[index];
    return handle == no_handle ? ghosts_from + static_cast<SessionHandle>(index) : handle;
}

void TeleopRun::distort(ObjectDescription& description) const {
    const std::string name = description.name.substr(0, description.name.find('\''));
    if (std::ranges::find(told_, name) != told_.end()) {
        return;
    }
    const TeleopBody& body = *body_named(name);
    const auto index = static_cast<std::size_t>(&body - scene_.bodies.data());
    TeleopBody described = body;
    described.addition.description = description.body;
    const BodyAddition believed = as_believed(described, hinge_of(scene_, index), experiment_);
    description.body = believed.description;
    description.touch = believed.touch_material;
}

void TeleopRun::happen(const TeleopEvent& event) {
    using Kind = TeleopEvent::Kind;
    switch (event.kind) {
        case Kind::told:
            tell_anew(event.body);
            return;
        case Kind::removed:
            teller_.forget(object_id(*body_named(event.body)));
            return;
        case Kind::gravity:
            far_port_->settings.publish(experiment_.settings);
            return;
        case Kind::correct:
            settings_.correction = experiment_.settings.correction;
            break;
        case Kind::scheme:
            settings_.correction = static_cast<Correction>(static_cast<int>(event.amount));
            break;
        case Kind::scenario: {
            settings_.traditional = event.amount == 2.0;
            TeleopSettings there = experiment_.settings;
            there.traditional = settings_.traditional;
            far_port_->settings.publish(there);
            break;
        }
        case Kind::restart:
            away_until_ = from_seconds(event.at + event.amount);
            return;
        case Kind::cut:
            at_far_.cut = at_far_.cut || event.amount != 2.0;
            cut_back_.cut = cut_back_.cut || event.amount != 1.0;
            return;
    }
    operator_port_->settings.publish(settings_);
}

void TeleopRun::tell_anew(const std::string& name) {
    const TeleopBody& body = *body_named(name);
    const SessionHandle object = object_id(body);
    BodyAddition addition = body.addition;
    if (addition.description.motion == Motion::Dynamic) {
        const SessionSnapshot& now = truth_.session.snapshot();
        if (const BodyState* const state = state_of(now.bodies, now.body_count, object)) {
            addition.description.pose = state->pose;
            addition.description.linear_velocity = state->linear_velocity;
            addition.description.angular_velocity = state->angular_velocity;
        }
    }
    told_.push_back(name);
    // What stands is told in the same words as before, and nobody would notice: it gets another name.
    teller_.tell(object, addition.description.motion == Motion::Static ? name + "'" : name, addition);
}

// Where the model has the moving body `moving` of the environment, if it does.
std::optional<Pose> TeleopRun::modelled(std::size_t moving) const {
    if (!experiment_.discovers) {
        return model_.pose_of(model_.moving[moving]);
    }
    const auto object = static_cast<ObjectId>(truth_.moving[moving]);
    const auto found = std::ranges::find(builder_.objects(), object, &ModelObject::object);
    if (found == builder_.objects().end() || found->body == no_handle) {
        return std::nullopt;
    }
    return model_.pose_of(found->body);
}

void TeleopRun::note_model(std::size_t tick) {
    TeleopRow& row = rows_[tick];
    row.time = static_cast<Nanoseconds>(tick) * period;
    row.hand = model_.device.sample.position;
    row.velocity = model_.device.sample.velocity;
    row.force = model_.device.force;
    row.direct = direct_.device.force;
    if (experiment_.uses_arm) {
        row.local_hand = local_.device.sample.position;
        row.local_velocity = local_.device.sample.velocity;
        row.local_force = local_.device.force;
        row.local_depth = local_.depth();
    }
    const std::size_t moving = truth_.moving.size();
    for (std::size_t body = 0; body < moving; ++body) {
        const std::optional<Pose> pose = modelled(body);
        believed_[tick * moving + body] = pose;
        if (truth_.moving[body] == truth_.object) {
            row.model = pose.value_or(Pose{});
        }
    }
    row.touches = model_.touches(model_.object);
    row.direct_touches = direct_.pointer().contact_count > 0;
    for (const SessionHandle body : direct_.handles) {
        row.direct_bodies.push_back(direct_.touches(body));
    }
    const TeleopStatistics& statistics = operator_port_->statistics.front();
    row.let_go = (model_.pointer().status & felt_letting_go) != 0;
    row.jnd_share = statistics.cost.jnd_share;
    row.force_step = statistics.cost.force_step;
    row.offset = statistics.offset;
    row.there_hand = truth_.pointer().hand;
    row.there_force = truth_.device.force;
    row.link = counts();
}

LinkCounts TeleopRun::counts() const {
    const TeleopStatistics& ours = operator_port_->statistics.front();
    const TeleopStatistics& theirs = far_port_->statistics.front();
    return {.packets_forth = ours.link.packets_sent,
            .packets_back = theirs.link.packets_sent,
            .bytes_forth = ours.link.bytes_sent,
            .bytes_back = theirs.link.bytes_sent,
            .corrections = ours.corrections,
            .replays = ours.replays,
            .states_beyond_history = ours.beyond_history,
            .samples_held = theirs.buffer.held,
            .samples_filled = theirs.buffer.filled,
            .round_trip = ours.round_trip};
}

// The far side has applied a sample: what became of it belongs to that sample's row.
void TeleopRun::note_answer() {
    const std::uint64_t sample = far_port_->statistics.front().sample;
    if (sample == 0 || sample > rows_.size() || sample == answered_) {
        return;
    }
    answered_ = sample;
    TeleopRow& answered = rows_[sample - 1];
    if (answered.far_known) {
        return;
    }
    answered.far_known = true;
    answered.truth = truth_.pose_of(truth_.object);
    answered.far = truth_.device.force;
    answered.depth = truth_.depth();
    answered.hand_error = glm::distance(answered.hand, truth_.pointer().hand);
    const std::size_t moving = truth_.moving.size();
    for (std::size_t body = 0; body < moving; ++body) {
        const std::optional<Pose>& ours = believed_[(sample - 1) * moving + body];
        const Pose theirs = truth_.pose_of(truth_.moving[body]);
        if (ours) {
            answered.box_error = std::max(answered.box_error, position_error(*ours, theirs));
            answered.turn_error = std::max(answered.turn_error, rotation_error(*ours, theirs));
        }
    }
}

void TeleopRun::tick_far_side(Nanoseconds now) {
    if (now <= std::max(experiment_.late, away_until_)) {
        drop_all(at_far_, now);
        return;
    }
    if (std::exchange(away_until_, 0) != 0) {
        attach_far_side(13);
        teller_ = EnvironmentTeller(far_port_);
        describe_all();
    }
    if (robot_) {
        robot_->tick(now + experiment_.phase);
    } else {
        truth_.tick(now + experiment_.phase);
    }
}

TeleopFigures TeleopRun::run(TeleopBins* bins) {
    bool waiting_for_touch = experiment_.correct_from_touch;
    std::vector<TeleopEvent> events = experiment_.events;
    std::ranges::sort(events, {}, &TeleopEvent::at);
    std::size_t next_event = 0;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        const Nanoseconds now = static_cast<Nanoseconds>(i + 1) * period;
        while (next_event < events.size() && to_seconds(now) >= events[next_event].at) {
            happen(events[next_event++]);
        }
        const double began = static_cast<double>(i) * tick_seconds;
        model_.tick(now);
        direct_.act(scene_, experiment_, began);
        direct_.tick(now);
        truth_.act(scene_, experiment_, began);
        if (experiment_.uses_arm) {
            local_.act(scene_, experiment_, began);
            local_.tick(now);
        }
        tick_far_side(now);
        operator_port_->statistics.refresh();
        far_port_->statistics.refresh();
        if (experiment_.discovers) {
            model_.session.collect();
            truth_.session.collect();
            teller_.update(truth_.session.snapshot(), far_port_->statistics.front().link.peer_epoch);
            builder_.update(now, operator_port_->statistics.front().link);
        }
        note_model(i);
        note_answer();
        if (waiting_for_touch && model_.pointer().contact_count + truth_.pointer().contact_count > 0) {
            waiting_for_touch = false;
            operator_port_->settings.publish(experiment_.settings);
        }
    }
    for (std::size_t i = 1; i < rows_.size(); ++i) {
        rows_[i].depth = rows_[i].far_known ? rows_[i].depth : rows_[i - 1].depth;  // a sample was left out
    }
    return figures(bins);
}

TeleopFigures TeleopRun::figures(TeleopBins* bins) {
    std::vector<std::string> bodies;
    std::ranges::transform(scene_.bodies, std::back_inserter(bodies), &TeleopBody::name);
    const TeleopFigures figures = evaluate(rows_, experiment_, bodies, bins);
    if (!experiment_.rows.empty()) {
        if (!write_rows(experiment_.rows, bodies, rows_)) {
            std::fprintf(stderr, "%s could not be written: is the disk full?\n", experiment_.rows.c_str());
            std::exit(EXIT_FAILURE);
        }
    }
    return figures;
}

}  // namespace

TeleopFigures run_teleop(const TeleopScene& scene, const TeleopCase& experiment, TeleopBins* bins) {
    return TeleopRun(scene, experiment).run(bins);
}

}  // namespace tactus::shared
