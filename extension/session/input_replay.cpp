#include "session/input_replay.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "core/geometry/touch_shape.hpp"
#include "core/math/bit_hash.hpp"
#include "core/mesh/mesh_check.hpp"
#include "core/soft/soft_model.hpp"
#include "core/tree/triangle_tree.hpp"
#include "session/request_checks.hpp"

namespace tactus {

class InputReplay::PlayedDevice final : public Device {
public:
    DeviceSample read(Nanoseconds) override { return sample; }
    void write(Nanoseconds, const Vec3&) override {}
    DeviceCapabilities capabilities() const override { return able; }

    DeviceSample sample;
    DeviceCapabilities able;
};

class InputReplay::PlayedLink final : public Link {
public:
    bool send(std::span<const std::byte>, Nanoseconds) override {
        return std::ranges::find(not_sent, sent_++) == not_sent.end();
    }
    ReceivedDatagram receive(std::span<std::byte> into, Nanoseconds) override {
        if (next_ == arrivals.size() || arrivals[next_].datagram.size() > into.size()) {
            return {};
        }
        const heard::Arrival& arrival = arrivals[next_++];
        std::ranges::copy(arrival.datagram, into.begin());
        return {arrival.datagram.size(), arrival.arrived};
    }
    std::size_t overhead() const override { return bytes; }

    void end_tick() {
        arrivals.clear();
        not_sent.clear();
        next_ = 0;
        sent_ = 0;
    }

    // Of this tick.
    std::vector<heard::Arrival> arrivals;
    std::vector<std::uint32_t> not_sent;
    std::size_t bytes = Link::overhead();

private:
    std::size_t next_ = 0;
    std::uint32_t sent_ = 0;
};

struct InputReplay::End {
    PlayedLink link;
    std::shared_ptr<TeleopPort> port = std::make_shared<TeleopPort>();
    std::deque<PreparedDiscovery> announced;  // by the owner, not taken yet
};

namespace {

// What a session takes memory by, and what it counts by. Beyond these no scene goes.
bool is_sound(const SessionSettings& s) {
    const PhysicsSettings& p = s.physics;
    constexpr std::uint32_t most = 1u << 16;
    return s.period > 0 && s.max_bodies >= 1 && s.max_bodies <= most && s.max_parts <= 16 * most &&
           p.max_touching_pairs <= 16 * most && p.max_contacts <= 16 * most && p.sub_steps >= 1 &&
           p.sub_steps <= 16 && p.velocity_iterations >= 2 && p.velocity_iterations <= 255 &&
           p.position_iterations >= 1 && p.position_iterations <= 255 && p.max_joints >= 1 &&
           p.max_joints <= most / 2 && p.remembered_wakings <= 16 * most;
}

bool is_sound(const TeleopSettings& s) {
    return s.buffer_depth <= 200 && s.states_every >= 1 && s.refresh_every >= 1 && s.repeats >= 1 &&
           s.repeats <= 16 && s.replay_steps >= 1 && s.replay_steps <= 1024;
}

// Of a clock, far from where differences overflow.
bool is_time(Nanoseconds time) {
    constexpr Nanoseconds most = 1'000'000'000'000'000'000;  // 31 years
    return time >= -most && time <= most;
}

bool is_sound(const EndpointSettings& s) {
    constexpr double most_drift = 1e-3;
    return s.period > 0 && is_time(s.period) && is_time(s.hello_every) && is_time(s.clock_every) &&
           is_time(s.vanish_after) && is_time(s.skew.origin) && is_time(s.skew.offset) &&
           std::abs(s.skew.drift) <= most_drift;
}

// Of a session with so many bodies: what the past takes at once.
bool is_sound(const OperatorRoom& room, std::size_t bodies) {
    constexpr std::size_t most = 1u << 20;
    constexpr std::size_t body_bytes = 256;  // of what is kept of one in a memento
    const std::size_t mementos = room.samples / std::max<std::size_t>(1, room.samples_a_memento) + 1;
    return room.max_tracked <= most && room.samples >= 1 && room.samples <= most &&
           room.max_tracked * room.samples <= 4 * most && room.samples_a_memento >= 1 &&
           room.memento_bytes <= 64 * most &&
           mementos * (room.memento_bytes + bodies * body_bytes) <= 1024 * most &&
           room.pointers <= max_proxies;
}

bool is_sound(const SidePlan& plan, std::size_t bodies) {
    return is_sound(plan.settings) && is_sound(plan.endpoint) && plan.share.every >= 1 &&
           plan.share.first < max_proxies && is_sound(plan.room, bodies);
}

bool is_there(const PlacedShape& placed) {
    if (const auto* const mesh = std::get_if<MeshShape>(&placed.shape)) {
        return mesh->mesh != nullptr;
    }
    if (const auto* const hull = std::get_if<ConvexHullShape>(&placed.shape)) {
        return hull->hull != nullptr;
    }
    const auto* const field = std::get_if<HeightFieldShape>(&placed.shape);
    return field == nullptr || field->heights != nullptr;
}

bool has_same_triangles(const TriangleMesh& a, const TriangleMesh& b) {
    return a.vertices.size() == b.vertices.size() && a.triangles == b.triangles;
}

}  // namespace

std::string InputReplay::Report::outcome_text() const {
    std::array<char, 16> digits{};
    constexpr int hexadecimal = 16;
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), outcome, hexadecimal).ptr;
    return {digits.data(), end};
}

