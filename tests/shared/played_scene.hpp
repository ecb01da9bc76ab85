// Bodies and joints of a scene without an engine: what a script would do to them is done to their fields.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "world/body_mirrors.hpp"

namespace tactus::shared {

// An engine's body. It outlives the mirror's view of it, PlayedBody.
struct Prop {
    std::uint64_t id = 1;
    std::uint64_t carrier = 0;
    bool is_there = true, is_in_scene = true, is_rigid = true;
    SceneFrame frame;
    SceneSpeed speed;
    BodyForm form;
    BodyValues values;
    BodyMakings makings;
    ShapeKey key;
    std::function<void()> when_moved = [] {};  // what a script does as it is put somewhere

    // What the mirror has asked for.
    bool is_held = false, is_listened_to = false, tells_of_moves = true;
    Vec3 pushed{0.0}, pushed_turn{0.0};
    int forms_read = 0, times_put = 0, speeds_set = 0;
    std::vector<std::string> said;
};

inline Prop box_prop(std::uint64_t id, double x = 0.0) {
    Prop prop;
    prop.id = id;
    prop.frame.origin = {x, 0.0, 0.0};
    prop.form.shapes = {PlacedShape{BoxShape{Vec3(0.1)}, Pose{}}};
    prop.form.touchable = true;
    prop.values.motion = Motion::Dynamic;
    prop.key.shapes = {{1, {}}};
    return prop;
}

class PlayedBody final : public SceneBody {
public:
    explicit PlayedBody(Prop& prop) : prop_(prop) {}

    std::uint64_t id() const override { return prop_.id; }
    bool is_there() const override { return prop_.is_there; }
    bool is_in_scene() const override { return prop_.is_there && prop_.is_in_scene; }
    std::string name() const override { return "body " + std::to_string(prop_.id); }
    std::string path() const override { return "path " + std::to_string(prop_.id); }
    bool can_be_thrown() const override { return prop_.is_rigid; }
    SceneFrame frame() const override { return prop_.frame; }
    SceneSpeed speed() const override { return prop_.speed; }
    std::uint64_t carrier() const override { return prop_.carrier; }
    BodyMakings makings(const Mat3&) const override { return prop_.makings; }
    ShapeKey shape_key() const override { return prop_.key; }
    BodyForm form(const Mat3&) const override {
        ++prop_.forms_read;
        return prop_.form;
    }
    BodyValues values(const BodyDefaults&) override { return prop_.values; }
    BodyMotion true_motion() const override {
        return {pose_of(prop_.frame), prop_.speed.linear, prop_.speed.angular};
    }
    void push(const Vec3& impulse, const Vec3& turn) override {
        prop_.pushed += impulse;
        prop_.pushed_turn += turn;
    }
    void hold_still(bool held) override { prop_.is_held = held; }
    void listen() override { prop_.is_listened_to = true; }
    void tell_of_moves(bool tell) override { prop_.tells_of_moves = tell; }
    void let_go() override { prop_.is_held = prop_.is_listened_to = false; }
    // As an engine of single precision keeps them.
    SceneSpeed set_speed(const SceneSpeed& speed) override {
        ++prop_.speeds_set;
        prop_.speed = {Vec3(glm::vec3(speed.linear)), Vec3(glm::vec3(speed.angular))};
        return prop_.speed;
    }
    SceneFrame stand_at(const Pose& pose, const Mat3& scaling) override {
        ++prop_.times_put;
        prop_.frame.axes = Mat3(glm::mat3(glm::mat3_cast(pose.rotation) * scaling));
        prop_.frame.origin = Vec3(glm::vec3(pose.position));
        prop_.when_moved();
        return prop_.frame;
    }
    SceneFrame put_back(const SceneFrame& frame) override {
        prop_.frame = frame;
        return frame;
    }
    void say(const std::string& problem) const override {
        if (!problem.empty()) {
            prop_.said.push_back(problem);
        }
    }

private:
    Prop& prop_;
};

struct JointProp {
    std::uint64_t id = 100;
    bool is_there = true;
    JointReading reading;
    SceneJoint::End first, second;
    std::string problem;
    std::vector<std::string> said;
};

class PlayedJoint final : public SceneJoint {
public:
    explicit PlayedJoint(JointProp& prop) : prop_(prop) {}

    std::uint64_t id() const override { return prop_.id; }
    bool is_there() const override { return prop_.is_there; }
    std::string name() const override { return "joint " + std::to_string(prop_.id); }
    JointReading read() const override { return prop_.reading; }
    End first() const override { return prop_.first; }
    End second() const override { return prop_.second; }
    std::string problem() const override { return prop_.problem; }
    void say(const std::string& problem) const override {
        if (!problem.empty()) {
            prop_.said.push_back(problem);
        }
    }

private:
    JointProp& prop_;
};

}  // namespace tactus::shared
