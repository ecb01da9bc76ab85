// What a place of a body feels like: the material of the surface it is on, and where it lies on images.
#pragma once

#include "core/haptics/contact.hpp"
#include "core/haptics/touch_scene.hpp"
#include "core/tree/triangle_pack.hpp"

namespace tactus {

struct Feel {
    const TouchMaterial* material;        // never null
    const TouchImages* images = nullptr;  // null: none

    const TouchImage* heights() const { return images ? images->heights.get() : nullptr; }
    const TouchImage* friction() const { return images ? images->friction.get() : nullptr; }
    const ForceCurve* curve() const { return images ? images->curve.get() : nullptr; }
};

// The body's own where nothing is known of the feature. Copies nothing.
Feel feel_at(const TouchScene& scene, int body, const FeatureId& feature);
inline Feel feel_at(const TouchScene& scene, const Touch& touch) {
    return feel_at(scene, touch.body, touch.feature);
}

// A place on an image, and how it changes with the place in the body.
struct ImagePlace {
    double column = 0.0, row = 0.0;            // (unit: pixels)
    Vec3 along_columns{0.0}, along_rows{0.0};  // gradients, in the body's frame (unit: pixels per meter)
};

// The image is laid onto the body along the axis of its frame that the normal is nearest to, so that no mesh
// needs texture coordinates; `size`: side of one repetition (unit: meters).
ImagePlace place_in_frame(const TouchImage& image, double size, const Vec3& point_in_body,
                          const Vec3& normal_in_body);

// By the texture coordinates of a triangle's corners.
ImagePlace place_by_uv(const TouchImage& image, const SurfaceMap::Corners& uv, const TriangleCorners& corners,
                       const Vec3& point);

// Where a point of a body's surface lies: as the mesh says where the material asks for that and the mesh
// knows, else in the body's frame.
ImagePlace image_place(const TouchScene& scene, const Feel& feel, const TouchImage& image, int body,
                       const FeatureId& feature, const Vec3& point, const Vec3& normal);

struct ImageSample {
    double value = 0.0;
    Vec3 gradient{0.0};  // along the surface, in the body's frame (unit: of the value per meter)
};

// Bilinear between pixels; `scale`: of the value that white is.
ImageSample sample(const TouchImage& image, const ImagePlace& at, double scale);

// What of its friction the surface has at the point, which is in the world as the normal is (0 to 1).
double friction_share(const TouchScene& scene, const Feel& feel, int body, const FeatureId& feature,
                      const Vec3& point, const Vec3& normal);

}  // namespace tactus
