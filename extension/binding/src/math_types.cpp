// The larger operations of the math types. Where Godot has a rule of its own (Euler orders, text), Godot is
// asked.

#include <godot_cpp/private/ptrcall.hpp>
#include <godot_cpp/variant/variant.hpp>

namespace godot {

#define GODOT_BINDING_TO_STRING(m_class)   \
    m_class::operator String() const {     \
        return Variant(*this).stringify(); \
    }

GODOT_BINDING_TO_STRING(Vector2)
GODOT_BINDING_TO_STRING(Vector2i)
GODOT_BINDING_TO_STRING(Vector3)
GODOT_BINDING_TO_STRING(Vector3i)
GODOT_BINDING_TO_STRING(Vector4)
GODOT_BINDING_TO_STRING(Vector4i)
GODOT_BINDING_TO_STRING(Rect2)
GODOT_BINDING_TO_STRING(Rect2i)
GODOT_BINDING_TO_STRING(Transform2D)
GODOT_BINDING_TO_STRING(Plane)
GODOT_BINDING_TO_STRING(Quaternion)
GODOT_BINDING_TO_STRING(AABB)
GODOT_BINDING_TO_STRING(Basis)
GODOT_BINDING_TO_STRING(Transform3D)
GODOT_BINDING_TO_STRING(Projection)
GODOT_BINDING_TO_STRING(Color)

// Column by column: q · e_x, q · e_y, q · e_z.
Basis::Basis(const Quaternion& q)
    : Basis(q.xform(Vector3(1, 0, 0)), q.xform(Vector3(0, 1, 0)), q.xform(Vector3(0, 0, 1))) {}

// Shepperd: divide by the largest of |x|, |y|, |z|, |w|, which is never below 1/2.
Quaternion Basis::get_quaternion() const {
    const real_t m00 = rows[0].x;
    const real_t m11 = rows[1].y;
    const real_t m22 = rows[2].z;
    const real_t trace = m00 + m11 + m22;
    if (trace > 0) {
        const real_t s = 2 * std::sqrt(trace + 1);
        return {(rows[2].y - rows[1].z) / s, (rows[0].z - rows[2].x) / s, (rows[1].x - rows[0].y) / s, s / 4};
    }
    if (m00 >= m11 && m00 >= m22) {
        const real_t s = 2 * std::sqrt(1 + m00 - m11 - m22);
        return {s / 4, (rows[0].y + rows[1].x) / s, (rows[0].z + rows[2].x) / s, (rows[2].y - rows[1].z) / s};
    }
    if (m11 >= m22) {
        const real_t s = 2 * std::sqrt(1 + m11 - m00 - m22);
        return {(rows[0].y + rows[1].x) / s, s / 4, (rows[1].z + rows[2].y) / s, (rows[0].z - rows[2].x) / s};
    }
    const real_t s = 2 * std::sqrt(1 + m22 - m00 - m11);
    return {(rows[0].z + rows[2].x) / s, (rows[1].z + rows[2].y) / s, s / 4, (rows[1].x - rows[0].y) / s};
}

Quaternion Basis::get_rotation_quaternion() const {
    const Basis frame = orthonormalized();
    return (frame.determinant() < 0 ? frame * real_t(-1) : frame).get_quaternion();
}

Vector3 Basis::get_euler(EulerOrder order) const {
    return Variant(*this).call("get_euler", static_cast<int64_t>(order));
}

Basis Basis::from_euler(const Vector3& euler, EulerOrder order) {
    return Variant(Basis()).call("from_euler", euler, static_cast<int64_t>(order));
}

// −z looks at the target, or +z with use_model_front.
Basis Basis::looking_at(const Vector3& target, const Vector3& up, bool use_model_front) {
    const Vector3 z = use_model_front ? target.normalized() : -target.normalized();
    const Vector3 x = up.cross(z).normalized();
    return Basis(x, z.cross(x), z);
}

Transform3D Transform3D::interpolate_with(const Transform3D& to, real_t weight) const {
    const Quaternion turned =
        basis.get_rotation_quaternion().slerp(to.basis.get_rotation_quaternion(), weight);
    const Vector3 scale = basis.get_scale().lerp(to.basis.get_scale(), weight);
    return Transform3D(Basis(turned).scaled_local(scale), origin.lerp(to.origin, weight));
}

Color Color::html(const String& rgba) {
    return Variant(Color()).call("html", rgba);
}

Color Color::from_hsv(float h, float s, float v, float a) {
    return Variant(Color()).call("from_hsv", h, s, v, a);
}

String Color::to_html(bool with_alpha) const {
    return Variant(*this).call("to_html", with_alpha);
}

}  // namespace godot
