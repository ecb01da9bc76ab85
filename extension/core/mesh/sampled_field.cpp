#include "core/mesh/sampled_field.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace tactus {

namespace {

constexpr std::size_t max_samples = std::size_t{1} << 27;

std::string in_words(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%g", value);
    return text;
}

}  // namespace

std::string check_field(const SampledField& field) {
    const auto& [columns, rows, layers] = field.size;
    if (columns < 2 || rows < 2 || layers < 2) {
        return "the field has fewer than two samples along an axis: give it at least 2 x 2 x 2";
    }
    const double count = static_cast<double>(columns) * rows * layers;
    if (count > static_cast<double>(max_samples)) {
        return "the field has more than 134,217,728 samples: split it into several bodies, or take every "
               "second sample";
    }
    if (static_cast<double>(field.values.size()) != count) {
        return "the field has " + std::to_string(field.values.size()) + " values, and its size asks for " +
               std::to_string(static_cast<std::size_t>(count)) + ": set both so that they agree";
    }
    for (int axis = 0; axis < 3; ++axis) {
        if (!(field.spacing[axis] > 0.0 && field.spacing[axis] <= 1e6)) {
            return "the distance between the samples of the field is not a positive length: set all three "
                   "above 0 m";
        }
    }
    float least = std::numeric_limits<float>::infinity();
    float most = -least;
    for (std::size_t i = 0; i < field.values.size(); ++i) {
        if (!std::isfinite(field.values[i])) {
            return "value " + std::to_string(i) +
                   " of the field is not a finite number: repair it where the field is made";
        }
        least = std::min(least, field.values[i]);
        most = std::max(most, field.values[i]);
    }
    const bool crosses =
        field.inside_above ? most > field.iso && least <= field.iso : least < field.iso && most >= field.iso;
    if (!crosses) {
        return "the field has no surface, because its values from " + in_words(least) + " to " +
               in_words(most) + " are all on one side of the iso-value " + in_words(field.iso) +
               ": set that between them";
    }
    return {};
}

}  // namespace tactus
