#include "nodes/haptic_mesh.hpp"

#include <algorithm>
#include <glm/matrix.hpp>
#include <godot_cpp/classes/array_mesh.hpp>
#include <godot_cpp/classes/collision_object3d.hpp>

#include "nodes/body_reading.hpp"
#include "nodes/conversions.hpp"
#include "nodes/haptic_world.hpp"
#include "nodes/mesh_drawing.hpp"
#include "nodes/mesh_source.hpp"
#include "nodes/messages.hpp"
#include "nodes/scene_warnings.hpp"
#include "nodes/skin_reading.hpp"
#include "realtime/workers.hpp"

namespace tactus {

using namespace godot;

namespace {

std::uint64_t change_count = 0;

}  // namespace

std::uint64_t HapticMesh::changes() {
    return change_count;
}

// Millions of triangles take longer to let go than a frame has.
HapticMesh::~HapticMesh() {
    Workers::discard([source = std::move(source_), former = std::move(former_)] {});
}

void HapticMesh::forget_triangles() {
    if (source_ != nullptr) {
        former_ = std::move(source_);
    }
    source_.reset();
    surfaces_.reset();
    ++change_count;
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

void HapticMesh::form_changed() {
    ++change_count;
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
    const bool is_of_field = mesh_.is_null() && field_.is_valid();
    if (source_ == nullptr && is_of_field) {
        source_ = field_->surface();
        former_.reset();
    }
    if (source_ != nullptr || is_following() || (mesh_.is_null() && library_mesh_.is_empty())) {
        return source_;
    }
    source_ = mesh_.is_valid()
                  ? by_mesh.get(mesh_->get_instance_id(), former_, [this] { return source_of(mesh_); })
                  : by_name.get(from_godot(library_mesh_), former_,
                                [this] { return load_library_mesh(library_mesh_); });
    former_.reset();
    return source_;
}

std::vector<std::optional<SurfaceFeel>> HapticMesh::surface_feels() const {
    std::vector<std::optional<SurfaceFeel>> feels(static_cast<std::size_t>(surface_materials_.size()));
    for (int64_t i = 0; i < surface_materials_.size(); ++i) {
        const Ref<HapticMaterial> material = surface_materials_[i];
        if (material.is_valid()) {
            feels[static_cast<std::size_t>(i)] = SurfaceFeel{material->touch(), material->images()};
        }
    }
    return feels;
}

std::vector<Ref<Resource>> HapticMesh::surface_resources() const {
    std::vector<Ref<Resource>> resources;
    for (int64_t i = 0; i < surface_materials_.size(); ++i) {
        if (const Ref<HapticMaterial> material = surface_materials_[i]; material.is_valid()) {
            resources.push_back(material);
        }
    }
    return resources;
}

// Read where somebody asks for it, and for nothing else: a mesh of one material without texture coordinates
// has none.
std::shared_ptr<const SurfaceMap> HapticMesh::surfaces(bool by_uv) const {
    const auto feels = surface_feels();
    const auto is_by_uv = [](const std::optional<SurfaceFeel>& feel) {
        return feel && feel->material.by_uv && feel->images != TouchImages();
    };
    const bool has_surfaces = std::ranges::any_of(feels, [](const auto& feel) { return feel.has_value(); });
    const bool has_uv = by_uv || std::ranges::any_of(feels, is_by_uv);
    if (mesh_.is_null() || !(has_surfaces || has_uv)) {
        return nullptr;
    }
    if (surfaces_ == nullptr || surfaces_->surface.empty() == has_surfaces ||
        surfaces_->uv.empty() == has_uv) {
        surfaces_ = surface_map_of(mesh_, has_surfaces, has_uv);
    }
    return surfaces_;
}

void HapticMesh::instance_changed() {
    set_process_internal(is_following());
    followed_.unref();
    skin_.reset();
    forget_triangles();
    follow_instance();
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
        followed_ = mesh;
        skin_ = mesh.is_valid() ? skinned_mesh_of(mesh) : nullptr;
    }
    if (skin_ == nullptr) {
        if (source_ != nullptr) {
            forget_triangles();
        }
        return;
    }
    SkinPose pose = skin_pose_of(*instance, *this);
    if (source_ != nullptr && !is_other && pose == pose_) {
        return;
    }
    pose_ = std::move(pose);
    const std::shared_ptr<TriangleSource> before = source_ != nullptr ? source_ : former_;
    source_ = source_of(skin_, pose_);
    if (before != nullptr) {
        source_->succeed(before);
    }
    former_.reset();
    ++change_count;
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
                                  surfaces(by_uv)});
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
    return is_inside_tree() && HapticWorld::above(this) == nullptr
               ? String("its body stands outside of every HapticWorld: put the body below one")
               : String();
}

String HapticMesh::problem_of_surfaces() const {
    const auto feels = surface_feels();
    if (feels.empty()) {
        return String();
    }
    if (mesh_.is_null() || static_cast<std::size_t>(mesh_->get_surface_count()) < feels.size()) {
        return "they are more than 'mesh' has surfaces: take the last ones away";
    }
    const auto map = surfaces(false);
    const bool is_by_uv = std::ranges::any_of(feels, [](const std::optional<SurfaceFeel>& feel) {
        return feel && feel->material.by_uv && feel->images != TouchImages();
    });
    const bool has_uv = map != nullptr && std::ranges::any_of(map->uv, [](const auto& corners) {
                            return corners[0] != corners[1];
                        });
    return is_by_uv && !has_uv ? "'mesh' has no texture coordinates for their images: give it some, or set "
                                 "their 'texture_mapping' to Frame"
                               : String();
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
    if (what == NOTIFICATION_ENTER_TREE) {
        set_notify_local_transform(true);
        set_process_internal(is_following());
        watch_warnings(*this);
        follow_instance();
        ++change_count;
    } else if (what == NOTIFICATION_INTERNAL_PROCESS) {
        follow_instance();
    } else if (what == NOTIFICATION_EXIT_TREE || what == NOTIFICATION_LOCAL_TRANSFORM_CHANGED) {
        ++change_count;
    }
}

void HapticMesh::_validate_property(PropertyInfo& property) const {
    if (property.name == StringName("library_mesh")) {
        property.hint_string = String(",").join(mesh_library_names());
    }
}

}  // namespace tactus
