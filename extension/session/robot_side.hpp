// The far side of scenarios 3 and 5: the environment is a real one, and a robot goes there where the
// operator's hand is. The devices of this side's session are the robots, one for each pointer or tool. Bodies
// of the session are what is known of the environment, by a camera: nothing touches them here. In scenario 5
// they are told to the operator, whose model they make, in place of forces; and what the robot feels of them,
// so that they feel so there.
//
//     operator's place -> stand-in (C') -> target within the workspace -> drive -> HandSafety -> robot
//     robot's place, force of its motors -> momentum observer -> contact force -> operator
//
// robot_side.cpp leads what is held like a fingertip, robot_tools.cpp what carries a tool.
#pragma once

#include "core/teleop/robot_drive.hpp"
#include "session/body_telling.hpp"
#include "session/denied_press.hpp"
#include "session/played_hands.hpp"
#include "session/tool_telling.hpp"
#include "session/touch_learner.hpp"

namespace tactus {

class RobotSide final : public TeleopSide {
public:
    RobotSide(const SessionSettings& session, const TeleopSettings& settings, Link& link,
              std::shared_ptr<TeleopPort> port, const EndpointSettings& endpoint);

    void set_hands(SessionLoop& loop, Nanoseconds now) override;
    void set_forces(SessionLoop& loop, Nanoseconds now) override;
    void report(SessionLoop& loop, Nanoseconds now) override;
    bool simulates() const override { return false; }
    bool drives() const override { return true; }
    bool hears_tools() const override { return true; }
    const ForceLimits& limits() const override { return channel_.settings().limits; }

private:
    struct Pointer {
        PointerSample played;
        Playing playing = Playing::waiting;
        FarPassivity passivity;
        ContactObserver observer;
        bool holds = false;    // an operator's hand is there and the robot answers
        bool returns = false;  // from an outage: see most_press()
        Vec3 target{0.0};      // in this side's scene (unit: meters)
        Vec3 velocity{0.0};    // of the target (unit: meters per second)
        Wall coupling;         // of the robot to the target
        Vec3 contact{0.0};     // on the robot, in this side's scene (unit: newtons)
        Vec3 coupled{0.0};     // by the coupling, on the target, one tick ago (unit: newtons)
        Vec3 had_hand{0.0};    // one tick ago (unit: meters)
        Vec3 force_sent{0.0};
        Nanoseconds force_sent_at = 0;
    };

    // What a robot can do with a tool.
    enum class Wrist : std::uint8_t {
        unknown,  // it is not there
        stiff,    // it does not turn
        driven,   // its motors turn it
        loose,    // it turns, and nothing holds it
    };

    struct Tool {
        OperatorSample played;
        ContactObserver observer, twist_observer;
        Wrist wrist = Wrist::unknown;
        bool holds = false;    // an operator's hand is there and the robot answers
        bool returns = false;  // from an outage: see most_press()
        Pose wanted;           // where the hand would have the tool, in this side's scene
        Pose target;           // of the handle, in the same scene
        Vec3 velocity{0.0};    // of the target (unit: meters per second)
        Vec3 spin{0.0};        // (unit: radians per second)
        Wall coupling;         // of the handle to the target
        Wall turning;          // the same of its turn (units: newton meters, and their seconds, per radian)
        Wrench contact;        // on the tool, about its origin, in this side's scene
        Vec3 had_place{0.0};   // of the handle, one tick ago (unit: meters)
        SaidWrench said;
    };

    const TeleopSettings& settings() const { return channel_.settings(); }
    void receive(SessionLoop& loop);
    void release_hands(SessionLoop& loop);
    static RobotBody body_of(const DeviceCapabilities& robot);
    static double friction_at(const RobotView& robot, const Vec3& velocity);
    Wall coupling_of(const RobotView& robot) const;
    std::optional<double> most_press(const PointerSample& played, bool returns) const;
    static Vec3 yielding(const Vec3& target, const Vec3& place, double most, double friction,
                         const Wall& coupling);
    void play(SessionLoop& loop, std::size_t index, const SessionLoop::ProxySlot& slot);
    Vec3 hand_of(Pointer& pointer, const SessionLoop::ProxySlot& slot, const RobotView& robot,
                 const Wall& coupling) const;
    Vec3 told_force(const Pointer& pointer) const;
    void send_forces(SessionLoop& loop, Nanoseconds now);

    // --- robot_tools.cpp
    static Wrist wrist_of(const RobotView& robot);
    void play(SessionLoop& loop, std::size_t index, ToolSlot& slot);
    void feel(SessionLoop& loop, Tool& tool, const ToolSlot& slot, const RobotView& robot) const;
    void lead(Tool& tool, const ToolSlot& slot, const RobotView& robot) const;
    static void drive(const Tool& tool, ToolSlot& slot);
    void tell_tools(SessionLoop& loop, Nanoseconds now);

    Channel channel_;
    BodyTelling telling_;
    PlayedHands hands_;
    TouchLearner touch_;
    double seconds_;  // of a tick
    std::array<Pointer, max_proxies> pointers_;
    std::array<Tool, max_tools> tools_;
    std::uint64_t tool_tick_ = 0;
    TeleopStatistics statistics_;
};

}  // namespace tactus
