#include "world/running_world.hpp"

namespace tactus {

RunningWorld::RunningWorld(const SessionSettings& settings, bool real_time, const Pose& frame,
                           const std::vector<LinkPlan>& links, std::unique_ptr<InputRecording> inputs)
    : inputs_(std::move(inputs)),
      session_(settings, inputs_ != nullptr ? &inputs_->recorder() : nullptr),
      loop_(session_, real_time) {
    std::vector<WorldLink*> attached;
    for (const LinkPlan& plan : links) {
        links_.push_back(
            std::make_unique<WorldLink>(plan, session_, settings.physics.gravity, frame, loop_.ahead()));
        attached.push_back(links_.back().get());
    }
    WorldLink::attach(session_, attached);
}

// --- time

void RunningWorld::stop_loop() {
    loop_.stop();
    drain();
}

void RunningWorld::pause() {
    stop_loop();
    session_.rest();
    session_.refresh();
}

std::int64_t RunningWorld::advance(double seconds) {
    // A hundredth of a tick covers what adding up many small times loses to rounding.
    constexpr double rounding = 0.01;
    const double tick = to_seconds(session_.settings().period);
    owed_seconds_ += seconds;
    const auto ticks = static_cast<std::int64_t>(owed_seconds_ / tick + rounding);
    owed_seconds_ -= static_cast<double>(ticks) * tick;
    loop_.advance(ticks, [this] {
        session_.collect();
        drain();
    });
    return ticks;
}

void RunningWorld::end() {
    if (std::exchange(is_over_, true)) {
        return;
    }
    stop_loop();
    for (const auto& link : links_) {
        link->leave();
    }
    if (!links_.empty()) {
        loop_.tick_once();
    }
    session_.rest();
    for (const auto& link : links_) {
        link->end();
    }
    let_go_of_recording();
    if (inputs_ != nullptr) {
        inputs_->drain(loop_.epoch());
        inputs_->close();
    }
}

bool RunningWorld::collect() {
    const bool waits = session_.collect();
    if (!waits) {
        listeners_.forget_retired();
    }
    return !waits;
}

// --- pushes

void RunningWorld::push(SessionHandle body, const BodyPush& push, bool for_a_frame) {
    if (for_a_frame) {
        forces_.emplace_back(body, push);
    } else {
        session_.push_body(body, push);
    }
}

void RunningWorld::push_for(double seconds) {
    for (auto& [body, push] : forces_) {
        push.impulse *= seconds;
        push.turn *= seconds;
        session_.push_body(body, push);
    }
    forces_.clear();
}

BodyState RunningWorld::state_of(SessionHandle body) {
    const SessionSnapshot& snapshot = session_.snapshot();
    const BodyState* state = tactus::state_of(snapshot.bodies, snapshot.body_count, body);
    return state != nullptr ? *state : BodyState{};
}

// --- far sides

bool RunningWorld::synchronise(WorldLink& link, const std::optional<LinkPlan>& plan, const Vec3& gravity) {
    return link.synchronise(plan, gravity, Workers::shared(),
                            {loop_.now(), !loop_.is_running(), !loop_.is_real_time()});
}

// --- who hears it

std::string RunningWorld::record(std::shared_ptr<Recording> recording) {
    recording_ = std::move(recording);
    if (inputs_ != nullptr) {
        InputRecorder& recorder = inputs_->recorder();
        recorder.note(call::WriteRows{recorder.number_of(recording_->ring().get())});
    }
    return recording_->has_trace() ? loop_.trace_ticks() : std::string();
}

void RunningWorld::finish_recording() {
    drain();
    let_go_of_recording();
}

// What comes into its ring from now on nobody writes down.
void RunningWorld::let_go_of_recording() {
    if (recording_ != nullptr && inputs_ != nullptr) {
        InputRecorder& recorder = inputs_->recorder();
        recorder.note(call::RowsWritten{recorder.number_of(recording_->ring().get()), recording_->rows()});
    }
    recording_.reset();
}

void RunningWorld::drain() {
    if (inputs_ != nullptr) {
        inputs_->drain(loop_.epoch());
    }
    if (recording_ != nullptr) {
        recording_->drain(loop_.epoch());
        if (TickTrace* trace = loop_.trace()) {
            recording_->drain(*trace);
        }
    }
}

}  // namespace tactus