InputReplay::InputReplay(std::FILE* file, TakeRow take_row) : file_(file), take_row_(std::move(take_row)) {
    if (file_.next() && file_.kind() == InputPiece::settings) {
        take_settings();
    } else {
        give_up(file_.problem().empty() ? "it does not begin with its settings" : file_.problem());
    }
}

InputReplay::~InputReplay() = default;

void InputReplay::give_up(const std::string& why) {
    if (!is_over_) {
        is_over_ = true;
        report_.problem = why;
    }
}

void InputReplay::check(bool sound) {
    if (!sound) {
        give_up("what it says after tick " + std::to_string(report_.ticks) + " makes no sense");
    }
}

void InputReplay::take_settings() {
    ValueReader reader(file_.content());
    SessionSettings settings;
    pass(reader, settings);
    check(reader.good() && is_sound(settings));
    if (!is_over_) {
        session_ = std::make_unique<Session>(settings);
    }
}

void InputReplay::take_calls() {
    ValueReader reader(file_.content());
    while (!is_over_ && reader.remaining() > 0) {
        InputCall call;
        pass(reader, call);
        check(reader.good());
        if (!is_over_) {
            std::visit([this](const auto& c) { carry_out(c); }, call);
        }
    }
}

bool InputReplay::next(HeardInput& input) {
    while (!is_over_ && ticks_.remaining() == 0) {
        if (!file_.next()) {
            give_up(file_.problem());
        } else if (file_.kind() == InputPiece::ticks) {
            ticks_ = ValueReader(file_.content());
        } else if (file_.kind() == InputPiece::calls) {
            take_calls();
        } else if (file_.kind() == InputPiece::end) {
            ValueReader reader(file_.content());
            pass(reader, report_.lost);
            give_up(report_.lost == 0
                        ? std::string()
                        : "its last " + std::to_string(report_.lost) +
                              " ticks were not recorded, because the program stood still for too long");
        } else {
            check(false);
        }
    }
    if (!is_over_) {
        pass(ticks_, input);
        check(ticks_.good());
    }
    return !is_over_;
}

bool InputReplay::play_tick() {
    has_ticked_ = false;
    HeardInput input;
    while (!has_ticked_ && next(input)) {
        std::visit([this](const auto& h) { hear(h); }, input);
    }
    return has_ticked_;
}

bool InputReplay::play(std::uint64_t ticks) {
    for (std::uint64_t i = 0; i < ticks; ++i) {
        if (!play_tick()) {
            return false;
        }
    }
    return true;
}

// --- what the owner has asked

// One that has been there before is refitted, as it was then.
void InputReplay::take_tree(std::uint64_t lineage, const PlacedShape& placed, TouchPart& part) {
    const auto* const shape = std::get_if<MeshShape>(&placed.shape);
    if (lineage == 0 || shape == nullptr) {
        return;
    }
    Lineage& before = lineages_[lineage];
    if (before.tree != nullptr) {
        check(has_same_triangles(*before.mesh, *shape->mesh));
        if (is_over_) {
            return;
        }
        part.surface = std::make_shared<const TriangleTree>(before.tree->refitted(*shape->mesh));
    }
    before = {shape->mesh, std::get<std::shared_ptr<const TriangleTree>>(part.surface)};
}

// Null where there is none, or it makes no sense.
std::shared_ptr<const TouchShape> InputReplay::touched(const call::Form& form) {
    const std::vector<PlacedShape>& shapes = form.touched();
    check(std::ranges::all_of(shapes, is_there) && form.lineages.size() == shapes.size());
    if (is_over_) {
        return nullptr;
    }
    const TouchShapeResult made = make_touch_shape(shapes);
    check(made.shape != nullptr);
    if (is_over_) {
        return nullptr;
    }
    auto touch = std::make_shared<TouchShape>(*made.shape);
    for (std::size_t i = 0; i < shapes.size(); ++i) {
        take_tree(form.lineages[i], shapes[i], touch->parts[i]);
    }
    return touch;
}

