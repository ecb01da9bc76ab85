#include "nodes/haptic_volume.hpp"

#include <algorithm>
#include <cstring>
#include <godot_cpp/classes/image.hpp>
#include <span>

#include "core/mesh/iso_surface.hpp"
#include "nodes/mesh_drawing.hpp"
#include "nodes/red_channel.hpp"

namespace tactus {

using namespace godot;

namespace {

// Some samples are on the surface: each costs about as much as a triangle does.
constexpr std::size_t samples_a_triangle = 4;

std::uint32_t as_count(int64_t number) {
    return static_cast<std::uint32_t>(std::clamp<int64_t>(number, 0, 0xffff'ffff));
}

}  // namespace

void HapticVolume::samples_changed() {
    surface_.forget();
    emit_changed();
}

// A slice that is no image, or of another size than the first, leaves too few values, which is then said.
HapticVolume::Samples HapticVolume::samples() const {
    if (!values_.is_empty() || slices_.is_empty()) {
        return {values_, {as_count(size_.x), as_count(size_.y), as_count(size_.z)}};
    }
    Samples samples;
    samples.size[2] = as_count(slices_.size());
    for (int64_t i = 0; i < slices_.size(); ++i) {
        const Ref<Image> image = slices_[i];
        if (image.is_null() || image->is_empty()) {
            continue;
        }
        const std::uint32_t width = as_count(image->get_width());
        const std::uint32_t height = as_count(image->get_height());
        if (samples.values.is_empty()) {
            samples.size[0] = width;
            samples.size[1] = height;
        }
        if (width == samples.size[0] && height == samples.size[1]) {
            samples.values.append_array(red_channel(image).to_float32_array());
        }
    }
    return samples;
}

std::shared_ptr<TriangleSource> HapticVolume::surface() const {
    if (surface_.get() == nullptr) {
        const Samples taken = samples();
        auto read = [taken, spacing = voxel_size_, iso = iso_value_, above = solid_above_] {
            const std::span<const float> values(taken.values.ptr(),
                                                static_cast<std::size_t>(taken.values.size()));
            IsoSurface made = iso_surface({taken.size, spacing, values, iso, above});
            return TriangleSource::Read(std::move(made.mesh), std::move(made.error));
        };
        const auto count = static_cast<std::size_t>(taken.values.size()) / samples_a_triangle;
        surface_.succeed_by(std::make_shared<TriangleSource>(std::move(read), count));
    }
    return surface_.get();
}

String HapticVolume::get_problem() const {
    return to_godot(surface()->triangles().error);
}

Ref<ArrayMesh> HapticVolume::create_mesh() const {
    const TriangleSource::Checked& triangles = surface()->triangles();
    return drawn_mesh(triangles.mesh != nullptr ? Drawing{*triangles.mesh, round_crease} : Drawing{});
}

}  // namespace tactus
