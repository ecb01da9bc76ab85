#pragma once

#include <godot_cpp/classes/array_mesh.hpp>
#include <godot_cpp/classes/curve3d.hpp>
#include <godot_cpp/classes/resource.hpp>
#include <godot_cpp/core/binder_common.hpp>
#include <godot_cpp/variant/packed_vector3_array.hpp>
#include <godot_cpp/variant/transform3d.hpp>
#include <memory>
#include <string>

#include "core/haptics/hand_guide.hpp"
#include "nodes/messages.hpp"
#include "nodes/properties.hpp"

namespace tactus {

// Leads the hand where there is no surface.
class HapticGuide : public godot::Resource {
    GDCLASS(HapticGuide, godot::Resource)

public:
    TACTUS_PROPERTIES(HapticGuide)

    godot::String get_problem() const { return to_godot(problem_of(described(godot::Transform3D()))); }
    godot::PackedStringArray get_problems() const { return list_of(get_problem()); }
    godot::Vector3 get_place(const godot::Vector3& hand) const;
    godot::Ref<godot::ArrayMesh> create_line_mesh(double thickness) const;

    // Its points are in that frame. One that leads nowhere where it has a problem.
    HandGuide guide(const godot::Transform3D& frame) const;

protected:
    static void _bind_methods();

private:
    struct MadeWay {
        std::shared_ptr<const GuideWay> way;  // null: it is to be made
        Mat3 scaling{1.0};                    // see scaling_of()
        std::string problem;                  // of it; empty where it can be followed
    };

    void points_changed();
    HandGuide described(const godot::Transform3D& frame) const;
    std::string problem_of(const HandGuide& guide) const;
    const std::shared_ptr<const GuideWay>& way(const Mat3& scaling) const;
    // Its own points, or those along its curve.
    std::vector<Vec3> places() const;

    HandGuide::Form form_ = HandGuide::Form::way;
    HandGuide::Mode mode_ = HandGuide::Mode::attract;
    godot::PackedVector3Array points_;
    godot::Ref<godot::Curve3D> curve_;
    double stiffness_ = 200.0;
    double range_ = 0.03;

    mutable MadeWay made_;  // shared by all that follow it
};

}  // namespace tactus
