// The session's twin of one body of a scene: made as it was read, beside the loop where that takes a while,
// told what changes, and asked what there is to show. Owner's thread only.
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include "realtime/workers.hpp"
#include "session/session.hpp"
#include "world/body_form.hpp"
#include "world/narrowed_touch.hpp"

namespace tactus {

class BodyTwin {
public:
    SessionHandle handle() const { return handle_; }
    // One of many triangles is built by the workers; until it is ready the body is as it was before, or
    // absent. What is planned meanwhile waits for that one: however often it changes, it gets on.
    bool is_building() const { return job_ != nullptr; }
    // It waits for take_ready() alone.
    bool is_ready() const { return job_ != nullptr && job_->done.load(std::memory_order_acquire); }
    // As it was read when the newest twin was planned.
    const BodyPlan& planned() const { return plan_; }
    const BodyValues& values() const { return values_; }
    const Pose& pose() const { return place_.pose; }
    // What is touched; null where it is not in the session.
    const TouchShape* touch() const { return handle_ != no_handle ? addition_.touch.get() : nullptr; }
    // Its size about its own place, 0 where it has never been in the session (unit: meters).
    double reach() const { return addition_.touch != nullptr ? addition_.touch->reach : 0.0; }

    // Another one whenever the session's body is to be described anew (see addition()).
    std::uint64_t revision() const { return revision_; }
    // The session's body as it is now: what one like it is made from.
    BodyAddition addition() const;
    // Why it cannot be touched, or only in part; as it was found when it was built.
    const std::vector<std::string>& problems() const { return problems_; }

    // The world held as many bodies as it takes when this one came.
    bool found_no_place() const { return found_no_place_; }

    // Has one built: here where that takes no time, which is when it is true, else by the workers.
    bool plan(BodyPlan plan, Workers& workers);
    // Hands over one that has become ready: true where it is new in the session by that, and stands where it
    // was planned. `takes_effect`: the first tick that has certainly taken what is sent now.
    bool take_ready(Session& session, std::uint64_t takes_effect);
    // After take_ready(): where it stands by now.
    void stand_at(Session& session, const BodyPlace& now);
    // What is built is wanted no longer, and what there is goes.
    void remove(Session& session);

    // Where it came from the workers and has kept its form since: has them find out what fingertips of that
    // radius (unit: meters) can touch of it, unless they did so for one as small.
    void narrow(double radius, NarrowedTrees& trees);
    bool is_narrowing() const { return narrowed_.is_under_way(); }
    // Hands over what they have found out.
    void take_narrowed(Session& session);

    void set_values(Session& session, const BodyValues& values);
    // It is there, moved by corrections of the session's body.
    void goes_to(const Pose& pose) { place_.pose = pose; }
    // One that does not move by itself is moved there within `seconds`; 0: it is put there.
    void move_to(Session& session, const Pose& pose, double seconds);
    // What a script has written of a dynamic body, as it was shown last. `axes`: see
    // Session::teleport_body() and set_body_velocity(); what is not among them goes on as it is by then.
    // A place without a velocity is taken relative to where the body is by then: it is as if the script had
    // put it there in the tick that it has seen, and the body had moved on since.
    void write_place(Session& session, const Pose& pose, std::uint32_t axes, bool is_relative);
    void write_velocity(Session& session, const Vec3& linear, const Vec3& angular, std::uint32_t axes);

    // Whether this state, of a snapshot of that tick, is to be shown. Once for each.
    bool has_news(const BodyState& state, std::uint64_t tick) const;
    // That state, with what was sent and is not in it yet: what is to be shown.
    const BodyPlace& take(const BodyState& state);
    std::uint64_t shown_change() const { return shown_change_; }  // BodyState::changed_at of that one

private:
    // What is built, and what came of it. Shared with the thread that builds it.
    struct Job {
        BodyPlan plan;
        BuiltBody built;
        std::atomic<bool> done{false};
    };

    void begin();
    void take_out(Session& session);
    bool deform(Session& session, Job& job);

    // What has been sent and may not be in the states yet that come back. The one that has been carried out
    // as BodyState::asked says is.
    struct Pending {
        std::uint32_t number = 0;
        enum class What { place, shift, velocity } what = What::place;
        BodyPlace place;  // of a shift: by what, and the turn
        std::uint32_t axes = 0;
    };
    void pend(Pending::What what, const BodyPlace& place, std::uint32_t axes);

    // What has_news() needs comes first: it is asked of every body that moves, in every frame.
    SessionHandle handle_ = no_handle;
    std::uint64_t shown_change_ = 0;
    std::uint64_t shown_from_ = 0;  // earlier ticks do not know this body yet
    BodyPlace place_;               // as shown last, or as written since
    BodyValues values_;
    std::vector<Pending> pending_;  // in the order of their numbers
    std::uint32_t asked_ = 0;       // the number of the last one
    std::uint64_t revision_ = 0;
    std::shared_ptr<Job> job_;    // null: nothing is being built
    Workers* workers_ = nullptr;  // that build it
    bool is_waiting_ = false;     // plan_, for job_
    BodyPlan plan_;
    BodyAddition addition_;  // that the session's body was made from
    BodyMakings made_of_;    // likewise
    bool found_no_place_ = false;
    bool can_be_narrowed_ = false;
    NarrowedTouch narrowed_;
    std::vector<std::string> problems_;
};

}  // namespace tactus