ReadyBody InputReplay::prepared(const call::Form& form) {
    check(std::ranges::all_of(form.description.shapes, is_there));
    if (is_over_) {
        return {};
    }
    BodyAddition addition;
    if (form.soft != nullptr) {
        addition.soft = make_soft(*form.soft).model;
        check(addition.soft != nullptr);
    } else {
        addition.touch = touched(form);
    }
    if (is_over_) {
        return {};
    }
    addition.description = form.description;
    addition.touch_shapes = form.touch_shapes;
    addition.touch_material = form.touch_material;
    addition.detail = form.detail;
    addition.only_touched = form.only_touched;
    return Session::prepare_body(addition);
}

void InputReplay::carry_out(const call::AddBody& c) {
    ReadyBody body = prepared(c.form);
    if (!is_over_) {
        forms_[c.handle] = body.soft ? nullptr : body.touch;
        session_->use_handle(c.handle);
        check(session_->add_body(std::move(body), c.former).handle == c.handle);
    }
}

void InputReplay::carry_out(const call::DeformBody& c) {
    ReadyBody body = prepared(c.form);
    std::shared_ptr<const TouchShape>& form = forms_[c.handle];
    if (form && body.touch && form->parts.size() == body.touch->parts.size()) {
        form = body.touch;
    }
    check(!is_over_ && session_->deform_body(c.handle, std::move(body)).empty());
}

// What is made does not depend on who made it.
void InputReplay::carry_out(const call::NarrowTouch& c) {
    check(is_proxy_radius(c.radius));
    const auto known = forms_.find(c.handle);
    if (!is_over_ && known != forms_.end() && known->second) {
        session_->narrow_touch(c.handle, narrowed(*known->second, c.radius), c.radius);
    }
}

void InputReplay::carry_out(const command::RemoveBody& c) {
    forms_.erase(c.handle);
    session_->remove_body(c.handle);
}

void InputReplay::carry_out(const call::AddDevice& c) {
    check(c.handle < max_devices);
    if (is_over_) {
        return;
    }
    if (devices_[c.handle] == nullptr) {
        devices_[c.handle] = std::make_unique<PlayedDevice>();
    }
    session_->use_handle(c.handle);
    check(session_->add_device(*devices_[c.handle], c.workspace).handle == c.handle);
}

void InputReplay::carry_out(const call::AddProxy& c) {
    session_->use_handle(c.handle);
    check(session_->add_proxy(c.description).handle == c.handle);
}

void InputReplay::carry_out(const call::AddTool& c) {
    check(c.shape != nullptr && !c.shape->spheres.empty() &&
          (c.shape->mesh == nullptr || check_mesh(*c.shape->mesh).empty()));
    if (!is_over_) {
        session_->use_handle(c.handle);
        check(session_->add_tool(c.shape, c.use).handle == c.handle);
    }
}

void InputReplay::carry_out(const call::Record& c) {
    constexpr std::uint32_t most = 1u << 16;  // one after the other
    check(c.ring < most);
    if (is_over_) {
        return;
    }
    rings_.resize(std::max<std::size_t>(rings_.size(), c.ring + 1));
    if (rings_[c.ring] == nullptr) {
        rings_[c.ring] = std::make_unique<RecorderRing<SessionRecord>>(2);
    }
    session_->record(*rings_[c.ring], c.proxy, c.object);
}

void InputReplay::carry_out(const call::EndRecording& c) {
    check(c.ring < rings_.size() && rings_[c.ring] != nullptr);
    if (!is_over_) {
        session_->end_recording(*rings_[c.ring]);
    }
}

void InputReplay::carry_out(const call::Attach& c) {
    const std::size_t bodies = session_->settings().max_bodies;
    check(ends_.empty() && session_->is_empty() && c.sides.size() <= max_proxies &&
          std::ranges::all_of(c.sides, [&](const SidePlan& plan) { return is_sound(plan, bodies); }));
    if (is_over_) {
        return;
    }
    std::vector<LinkEnd> ends;
    for (const SidePlan& plan : c.sides) {
        End& end = *ends_.emplace_back(std::make_unique<End>());
        ends.push_back({plan, &end.link, end.port});
    }
    session_->attach(ends);
}

