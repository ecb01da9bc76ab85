// A world that runs, without what it shows: its session, who ticks it, who hears it, and its links to far
// sides.
//
// Threads: all of it belongs to the session's owner; the haptic thread is that of the loop (world_loop.hpp).
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "world/input_recording.hpp"
#include "world/recording.hpp"
#include "world/tick_listeners.hpp"
#include "world/world_link.hpp"
#include "world/world_loop.hpp"

namespace tactus {

class RunningWorld {
public:
    // `frame`: of the world as it begins. No links: nobody is at a far side. `inputs`: of the same settings;
    // null: they are not recorded.
    RunningWorld(const SessionSettings& settings, bool real_time, const Pose& frame,
                 const std::vector<LinkPlan>& links, std::unique_ptr<InputRecording> inputs = nullptr);
    ~RunningWorld() { end(); }
    RunningWorld(const RunningWorld&) = delete;
    RunningWorld& operator=(const RunningWorld&) = delete;

    Session& session() { return session_; }
    WorldLoop& loop() { return loop_; }
    const WorldLoop& loop() const { return loop_; }

    // --- time

    void stop_loop();
    // Ticks stop for a while: nothing pushes the hand meanwhile.
    void pause();
    // Stepped time only: as many ticks at once, here, as there are in this time and what was left of earlier
    // ones. Answers how many.
    std::int64_t advance(double seconds);
    // Far sides are told; nothing ticks after it, and nobody holds a recording any more.
    void end();
    bool is_over() const { return is_over_; }

    // The session has carried out what it was asked; what it has let go of is free. Answers whether it has
    // carried out all of it.
    bool collect();

    // --- pushes

    // In the next tick; `for_a_frame`: a force of that size, and its torque, for as long as the next frame
    // is.
    void push(SessionHandle body, const BodyPush& push, bool for_a_frame);
    // Of one that can move, as of the snapshot; at rest where there is none.
    BodyState state_of(SessionHandle body);
    // The next frame is so long.
    void push_for(double seconds);

    // --- far sides

    const std::vector<std::unique_ptr<WorldLink>>& links() const { return links_; }
    bool is_operator() const { return !links_.empty() && links_.front()->is_operator(); }
    // See WorldLink::synchronise().
    bool synchronise(WorldLink& link, const std::optional<LinkPlan>& plan, const Vec3& gravity);

    // --- who hears it

    TickListeners& listeners() { return listeners_; }
    // From now on, until finish_recording(). Empty text, or why ticks cannot be timed for its trace.
    std::string record(std::shared_ptr<Recording> recording);
    const std::shared_ptr<Recording>& recording() const { return recording_; }  // null: none
    void finish_recording();
    // What has been recorded goes to its files.
    void drain();
    const InputRecording* inputs() const { return inputs_.get(); }  // null: none are recorded

private:
    void let_go_of_recording();

    std::unique_ptr<InputRecording> inputs_;         // above the session, which it hears
    std::vector<std::unique_ptr<WorldLink>> links_;  // likewise: its sides use them
    Session session_;
    WorldLoop loop_;
    std::vector<std::pair<SessionHandle, BodyPush>> forces_;  // until the next frame
    TickListeners listeners_;
    std::shared_ptr<Recording> recording_;
    double owed_seconds_ = 0.0;  // of stepped time, less than a tick
    bool is_over_ = false;
};

}  // namespace tactus
