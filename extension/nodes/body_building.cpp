#include "nodes/body_building.hpp"

#include <algorithm>
#include <glm/geometric.hpp>

#include "core/geometry/smooth_normals.hpp"
#include "nodes/conversions.hpp"
#include "physics/solid_properties.hpp"

namespace tactus {

namespace {

std::size_t triangle_count(const Shape& shape) {
    if (const auto* field = std::get_if<HeightFieldShape>(&shape)) {
        return 2 * std::size_t{field->columns} * field->rows;
    }
    const auto* hull = std::get_if<ConvexHullShape>(&shape);
    return hull != nullptr ? hull->hull->triangles.size() : 0;
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

BuiltDraft build_draft(const MeshDraft& draft, const ParallelRunner& run) {
    const BuiltMesh built = draft.source->built(draft.scaling, run);
    const bool closed = is_closed(*built.mesh);
    const bool one_sided = draft.one_sided && closed;
    BuiltDraft result{
        {draft.pose, built.tree, built.tree->center(), built.tree->radius(), nullptr, closed, one_sided},
        {MeshShape{built.mesh, draft.smooth_below, one_sided}, draft.pose}};
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

}  // namespace

std::size_t triangle_count(const BodyReading& reading) {
    std::size_t count = 0;
    for (const PlacedShape& placed : reading.shapes) {
        count += triangle_count(placed.shape);
    }
    for (const std::vector<MeshDraft>* drafts : {&reading.meshes, &reading.touched}) {
        for (const MeshDraft& draft : *drafts) {
            count += draft.source->triangle_count();
        }
    }
    return count;
}

BuiltBody build_body(const BodyPlan& plan, const ParallelRunner& run) {
    BuiltBody result;
    result.problems = plan.reading.problems;
    const std::vector<BuiltDraft> colliding = build_drafts(plan.reading.meshes, run, result.problems);
    const std::vector<BuiltDraft> touched = build_drafts(plan.reading.touched, run, result.problems);

    BodyAddition addition;
    BodyDescription& description = addition.description;
    description.shapes = plan.reading.shapes;
    for (const BuiltDraft& mesh : colliding) {
        description.shapes.push_back(mesh.shape);
    }
    auto touch = std::make_shared<TouchShape>();
    if (touched.empty() && !plan.reading.shapes.empty()) {
        const TouchShapeResult made = make_touch_shape(plan.reading.shapes, run);
        if (made.shape == nullptr) {
            result.problems.push_back(made.error);
            return result;
        }
        *touch = *made.shape;
    }
    for (const BuiltDraft& mesh : touched.empty() ? colliding : touched) {
        add_part(*touch, mesh.part);
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
    put_into(addition, plan.values);
    put_into(description, plan.makings);
    if (plan.makings.solid_of_mesh) {
        take_solid_of(touched, description);
    }
    description.pose = pose_of(plan.place);
    description.may_move = plan.may_move;
    description.linear_velocity = from_godot(plan.linear_velocity);
    description.angular_velocity = from_godot(plan.angular_velocity);
    result.body = Session::prepare_body(addition, run);
    result.addition = std::move(addition);
    return result;
}

}  // namespace tactus
