// A field with a layer of samples beyond each border, all of them outside and at the border's own place: what
// reaches the border is closed by cells that are flat.
#pragma once

#include <algorithm>
#include <limits>

#include "core/mesh/sampled_field.hpp"

namespace tactus {

class PaddedField {
public:
    using Place = std::array<std::uint32_t, 3>;  // of a sample; the first one of the field is at 1, 1, 1

    explicit PaddedField(const SampledField& field)
        : field_(field), size_{field.size[0] + 2, field.size[1] + 2, field.size[2] + 2} {}

    const Place& size() const { return size_; }
    const Vec3& spacing() const { return field_.spacing; }

    // The value less the iso-value, turned so that it is below 0 inside; infinite beyond the borders.
    double level(const Place& p) const {
        if (is_beyond(p)) {
            return std::numeric_limits<double>::infinity();
        }
        const std::size_t row = std::size_t{p[2] - 1} * field_.size[1] + (p[1] - 1);
        const double above =
            static_cast<double>(field_.values[row * field_.size[0] + (p[0] - 1)]) - field_.iso;
        return field_.inside_above ? -above : above;
    }

    Vec3 position(const Place& p) const {
        Vec3 result;
        for (int axis = 0; axis < 3; ++axis) {
            const auto i = static_cast<std::size_t>(axis);
            const double last = field_.size[i] - 1.0;
            result[axis] = field_.spacing[axis] * (std::clamp(p[i] - 1.0, 0.0, last) - 0.5 * last);
        }
        return result;
    }

private:
    bool is_beyond(const Place& p) const {
        return p[0] == 0 || p[1] == 0 || p[2] == 0 || p[0] + 1 == size_[0] || p[1] + 1 == size_[1] ||
               p[2] + 1 == size_[2];
    }

    SampledField field_;
    Place size_;
};

}  // namespace tactus
