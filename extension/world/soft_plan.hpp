// A body that gives, as a scene describes it, and what comes of it: built once, by whoever needs it first.
#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "core/soft/soft_design.hpp"
#include "session/soft_view.hpp"
#include "world/scene_frame.hpp"
#include "world/triangle_source.hpp"

namespace tactus {

struct SoftModel;
struct SoftModelResult;

struct SoftDescription {
    enum class Form { volume, sheet };

    Form form = Form::volume;
    std::shared_ptr<TriangleSource> source;  // null where the tetrahedra are given
    std::vector<Vec3> points;
    std::vector<Tetrahedron> tetrahedra;
    SceneFrame frame;  // of all these in the body's frame, scale included
    int cells = 8;
    SoftMaterial material;
    HeldParts held;         // in the body's frame; its vertices are the source's, as its owner counts them
    double seconds = 1e-3;  // of a tick
};

class SoftPlan {
public:
    struct Built {
        std::shared_ptr<const SoftModel> model;  // null where there is an error
        std::shared_ptr<SoftView> view;          // likewise
        std::string error;                       // what is wrong and what to do
    };

    explicit SoftPlan(SoftDescription description) : description_(std::move(description)) {}

    // Any thread; who comes second waits and shares.
    Built built();
    // Nothing yet where nobody has built it, or is at it.
    Built built_so_far() const;
    // Of a frame that has drifted by turning (has_only_drifted()), too.
    bool is_for(const SceneFrame& frame, double seconds) const;

private:
    SoftModelResult make() const;

    const SoftDescription description_;
    std::mutex building_;
    mutable std::mutex mutex_;  // of all below
    Built built_;
};

}  // namespace tactus
