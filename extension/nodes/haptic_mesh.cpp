#include "nodes/haptic_mesh.hpp"

#include <glm/matrix.hpp>
#include <godot_cpp/classes/array_mesh.hpp>
#include <godot_cpp/classes/collision_object3d.hpp>

#include "nodes/body_parts.hpp"
#include "nodes/body_reading.hpp"
#include "nodes/conversions.hpp"
#include "nodes/mesh_drawing.hpp"
#include "nodes/mesh_source.hpp"
#include "nodes/messages.hpp"
#include "nodes/skin_reading.hpp"

namespace tactus {

using namespace godot;

void HapticMesh::forget_triangles() {
    source_.forget();
    surfaces_.reset();
    note_part_changed();
    update_configuration_warnings();
}

void HapticMesh::mesh_changed() {
    notify_property_list_changed();
    set_process_internal(is_following());
    forget_triangles();
}

void HapticMesh::library_changed() {
    entry_.reset();
    forget_triangles();
}

const LibraryEntry& HapticMesh::entry() const {
    if (!entry_) {
        entry_ = mesh_library_entry(library_mesh_);
    }
    return *entry_;
}

// A body twice as large in each direction is eight times as heavy.
double HapticMesh::library_mass(const Mat3& body_scale) const {
    return entry().mass * std::abs(glm::determinant(body_scale * frame_of(get_transform()).axes));
}

std::shared_ptr<TriangleSource> HapticMesh::source() const {
    static KnownSources<std::uint64_t> by_mesh;
    static KnownSources<std::string> by_name;
    if (source_.get() != nullptr || is_following()) {
        return source_.get();
    }
    if (mesh_.is_valid()) {
        source_.set(
            by_mesh.get(mesh_->get_instance_id(), source_.former(), [this] { return source_of(mesh_); }));
    } else if (field_.is_valid()) {
        source_.set(field_->surface());
    } else if (!library_mesh_.is_empty()) {
        source_.set(by_name.get(from_godot(library_mesh_), source_.former(),
                                [this] { return load_library_mesh(library_mesh_); }));
    }
    return source_.get();
}

std::vector<Ref<HapticMaterial>> HapticMesh::surface_materials() const {
    std::vector<Ref<HapticMaterial>> materials;
    for (int64_t i = 0; i < surface_materials_.size(); ++i) {
        materials.push_back(Ref<HapticMaterial>(surface_materials_[i]));
    }
    return materials;
}

SurfaceFeels HapticMesh::surface_feels() const {
    SurfaceFeels feels;
    for (const Ref<HapticMaterial>& material : surface_materials()) {
        feels.push_back(material.is_valid()
                            ? std::optional(SurfaceFeel{material->touch(), material->images()})
                            : std::nullopt);
    }
    return feels;
}

// Read where somebody asks for it, and for nothing else.
std::shared_ptr<const SurfaceMap> HapticMesh::surfaces(const SurfaceFeels& feels, bool by_uv) const {
    const SurfaceParts parts = parts_for(feels, by_uv);
    if (mesh_.is_null() || parts == SurfaceParts()) {
        return nullptr;
    }
    if (surfaces_ == nullptr || parts_of(*surfaces_) != parts) {
        surfaces_ = surface_map_of(mesh_, parts);
    }
    return surfaces_;
}

void HapticMesh::instance_changed() {
    set_process_internal(is_following());
    followed_changed();
    skin_.reset();
    forget_triangles();
    follow_instance();
}

// It is read anew when it is looked at next: an engine changes a mesh by one surface after the other.
void HapticMesh::followed_changed() {
    follow_changes(*this, "_followed_changed", Variant(followed_.ptr()), Variant());
    followed_.unref();
    note_part_changed();
}

// As it is drawn in this frame. What it has been is given to workers to be put in that pose, and to bodies to
// be swept against the way there.
void HapticMesh::follow_instance() {
    if (!is_following() && followed_.is_null()) {
        return;
    }
    auto* instance = is_following() && is_inside_tree()
                         ? Object::cast_to<MeshInstance3D>(get_node_or_null(mesh_instance_))
                         : nullptr;
    const Ref<Mesh> mesh = instance != nullptr ? instance->get_mesh() : Ref<Mesh>();
    const bool is_other = mesh != followed_;
    if (is_other) {
        follow_changes(*this, "_followed_changed", Variant(followed_.ptr()), Variant(mesh.ptr()));
        followed_ = mesh;
        skin_ = mesh.is_valid() ? skinned_mesh_of(mesh) : nullptr;
    }
    if (skin_ == nullptr) {
        if (source_.get() != nullptr) {
            forget_triangles();
        }
        return;
    }
    SkinPose pose = skin_pose_of(*instance, *this);
    if (source_.get() != nullptr && !is_other && pose == pose_) {
        return;
    }
    pose_ = std::move(pose);
    source_.succeed_by(source_of(skin_, pose_));
    note_part_changed();
}

ShapeReading HapticMesh::read(const SceneFrame& body_scale, bool by_uv) const {
    ShapeReading reading;
    const std::shared_ptr<TriangleSource> triangles = source();
    if (triangles == nullptr) {
        reading.error =
            is_following() ? "there is no mesh to follow: let 'mesh_instance' lead to a MeshInstance3D that "
                             "has one"
                           : "it has no mesh: set 'mesh', 'field', 'mesh_instance', or 'library_mesh' to one "
                             "of " +
                                 from_godot(String(", ").join(mesh_library_names()));
        return reading;
    }
    const SceneFrame frame = compose(body_scale, frame_of(get_transform()));
    reading.error = problem_of_shape_frame(frame);
    if (reading.error.empty()) {
        reading.meshes.push_back({triangles,
                                  scaling_of(frame),
                                  pose_of(frame),
                                  smoothing_angle_,
                                  one_sided_,
                                  {},
                                  surfaces(surface_feels(), by_uv)});
    }
    return reading;
}

PackedStringArray HapticMesh::get_library_names() {
    return mesh_library_names();
}

Ref<Mesh> HapticMesh::create_library_mesh(const String& name) {
    const std::shared_ptr<TriangleSource> source = load_library_mesh(name);
    const TriangleSource::Checked& loaded = source->triangles();
    if (loaded.mesh == nullptr) {
        UtilityFunctions::push_error("HapticMesh: ", to_godot(loaded.error), ".");
        return Ref<Mesh>();
    }
    return drawn_mesh({*loaded.mesh});
}

String HapticMesh::problem() const {
    if (!is_solid_body(get_parent())) {
        return "it belongs to no body: make it a child of a StaticBody3D, AnimatableBody3D or RigidBody3D";
    }
    return problem_of_part(*this);
}

String HapticMesh::problem_of_surfaces() const {
    const auto feels = surface_feels();
    const auto count = mesh_.is_valid() ? static_cast<std::size_t>(mesh_->get_surface_count()) : 0;
    return to_godot(problem_of(feels, count, surfaces(feels, false).get()));
}

PackedStringArray HapticMesh::_get_configuration_warnings() const {
    PackedStringArray warnings;
    warn(warnings, "This HapticMesh is not felt", problem());
    const ShapeReading reading = read({});
    const std::string error =
        reading.meshes.empty() ? reading.error : reading.meshes.front().source->triangles().error;
    warn(warnings, "This mesh cannot be touched", to_godot(error));
    warn(warnings, "Not all 'surface_materials' are felt", problem_of_surfaces());
    if (use_library_mass_ && !is_giving_mass()) {
        warn(warnings, "This HapticMesh gives its body no mass",
             "set 'library_mesh' to a mesh to which library.json gives one and leave 'mesh' empty, or switch "
             "'use_library_mass' off");
    }
    return warnings;
}

void HapticMesh::_notification(int what) {
    keep_part(*this, what);
    if (what == NOTIFICATION_ENTER_TREE) {
        set_process_internal(is_following());
        follow_instance();
    } else if (what == NOTIFICATION_INTERNAL_PROCESS) {
        follow_instance();
    }
}

void HapticMesh::_validate_property(PropertyInfo& property) const {
    if (property.name == StringName("library_mesh")) {
        property.hint_string = String(",").join(mesh_library_names());
    }
}

}  // namespace tactus
