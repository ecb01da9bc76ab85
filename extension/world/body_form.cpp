#include "world/body_form.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <utility>

#include "core/mesh/closed_mesh.hpp"
#include "core/mesh/convex_hull.hpp"
#include "core/mesh/smooth_normals.hpp"
#include "core/tree/triangle_tree.hpp"
#include "physics/least_exact_mass.hpp"
#include "physics/solid_properties.hpp"
#include "session/soft_slot.hpp"
#include "world/same_shapes.hpp"

namespace tactus {

namespace {

// To cut a volume into cells and factor its matrix takes as long as a tree over about so many triangles.
constexpr std::size_t costs_of_softness = 100'000;

std::size_t triangle_count(const Shape& shape) {
    if (const auto* field = std::get_if<HeightFieldShape>(&shape)) {
        return 2 * std::size_t{field->columns} * field->rows;
    }
    const auto* hull = std::get_if<ConvexHullShape>(&shape);
    return hull != nullptr ? hull->hull->triangles.size() : 0;
}

bool same_meshes(const std::vector<MeshDraft>& a, const std::vector<MeshDraft>& b) {
    return std::ranges::equal(a, b, [](const MeshDraft& left, const MeshDraft& right) {
        return left.source == right.source && left.scaling == right.scaling &&
               same_pose(left.pose, right.pose) && left.smooth_below == right.smooth_below &&
               left.one_sided == right.one_sided && left.surfaces == right.surfaces;
    });
}

void add_part(TouchShape& touch, TouchPart part) {
    touch.reach = std::max(touch.reach, glm::length(to_parent(part.pose, part.center)) + part.radius);
    touch.parts.push_back(std::move(part));
}

// What becomes of one mesh: how it is touched and what it is made of.
struct BuiltDraft {
    TouchPart part;
    PlacedShape shape;
};

// A mirrored mesh has its triangles turned over (see triangle_source.hpp).
std::shared_ptr<const SurfaceMap> scaled(std::shared_ptr<const SurfaceMap> map, const Mat3& scaling) {
    if (!map || map->uv.empty() || glm::determinant(scaling) > 0.0) {
        return map;
    }
    auto mirrored = std::make_shared<SurfaceMap>(*map);
    for (SurfaceMap::Corners& corners : mirrored->uv) {
        std::swap(corners[1], corners[2]);
    }
    return mirrored;
}

BuiltDraft build_draft(const MeshDraft& draft, const ParallelRunner& run) {
    const BuiltMesh built = draft.source->built(draft.scaling, run);
    const bool closed = is_closed(*built.mesh);
    const bool one_sided = draft.one_sided && closed;
    // A mesh may have changed, without saying so, between its triangles and what else was read of it.
    const bool has_map = draft.surfaces && fits(*draft.surfaces, *built.mesh);
    const auto surfaces = has_map ? scaled(draft.surfaces, draft.scaling) : nullptr;
    BuiltDraft result{{draft.pose, built.tree, built.tree->center(), built.tree->radius(), nullptr, closed,
                       one_sided, surfaces},
                      {MeshShape{built.mesh, draft.smooth_below, one_sided, surfaces}, draft.pose}};
    if (draft.smooth_below > 0.0) {
        result.part.smooth_normals = std::make_shared<const std::vector<CornerNormals>>(
            smooth_normals(*built.mesh, draft.smooth_below));
    }
    return result;
}

// The sound ones among the meshes; of the others, what is wrong.
std::vector<BuiltDraft> build_drafts(const std::vector<MeshDraft>& drafts, const ParallelRunner& run,
                                     std::vector<std::string>& problems) {
    std::vector<BuiltDraft> built;
    for (const MeshDraft& draft : drafts) {
        if (std::string problem = problem_of(draft); !problem.empty()) {
            problems.push_back(std::move(problem));
        } else {
            built.push_back(build_draft(draft, run));
            if (draft.one_sided && !built.back().part.closed) {
                problems.push_back(draft.owner +
                                   "it is touched from both sides, because its mesh has no inside: close its "
                                   "holes and turn all its triangles alike, or switch 'one_sided' off");
            }
        }
    }
    return built;
}

// Physics takes the convex hull of a mesh that moves. An open one, which has no volume, is none either.
bool is_convex(const BuiltDraft& built) {
    constexpr double as_good_as = 1.1;  // of volumes: a ball that was sampled has dents between its facets
    const TriangleMesh& mesh = *std::get<MeshShape>(built.shape.shape).mesh;
    const auto solid = solid_properties(mesh);
    const auto hull = solid_properties(convex_hull(mesh.vertices));
    return solid && hull && hull->volume <= as_good_as * solid->volume;
}

// `meshes`: of a body that moves, those that collide.
void say_hulls(const std::vector<MeshDraft>& drafts, const std::vector<BuiltDraft>& meshes,
               std::vector<std::string>& problems) {
    if (!std::ranges::all_of(meshes, is_convex)) {
        problems.push_back(
            (drafts.empty() ? std::string() : drafts.front().owner) +
            "the body moves, and so it collides with other bodies as the convex hull of its mesh: "
            "give it several convex shapes in the mesh's place; a hand feels the mesh itself");
    }
}

// Centre of mass and inertia of the touched meshes filled evenly, where the node does not give them. An open
// mesh has none: there it is that of the shapes.
void take_solid_of(const std::vector<BuiltDraft>& meshes, BodyDescription& description) {
    std::vector<SolidProperties> parts;
    for (const BuiltDraft& mesh : meshes) {
        if (const auto solid = solid_properties(mesh.shape.shape)) {
            parts.push_back(placed(*solid, mesh.shape.pose));
        }
    }
    if (parts.empty()) {
        return;
    }
    const SolidProperties whole = combined(parts);
    description.center_of_mass = description.center_of_mass.value_or(whole.centroid);
    if (!description.inertia) {
        const Mat3 inertia = inertia_about(whole, *description.center_of_mass);
        description.inertia =
            Vec3(inertia[0][0], inertia[1][1], inertia[2][2]) * (description.mass / whole.volume);
    }
}

void put_into(BodyDescription& description, const BodyMakings& makings) {
    description.mass = makings.mass;
    description.center_of_mass = makings.center_of_mass;
    description.inertia = makings.inertia == Vec3(0.0) ? std::nullopt : std::optional<Vec3>(makings.inertia);
    if (!problem_of_inertia(makings.inertia).empty()) {
        description.inertia = possible_inertia(makings.inertia);
    }
    description.continuous = makings.continuous;
    description.can_sleep = makings.can_sleep;
    for (int i = 0; i < 3; ++i) {
        description.lock_linear[i] = (makings.locks >> i & 1u) != 0;
        description.lock_angular[i] = (makings.locks >> (i + 3) & 1u) != 0;
    }
}

}  // namespace

bool same_form(const BodyForm& a, const BodyForm& b) {
    return a.problems == b.problems && same_shapes(a.shapes, b.shapes) && same_meshes(a.meshes, b.meshes) &&
           same_meshes(a.touched, b.touched) && a.soft == b.soft;
}

std::string problem_of(const MeshDraft& draft) {
    const std::string& error = draft.source->triangles().error;
    return error.empty() ? error : draft.owner + error;
}

std::vector<std::string> problems_of(const BodyForm& form) {
    std::vector<std::string> problems = form.problems;
    for (const std::vector<MeshDraft>* drafts : {&form.meshes, &form.touched}) {
        for (const MeshDraft& draft : *drafts) {
            if (std::string problem = problem_of(draft); !problem.empty()) {
                problems.push_back(std::move(problem));
            }
        }
    }
    return problems;
}

// What is no inertia at all is refused when the body is prepared.
std::string problem_of_inertia(const Vec3& inertia) {
    const bool is_one =
        std::min({inertia.x, inertia.y, inertia.z}) > 0.0 && std::isfinite(inertia.x + inertia.y + inertia.z);
    if (!is_one || is_possible_inertia(inertia)) {
        return "";
    }
    const Vec3 has = possible_inertia(inertia);
    char text[320];
    std::snprintf(
        text, sizeof text,
        "no body has the inertia %.3g, %.3g, %.3g kg m^2: it turns with %.3g, %.3g, %.3g, as a flat "
        "plate does; make the largest at most the sum of the other two, or lock its rotation axes",
        inertia.x, inertia.y, inertia.z, has.x, has.y, has.z);
    return text;
}

std::string problem_of_mass(double mass, const TouchMaterial& touch, double tick_seconds) {
    const double stiffness = touch.stiffness * std::max(1.0, touch.stiffening);
    const double least = least_exact_mass(stiffness, touch.damping, tick_seconds);
    if (mass >= least) {
        return "";
    }
    char text[160];
    std::snprintf(text, sizeof text,
                  "its mass of %.3g kg is too small for the stiffness and damping of its surface: a pushed "
                  "body gets less than the hand feels; make it at least %.3g kg",
                  mass, least);
    return text;
}

std::size_t triangle_count(const BodyForm& form) {
    std::size_t count = 0;
    for (const PlacedShape& placed : form.shapes) {
        count += triangle_count(placed.shape);
    }
    for (const std::vector<MeshDraft>* drafts : {&form.meshes, &form.touched}) {
        for (const MeshDraft& draft : *drafts) {
            count += draft.source->triangle_count();
        }
    }
    return form.soft != nullptr ? count + costs_of_softness : count;
}

namespace {

// What gives is touched by its surface alone; to others, over a link, it is a mesh.
BuiltBody build_soft_body(const BodyPlan& plan, const ParallelRunner& run) {
    BuiltBody result;
    result.problems = plan.form.problems;
    const SoftPlan::Built soft = plan.form.soft->built();
    result.buildable = soft.model != nullptr;
    if (!result.buildable) {
        result.problems.push_back(soft.error);
        return result;
    }
    BodyAddition addition;
    addition.description.shapes = {
        {MeshShape{std::make_shared<const TriangleMesh>(soft.model->surface), 0.0, soft.model->closed}, {}}};
    addition.touch = soft_touch_shape(*soft.model, run);
    addition.soft = soft.model;
    addition.soft_view = soft.view;
    put_into(addition, plan.values);
    put_into(addition.description, plan.makings);
    addition.description.pose = plan.place.pose;
    result.body = Session::prepare_body(addition, run);
    result.addition = std::move(addition);
    return result;
}

}  // namespace

BuiltBody build_body(const BodyPlan& plan, const ParallelRunner& run) {
    if (plan.form.soft != nullptr) {
        return build_soft_body(plan, run);
    }
    BuiltBody result;
    result.problems = plan.form.problems;
    const std::vector<BuiltDraft> colliding = build_drafts(plan.form.meshes, run, result.problems);
    const std::vector<BuiltDraft> touched = build_drafts(plan.form.touched, run, result.problems);

    BodyAddition addition;
    BodyDescription& description = addition.description;
    description.shapes = plan.form.shapes;
    for (const BuiltDraft& mesh : colliding) {
        description.shapes.push_back(mesh.shape);
    }
    auto touch = std::make_shared<TouchShape>();
    if (touched.empty() && !plan.form.shapes.empty()) {
        const TouchShapeResult made = make_touch_shape(plan.form.shapes, run);
        if (made.shape == nullptr) {
            result.problems.push_back(made.error);
            return result;
        }
        *touch = *made.shape;
    }
    for (const BuiltDraft& mesh : touched.empty() ? colliding : touched) {
        add_part(*touch, mesh.part);
    }
    if (plan.values.motion == Motion::Dynamic) {
        say_hulls(plan.form.meshes, colliding, result.problems);
        say_hulls(plan.form.touched, description.shapes.empty() ? touched : std::vector<BuiltDraft>(),
                  result.problems);
    }
    std::vector<PlacedShape>& touched_shapes =
        description.shapes.empty() ? description.shapes : addition.touch_shapes;
    for (const BuiltDraft& mesh : touched) {
        touched_shapes.push_back(mesh.shape);
    }
    result.buildable = !touch->parts.empty();
    if (!result.buildable) {
        return result;
    }
    addition.touch = std::move(touch);
    addition.only_touched = plan.form.only_touched;
    put_into(addition, plan.values);
    put_into(description, plan.makings);
    if (plan.makings.solid_of_mesh) {
        take_solid_of(touched, description);
    }
    if (std::string problem = problem_of_inertia(plan.makings.inertia); !problem.empty()) {
        result.problems.push_back(std::move(problem));
    }
    description.pose = plan.place.pose;
    description.may_move = plan.may_move;
    description.linear_velocity = plan.place.linear_velocity;
    description.angular_velocity = plan.place.angular_velocity;
    result.body = Session::prepare_body(addition, run);
    result.addition = std::move(addition);
    return result;
}

}  // namespace tactus
