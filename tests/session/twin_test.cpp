// A second loop in which the past is replayed gets every change that the first one gets.
#include <optional>
#include <vector>

#include "session/loop_memento.hpp"
#include "session/session_loop.hpp"
#include "session_rig.hpp"

namespace tactus::twin_test {
namespace {

using namespace session_test;

SessionSettings small() {
    SessionSettings settings;
    settings.max_bodies = 16;
    settings.full_rate_bodies = 0;
    return settings;
}

// Saves the loop when asked to, and does the ticks since then again in its twin.
class Replaying final : public TeleopSide {
public:
    Replaying() : twin_(small(), nobody_looks_), memento_(16, 65536) {}

    void set_hands(SessionLoop&, Nanoseconds) override {}
    void set_forces(SessionLoop&, Nanoseconds) override {}
    void report(SessionLoop& loop, Nanoseconds now) override {
        loop_ = &loop;
        now_ = now;
        if (saves_) {
            saved_at_ = loop.save(memento_) ? now : -1;
            saves_ = false;
        }
    }
    const ForceLimits& limits() const override { return limits_; }
    SessionLoop* twin() override { return &twin_; }

    void save() { saves_ = true; }
    bool replay() {
        if (saved_at_ < 0 || !twin_.restore(memento_)) {
            return false;
        }
        for (Nanoseconds at = saved_at_; at < now_; at += period) {
            twin_.begin_replay_tick();
            twin_.proxy(0).hand = loop_->proxy(0).hand;  // it stays where it is
            twin_.end_replay_tick(at + period);
        }
        return true;
    }
    BodyMotion replayed(SessionHandle body) { return twin_.motion(body); }
    BodyMotion present(SessionHandle body) { return loop_->motion(body); }

private:
    TripleBuffer<SessionSnapshot> nobody_looks_{[] {
        SessionSnapshot snapshot;
        snapshot.bodies.resize(16);
        return snapshot;
    }()};
    SessionLoop twin_;
    LoopMemento memento_;
    ForceLimits limits_;
    SessionLoop* loop_ = nullptr;
    bool saves_ = false;
    Nanoseconds saved_at_ = -1;
    Nanoseconds now_ = 0;
};

struct Twins {
    explicit Twins(std::unique_ptr<Replaying> made = std::make_unique<Replaying>())
        : side(made.get()), rig(small(), nullptr, std::move(made)) {
        rig.device.position = {5.0, 1.0, 5.0};  // of all bodies
        rig.tick();
        rig.add(ground());
        for (int i = 0; i < 4; ++i) {
            BodyAddition addition =
                body(BoxShape{Vec3(0.05)}, {0.12 * i, 0.3 + 0.1 * i, 0.0}, Motion::Dynamic, 0.4);
            addition.description.angular_velocity = {0.0, 1.0, 2.0};
            boxes.push_back(rig.add(addition));
        }
    }

    void expect_same_after(int ticks) {
        side->save();
        rig.ticks(ticks);
        ASSERT_TRUE(side->replay());
        for (const SessionHandle box : boxes) {
            const BodyMotion present = side->present(box);
            const BodyMotion replayed = side->replayed(box);
            EXPECT_EQ(present.pose.position, replayed.pose.position);
            EXPECT_EQ(present.pose.rotation, replayed.pose.rotation);
            EXPECT_EQ(present.linear_velocity, replayed.linear_velocity);
        }
    }

    Replaying* side;  // the session's
    SessionRig rig;
    std::vector<SessionHandle> boxes;
};

JointDescription joint(JointKind kind) {
    JointDescription made;
    made.kind = kind;
    made.frame.position = {0.06, 0.0, 0.0};
    made.angular[2] = {-0.4, 0.6};
    made.linear[0] = {-0.02, 0.01};
    return made;
}

TEST(SessionTwin, ReplaysWhatMoved) {
    Twins twins;
    twins.rig.ticks(50);
    twins.expect_same_after(200);
}

TEST(SessionTwin, AJointMadeWhileBodiesMoveIsTheSameInTheReplay) {
    for (const JointKind kind : {JointKind::Pin, JointKind::Hinge, JointKind::Slider, JointKind::SixAxes}) {
        Twins twins;
        twins.rig.ticks(150);
        const SessionHandle first =
            twins.rig.session.add_joint(joint(kind), twins.boxes[0], twins.boxes[1]).handle;
        twins.rig.session.add_joint(joint(kind), twins.boxes[2], no_handle);
        twins.rig.ticks(5);
        twins.expect_same_after(200);
        twins.rig.session.remove_joint(first);
        twins.rig.ticks(5);
        twins.expect_same_after(100);
    }
}

TEST(SessionTwin, ChangesOfBodiesReachTheReplay) {
    Twins twins;
    twins.rig.ticks(100);
    Session& session = twins.rig.session;
    session.set_body_gravity_scale(twins.boxes[0], 0.3);
    session.set_body_damping(twins.boxes[1], 4.0, 4.0);
    session.set_body_surface(twins.boxes[2], {0.05, 0.8, false, false});
    session.set_body_motion(twins.boxes[3], Motion::Kinematic);
    session.set_body_push(twins.boxes[0], {0.5, 0.0, 0.1}, {0.01, 0.0, 0.0});
    session.teleport_body(twins.boxes[1], {{1.0, 0.5, 0.0}, Quat(1.0, 0.0, 0.0, 0.0)});
    twins.rig.ticks(5);
    twins.expect_same_after(200);
    session.remove_body(twins.boxes[3]);
    twins.boxes.pop_back();
    twins.boxes.push_back(twins.rig.add(body(SphereShape{0.04}, {0.3, 0.4, 0.1}, Motion::Dynamic, 0.2)));
    twins.rig.ticks(5);
    twins.expect_same_after(300);
}

// Of both loops' bodies the former shape is given back.
TEST(SessionTwin, ANarrowedShapeIsThatOfBoth) {
    Twins twins;
    BodyAddition lump = body(SphereShape{0.1}, {3.0, 0.0, 0.0}, Motion::Static);
    lump.touch = make_touch_shape(lump.description.shapes).shape;
    const SessionHandle handle = twins.rig.add(lump);
    twins.rig.tick();
    EXPECT_EQ(lump.touch.use_count(), 3);
    const auto narrower = std::make_shared<const TouchShape>(*lump.touch);
    twins.rig.session.narrow_touch(handle, narrower, 0.01);
    twins.rig.tick();
    twins.rig.session.collect();
    EXPECT_EQ(narrower.use_count(), 3);
    EXPECT_EQ(lump.touch.use_count(), 1);
    twins.expect_same_after(100);
}

}  // namespace
}  // namespace tactus::twin_test