void InputReplay::carry_out(const call::Announce& c) {
    if (End* const end = end_of(c.link); end != nullptr && c.discovery) {
        end->announced.push_back(c.discovery);
    }
}

void InputReplay::carry_out(const call::Epoch& c) {
    epoch_ = c.epoch;
}
void InputReplay::carry_out(const call::WriteRows& c) {
    rows_ = rows_.value_or(Rows{.ring = c.ring});
}
void InputReplay::carry_out(const call::RowsWritten& c) {
    if (rows_ && rows_->ring == c.ring) {
        rows_->most = std::min(rows_->most, c.rows);
    }
}

void InputReplay::carry_out(const command::AddJoint& c) {
    session_->use_handle(c.handle);
    check(session_->add_joint(c.joint, c.first, c.second).handle == c.handle);
}

// --- what the loop has heard

InputReplay::End* InputReplay::end_of(std::uint32_t link) {
    check(link < ends_.size());
    return is_over_ ? nullptr : ends_[link].get();
}

void InputReplay::hear(const heard::Tick& h) {
    check(is_time(h.now));
    if (!is_over_) {
        tick_ = h;
    }
}

void InputReplay::hear(const heard::Settle& h) {
    session_->take_exactly(h.commands);
    session_->settle();
}

void InputReplay::hear(const heard::Rest&) {
    session_->rest();
}

void InputReplay::hear(const heard::Reading& h) {
    check(h.device < max_devices && devices_[h.device] != nullptr);
    if (!is_over_) {
        devices_[h.device]->sample = h.sample;
    }
}

void InputReplay::hear(const heard::Abilities& h) {
    check(h.device < max_devices && devices_[h.device] != nullptr);
    if (!is_over_) {
        devices_[h.device]->able = h.capabilities;
    }
}

void InputReplay::hear(const heard::Arrival& h) {
    check(is_time(h.arrived));
    if (End* const end = is_over_ ? nullptr : end_of(h.link)) {
        end->link.arrivals.push_back(h);
    }
}

void InputReplay::hear(const heard::NotSent& h) {
    if (End* const end = end_of(h.link)) {
        end->link.not_sent.push_back(h.number);
    }
}

void InputReplay::hear(const heard::Overhead& h) {
    if (End* const end = end_of(h.link)) {
        end->link.bytes = h.bytes;
    }
}

void InputReplay::hear(const heard::Settings& h) {
    check(is_sound(h.settings));
    if (End* const end = end_of(h.link)) {
        end->port->settings.publish(h.settings);
    }
}

void InputReplay::hear(const heard::Binding& h) {
    if (End* const end = end_of(h.link)) {
        end->port->bindings.try_push(h.binding);
    }
}

void InputReplay::hear(const heard::Announced& h) {
    End* const end = end_of(h.link);
    check(end != nullptr && !end->announced.empty());
    if (!is_over_) {
        end->port->announced.try_push(std::move(end->announced.front()));
        end->announced.pop_front();
    }
}

void InputReplay::hear(const heard::Withdrawn& h) {
    if (End* const end = end_of(h.link)) {
        end->port->withdrawn.try_push(h.object);
    }
}

void InputReplay::hear(const heard::Acknowledged& h) {
    if (End* const end = end_of(h.link)) {
        end->port->discovery.acknowledge(h.acknowledgement);
    }
}

void InputReplay::drain_rows() {
    for (std::size_t ring = 0; ring < rings_.size(); ++ring) {
        if (rings_[ring] == nullptr) {
            continue;
        }
        rings_[ring]->drain([&](const SessionRecord& row) {
            if (take_row_ && rows_ && rows_->ring == ring && rows_->taken < rows_->most) {
                ++rows_->taken;
                take_row_(row, epoch_);
            }
        });
    }
}

void InputReplay::hear(const heard::Done& h) {
    session_->collect();
    session_->take_exactly(tick_.commands);
    session_->tick(tick_.now, nullptr, tick_.late);
    session_->collect();
    for (const std::unique_ptr<End>& end : ends_) {
        end->link.end_tick();
        std::shared_ptr<const std::vector<std::byte>> content;
        while (end->port->released.try_pop(content)) {
        }
    }
    drain_rows();
    ++report_.ticks;
    const std::uint64_t outcome = session_->outcome();
    if (outcome != h.outcome && report_.first_different == 0) {
        report_.first_different = report_.ticks;
    }
    BitHash all;
    all.add(report_.outcome);
    all.add(outcome);
    report_.outcome = all.value();
    has_ticked_ = true;
}

}  // namespace tactus
