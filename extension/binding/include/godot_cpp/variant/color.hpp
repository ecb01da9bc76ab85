#pragma once

#include <godot_cpp/core/math.hpp>

namespace godot {

class String;

// Red, green, blue and opacity, 0 to 1 (brighter than 1 is allowed); always single precision.
struct Color {
    float r = 0;
    float g = 0;
    float b = 0;
    float a = 1;

    constexpr Color() = default;
    constexpr Color(float p_r, float p_g, float p_b, float p_a = 1) : r(p_r), g(p_g), b(p_b), a(p_a) {}
    constexpr Color(const Color& color, float p_a) : r(color.r), g(color.g), b(color.b), a(p_a) {}
    operator String() const;
    static Color html(const String& rgba);
    static Color from_hsv(float h, float s, float v, float a = 1);
    String to_html(bool with_alpha = true) const;

    float& operator[](int index) { return (&r)[index]; }
    const float& operator[](int index) const { return (&r)[index]; }
    constexpr Color lerp(const Color& to, float weight) const {
        return {r + (to.r - r) * weight, g + (to.g - g) * weight, b + (to.b - b) * weight,
                a + (to.a - a) * weight};
    }
    constexpr Color lightened(float by) const {
        return {r + (1 - r) * by, g + (1 - g) * by, b + (1 - b) * by, a};
    }
    constexpr Color darkened(float by) const { return {r * (1 - by), g * (1 - by), b * (1 - by), a}; }
    constexpr Color operator+(const Color& c) const { return {r + c.r, g + c.g, b + c.b, a + c.a}; }
    constexpr Color operator*(const Color& c) const { return {r * c.r, g * c.g, b * c.b, a * c.a}; }
    constexpr Color operator*(float s) const { return {r * s, g * s, b * s, a * s}; }
    bool is_equal_approx(const Color& c) const {
        return Math::is_equal_approx(r, c.r) && Math::is_equal_approx(g, c.g) &&
               Math::is_equal_approx(b, c.b) && Math::is_equal_approx(a, c.a);
    }
    constexpr bool operator==(const Color& c) const { return r == c.r && g == c.g && b == c.b && a == c.a; }
    constexpr bool operator!=(const Color& c) const { return !(*this == c); }
};

}  // namespace godot
