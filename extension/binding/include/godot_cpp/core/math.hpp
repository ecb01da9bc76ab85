#pragma once

#include <cmath>
#include <godot_cpp/core/defs.hpp>

#ifndef Math_PI
#define Math_PI 3.1415926535897932384626433833
#define Math_TAU 6.2831853071795864769252867666
#endif
#ifndef CMP_EPSILON
#define CMP_EPSILON 0.00001
#define CMP_EPSILON2 (CMP_EPSILON * CMP_EPSILON)
#define UNIT_EPSILON 0.001
#endif

namespace godot {

template <class T>
constexpr const T MIN(const T a, const T b) {
    return a < b ? a : b;
}

template <class T>
constexpr const T MAX(const T a, const T b) {
    return a > b ? a : b;
}

template <class T>
constexpr const T CLAMP(const T value, const T low, const T high) {
    return value < low ? low : (value > high ? high : value);
}

template <class T>
constexpr const T ABS(const T value) {
    return value < T(0) ? -value : value;
}

template <class T>
constexpr const T SIGN(const T value) {
    return value == T(0) ? T(0) : (value < T(0) ? T(-1) : T(1));
}

namespace Math {

inline bool is_equal_approx(double a, double b, double tolerance) {
    return a == b || std::abs(a - b) < tolerance;
}

// Relative to the size of a, never finer than CMP_EPSILON: the engine's own notion of "the same number".
inline bool is_equal_approx(double a, double b) {
    return is_equal_approx(a, b, std::fmax(CMP_EPSILON * std::abs(a), CMP_EPSILON));
}
inline bool is_equal_approx(float a, float b) {
    return is_equal_approx(static_cast<double>(a), static_cast<double>(b));
}
inline bool is_zero_approx(double value) {
    return std::abs(value) < CMP_EPSILON;
}
inline bool is_finite(double value) {
    return std::isfinite(value);
}
inline bool is_nan(double value) {
    return std::isnan(value);
}
inline bool is_inf(double value) {
    return std::isinf(value);
}
inline double deg_to_rad(double degrees) {
    return degrees * (Math_PI / 180.0);
}
inline float deg_to_rad(float degrees) {
    return degrees * static_cast<float>(Math_PI / 180.0);
}
inline double rad_to_deg(double radians) {
    return radians * (180.0 / Math_PI);
}
inline float rad_to_deg(float radians) {
    return radians * static_cast<float>(180.0 / Math_PI);
}
inline double lerp(double from, double to, double weight) {
    return from + (to - from) * weight;
}
inline float lerp(float from, float to, float weight) {
    return from + (to - from) * weight;
}
inline double snapped(double value, double step) {
    return step == 0.0 ? value : std::floor(value / step + 0.5) * step;
}
inline float snapped(float value, float step) {
    return static_cast<float>(snapped(static_cast<double>(value), static_cast<double>(step)));
}

using std::abs;
using std::acos;
using std::asin;
using std::atan;
using std::atan2;
using std::ceil;
using std::cos;
using std::exp;
using std::floor;
using std::fmod;
using std::log;
using std::pow;
using std::round;
using std::sin;
using std::sqrt;
using std::tan;

}  // namespace Math
}  // namespace godot
