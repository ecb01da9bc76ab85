#pragma once

#include <godot_cpp/classes/array_mesh.hpp>
#include <godot_cpp/classes/curve3d.hpp>
#include <godot_cpp/classes/resource.hpp>
#include <godot_cpp/core/binder_common.hpp>
#include <godot_cpp/variant/packed_vector3_array.hpp>

#include "core/haptics/hand_guide.hpp"
#include "nodes/messages.hpp"
#include "nodes/properties.hpp"

namespace tactus {

// Leads the hand where there is no surface.
class HapticGuide : public godot::Resource {
    GDCLASS(HapticGuide, godot::Resource)

public:
    TACTUS_PROPERTIES(HapticGuide)

    godot::String get_problem() const { return to_godot(check_guide(described())); }
    godot::PackedStringArray get_problems() const { return list_of(get_problem()); }
    godot::Vector3 get_place(const godot::Vector3& hand) const;
    godot::Ref<godot::ArrayMesh> create_line_mesh(double thickness) const;

    // One that leads nowhere where it has a problem.
    HandGuide guide() const;

protected:
    static void _bind_methods();

private:
    HandGuide described() const;
    // In the world: its own points, or those along its curve.
    std::vector<Vec3> places() const;

    HandGuide::Form form_ = HandGuide::Form::way;
    godot::PackedVector3Array points_;
    godot::Ref<godot::Curve3D> curve_;
    double stiffness_ = 200.0;
    double range_ = 0.03;
};

}  // namespace tactus
