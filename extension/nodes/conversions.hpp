// Between Godot's values and ours. Both are right-handed with y up and in SI units, so nothing is turned or
// scaled: only the precision changes (Godot's vectors are single precision in its official builds).
#pragma once

#include <algorithm>
#include <godot_cpp/variant/basis.hpp>
#include <godot_cpp/variant/packed_string_array.hpp>
#include <godot_cpp/variant/packed_vector3_array.hpp>
#include <godot_cpp/variant/quaternion.hpp>
#include <godot_cpp/variant/string.hpp>
#include <godot_cpp/variant/transform3d.hpp>
#include <godot_cpp/variant/vector3.hpp>
#include <string>
#include <vector>

#include "world/scene_frame.hpp"

namespace tactus {

inline Vec3 from_godot(const godot::Vector3& v) {
    return {v.x, v.y, v.z};
}

inline godot::Vector3 to_godot(const Vec3& v) {
    return {static_cast<godot::real_t>(v.x), static_cast<godot::real_t>(v.y),
            static_cast<godot::real_t>(v.z)};
}

inline std::vector<Vec3> from_godot(const godot::PackedVector3Array& packed) {
    std::vector<Vec3> places(static_cast<std::size_t>(packed.size()));
    std::transform(packed.ptr(), packed.ptr() + packed.size(), places.begin(),
                   [](const godot::Vector3& place) { return from_godot(place); });
    return places;
}

// Of places in single or double precision.
template <class Places>
godot::PackedVector3Array packed(const Places& places) {
    godot::PackedVector3Array all;
    all.resize(static_cast<int64_t>(places.size()));
    std::transform(places.begin(), places.end(), all.ptrw(),
                   [](const auto& place) { return to_godot(Vec3(place)); });
    return all;
}

// Normalised again in double precision: Godot's is a unit quaternion to single precision only.
inline Quat from_godot(const godot::Quaternion& q) {
    return glm::normalize(Quat(q.w, q.x, q.y, q.z));
}

inline godot::Quaternion to_godot(const Quat& q) {
    return {static_cast<godot::real_t>(q.x), static_cast<godot::real_t>(q.y), static_cast<godot::real_t>(q.z),
            static_cast<godot::real_t>(q.w)};
}

inline godot::Transform3D to_godot(const Pose& pose) {
    return {godot::Basis(to_godot(pose.rotation)), to_godot(pose.position)};
}

inline SceneFrame frame_of(const godot::Transform3D& transform) {
    const godot::Basis& basis = transform.basis;
    return {Mat3(from_godot(basis.get_column(0)), from_godot(basis.get_column(1)),
                 from_godot(basis.get_column(2))),
            from_godot(transform.origin)};
}

inline Pose pose_of(const godot::Transform3D& transform) {
    return pose_of(frame_of(transform));
}

inline godot::Basis basis_of(const Mat3& matrix) {
    godot::Basis basis;
    for (int i = 0; i < 3; ++i) {
        basis.set_column(i, to_godot(matrix[i]));
    }
    return basis;
}

// Where `pose` is, scaled.
inline godot::Transform3D to_godot(const SceneFrame& frame) {
    return {basis_of(frame.axes), to_godot(frame.origin)};
}
inline godot::Transform3D to_godot(const Pose& pose, const Mat3& scaling) {
    const godot::Transform3D placed = to_godot(pose);
    return {placed.basis * basis_of(scaling), placed.origin};
}

inline godot::String to_godot(const std::string& text) {
    return godot::String::utf8(text.c_str());
}

inline std::string from_godot(const godot::String& text) {
    return text.utf8().get_data();
}

inline godot::PackedStringArray to_godot(const std::vector<std::string>& texts) {
    godot::PackedStringArray all;
    for (const std::string& text : texts) {
        all.push_back(to_godot(text));
    }
    return all;
}

}  // namespace tactus
