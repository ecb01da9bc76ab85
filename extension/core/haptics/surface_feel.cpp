#include "core/haptics/surface_feel.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/tree/deform_sweep.hpp"

namespace tactus {

namespace {

double pixel(const TouchImage& image, std::int64_t column, std::int64_t row) {
    const auto wrap = [](std::int64_t i, std::uint32_t count) {
        const std::int64_t rest = i % static_cast<std::int64_t>(count);
        return static_cast<std::size_t>(rest < 0 ? rest + count : rest);
    };
    return image.values[wrap(row, image.rows) * image.columns + wrap(column, image.columns)];
}

// Null where the feature is no triangle of a mesh of the body that says more of its triangles.
const ScenePart* mapped_part(const TouchScene& scene, int body, const FeatureId& feature) {
    if (feature.triangle == Hit::no_triangle || feature.part >= scene.parts().size()) {
        return nullptr;
    }
    const ScenePart& placed = scene.parts()[feature.part];
    const bool is_its_own = placed.part && static_cast<int>(placed.body) == body && placed.part->tree();
    const bool is_known = is_its_own && placed.part->surfaces &&
                          feature.triangle < placed.part->tree()->pack_count() * lane_count;
    return is_known ? &placed : nullptr;
}

}  // namespace

Feel feel_at(const TouchScene& scene, int body, const FeatureId& feature) {
    const TouchMaterial& material = scene.body(body).material;
    const TouchDetail* const detail = material.detail;
    if (!detail) {
        return {&material};
    }
    if (!detail->surfaces.empty()) {
        const ScenePart* const placed = mapped_part(scene, body, feature);
        if (placed && !placed->part->surfaces->surface.empty()) {
            const std::size_t surface =
                placed->part->surfaces->surface[placed->part->tree()->triangle_at(feature.triangle)];
            if (surface < detail->surfaces.size() && detail->surfaces[surface]) {
                return {&detail->surfaces[surface]->material, &detail->surfaces[surface]->images};
            }
        }
    }
    return {&material, &detail->images};
}

ImagePlace place_in_frame(const TouchImage& image, double size, const Vec3& point, const Vec3& normal) {
    const Vec3 extent = glm::abs(normal);
    const int along = extent.x >= extent.y && extent.x >= extent.z ? 0 : (extent.y >= extent.z ? 1 : 2);
    const int u_axis = (along + 1) % 3;
    const int v_axis = (along + 2) % 3;
    ImagePlace place;
    place.along_columns[u_axis] = image.columns / size;
    place.along_rows[v_axis] = image.rows / size;
    place.column = point[u_axis] * place.along_columns[u_axis];
    place.row = point[v_axis] * place.along_rows[v_axis];
    return place;
}

// With e = b - a, f = c - a and n = e x f, a corner's share of a point p is linear in it: that of b has the
// gradient f x n / n^2, that of c n x e / n^2. A triangle without an area has none.
ImagePlace place_by_uv(const TouchImage& image, const SurfaceMap::Corners& uv, const TriangleCorners& corners,
                       const Vec3& point) {
    const Vec3 e = corners.b - corners.a, f = corners.c - corners.a;
    const Vec3 n = glm::cross(e, f);
    const double square = glm::dot(n, n);
    const Vec3 b_along = square > 0.0 ? glm::cross(f, n) / square : Vec3(0.0);
    const Vec3 c_along = square > 0.0 ? glm::cross(n, e) / square : Vec3(0.0);
    const Vec3 from = point - corners.a;
    const auto along = [&](std::size_t axis, double pixels, double& at, Vec3& gradient) {
        const double a = uv[0][axis], b = uv[1][axis], c = uv[2][axis];
        gradient = ((b - a) * b_along + (c - a) * c_along) * pixels;
        at = a * pixels + glm::dot(gradient, from);
    };
    ImagePlace place;
    along(0, image.columns, place.column, place.along_columns);
    along(1, image.rows, place.row, place.along_rows);
    return place;
}

ImagePlace image_place(const TouchScene& scene, const Feel& feel, const TouchImage& image, int body,
                       const FeatureId& feature, const Vec3& point, const Vec3& normal) {
    const Pose& pose = scene.body(body).pose;
    const ScenePart* const placed = feel.material->by_uv ? mapped_part(scene, body, feature) : nullptr;
    if (!placed || placed->part->surfaces->uv.empty()) {
        return place_in_frame(image, feel.material->texture_size, to_local(pose, point),
                              direction_to_local(pose, normal));
    }
    const TriangleTree& tree = *placed->part->tree();
    ImagePlace place = place_by_uv(image, placed->part->surfaces->uv[tree.triangle_at(feature.triangle)],
                                   tree.corners(feature.triangle), to_local(placed->pose, point));
    place.along_columns = direction_to_parent(placed->part->pose, place.along_columns);
    place.along_rows = direction_to_parent(placed->part->pose, place.along_rows);
    return place;
}

ImageSample sample(const TouchImage& image, const ImagePlace& at, double scale) {
    const double column = std::floor(at.column);
    const double row = std::floor(at.row);
    const double s = at.column - column;
    const double t = at.row - row;
    const auto c = static_cast<std::int64_t>(column);
    const auto r = static_cast<std::int64_t>(row);
    const double h00 = pixel(image, c, r);
    const double h10 = pixel(image, c + 1, r);
    const double h01 = pixel(image, c, r + 1);
    const double h11 = pixel(image, c + 1, r + 1);
    return {scale * ((1 - t) * ((1 - s) * h00 + s * h10) + t * ((1 - s) * h01 + s * h11)),
            scale * at.along_columns * ((1 - t) * (h10 - h00) + t * (h11 - h01)) +
                scale * at.along_rows * ((1 - s) * (h01 - h00) + s * (h11 - h10))};
}

double friction_share(const TouchScene& scene, const Feel& feel, int body, const FeatureId& feature,
                      const Vec3& point, const Vec3& normal) {
    const TouchImage* const image = feel.friction();
    return image ? sample(*image, image_place(scene, feel, *image, body, feature, point, normal), 1.0).value
                 : 1.0;
}

}  // namespace tactus
