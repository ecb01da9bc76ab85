#include "sensing/watch/observer.hpp"

#include "platform/clock.hpp"

namespace tactus {

namespace {

double seconds_now() {
    return to_seconds(monotonic_now());
}

void deproject(const DepthImage& image, std::vector<glm::vec3>& cloud) {
    cloud.clear();
    std::size_t at = 0;
    for (int v = 0; v < image.camera.height; ++v) {
        for (int u = 0; u < image.camera.width; ++u) {
            if (const std::uint16_t depth = image.depth_mm[at++]; depth != 0) {
                cloud.emplace_back(ray_through(image.camera, u, v) * (0.001 * depth));
            }
        }
    }
}

SightState state_of(SeenState state) {
    switch (state) {
        case SeenState::found:
            return SightState::found;
        case SeenState::tracked:
            return SightState::tracked;
        case SeenState::cut:
            return SightState::cut;
        case SeenState::hidden:
            return SightState::hidden;
        case SeenState::lost:
            break;
    }
    return SightState::lost;
}

}  // namespace

void Picture::point() {
    for (std::size_t i = 0; i < objects.size() && i < hulls.size(); ++i) {
        objects[i].hull = {hulls[i].vertices, hulls[i].triangles};
    }
    sight.objects = objects;
    sight.cloud = cloud;
    sight.surface = {surface.vertices, surface.triangles};
    sight.text = text.c_str();
}

void Observer::set_library(const MeshLibrary& library) {
    const LearningSettings learning;
    auto learnt = std::make_shared<std::vector<LearntMesh>>();
    indices_.clear();
    for (std::size_t i = 0; i < library.size(); ++i) {
        if (check_library_mesh(library[i], learning).empty()) {
            learnt->push_back(learn_mesh(library[i], learning));
            indices_.push_back(static_cast<std::int32_t>(i));
        }
    }
    meshes_ = std::move(learnt);
    forget();
}

void Observer::begin(const SensorSettings& settings) {
    SeeingSettings discovery;
    support_height_ = settings.knows_support ? std::optional(settings.support_height) : std::nullopt;
    if (support_height_) {
        discovery.support = WorldPlane{{0.0, 1.0, 0.0}, *support_height_};
    }
    if (meshes_ == nullptr) {
        meshes_ = std::make_shared<const std::vector<LearntMesh>>();
    }
    discovery_.emplace(meshes_, discovery);
    discovery_->time_with(seconds_now);
    told_.clear();
}

std::string Observer::look(const DepthImage& image, const SensorSettings& settings, Picture& picture) {
    const std::optional<double> height =
        settings.knows_support ? std::optional(settings.support_height) : std::nullopt;
    if (!discovery_ || height != support_height_) {
        begin(settings);
    }
    discovery_->update(image, settings.camera);
    if (!discovery_->problem().empty()) {
        for (SightedObject& object : picture.objects) {
            object.confidence *= 0.9;
        }
        return discovery_->problem();
    }
    if (settings.wants_cloud) {
        deproject(image, picture.cloud);
    } else {
        picture.cloud.clear();
    }
    if (settings.wants_surface) {
        surface_.update(image, *discovery_, settings.camera);
        picture.surface = surface_.mesh();
    } else {
        picture.surface = {};
    }
    tell(settings, picture);
    return "";
}

std::string Observer::remark() const {
    if (!discovery_) {
        return "";
    }
    std::string remark;
    if (discovery_->cut_pieces() > 0) {
        remark += "; what ends at the edge of the image is not told before it is whole";
    }
    if (discovery_->far_pieces() > 0) {
        remark += "; what is too small or too far away to be told stays unknown";
    }
    return remark;
}

void Observer::tell(const SensorSettings& settings, Picture& picture) {
    picture.sight.camera = settings.camera;
    picture.objects.clear();
    picture.hulls.clear();
    for (const SeenObject& seen : discovery_->objects()) {
        // Once told of, it is followed also where it is believed less. Of a hull nothing is claimed.
        const bool is_doubted = seen.mesh != SeenObject::no_mesh && seen.confidence < settings.min_confidence;
        if (is_doubted && !told_.contains(seen.id)) {
            continue;
        }
        told_.insert(seen.id);
        SightedObject object;
        object.id = seen.id;
        object.mesh = seen.mesh != SeenObject::no_mesh ? indices_[seen.mesh] : -1;
        object.state = state_of(seen.state);
        object.pose = seen.pose;
        object.covariance = seen.covariance;
        object.chance = seen.chance;
        object.linear_velocity = seen.linear_velocity;
        object.angular_velocity = seen.angular_velocity;
        object.rests = seen.rests;
        object.confidence = seen.confidence;
        picture.objects.push_back(object);
        picture.hulls.push_back(seen.mesh != SeenObject::no_mesh ? TriangleMesh{} : seen.hull);
    }
    SupportPlane& plane = picture.sight.plane;
    plane.is_found = discovery_->support().has_value();
    if (plane.is_found) {
        plane.normal = discovery_->support()->normal;
        plane.offset = discovery_->support()->offset;
        plane.residual = discovery_->support_residual();
    }
    picture.sight.depth_scale = discovery_->depth_scale();
    const DiscoveryTimes& times = discovery_->times();
    picture.sight.times.segmentation = times.plane + times.segmentation;
    picture.sight.times.objects = times.tracking + times.recognition;
}

}  // namespace tactus
