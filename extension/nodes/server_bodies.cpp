#include "nodes/server_bodies.hpp"

#include <algorithm>
#include <glm/geometric.hpp>
#include <godot_cpp/classes/physics_server3d.hpp>
#include <ranges>

#include "nodes/shape_reading.hpp"
#include "nodes/tree_walk.hpp"

namespace tactus {

using namespace godot;

namespace {

// Parts that are read in a frame for the first time.
constexpr int max_new = 32;

// Changes that wait for synchronise().
constexpr std::size_t max_told = 1024;

// In the place of a shape's number, where the id before is that of a SoftBody3D.
constexpr int soft_part_index = -2;

// Shapes of one body that physics moves.
constexpr int max_shapes = 64;

// What changes in a part besides its place is seen after so many frames; not of larger ones, whose triangles
// Godot would copy each time.
constexpr std::uint64_t frames_between_readings = 32;
constexpr std::size_t max_triangles_read_again = 5'000;

PhysicsServer3D& server() {
    return *PhysicsServer3D::get_singleton();
}

Motion motion_of(const RID& body) {
    switch (server().body_get_mode(body)) {
        case PhysicsServer3D::BODY_MODE_STATIC:
            return Motion::Static;
        case PhysicsServer3D::BODY_MODE_KINEMATIC:
            return Motion::Kinematic;
        default:
            return Motion::Dynamic;
    }
}

void read_place(ServerPart& part) {
    part.frame = frame_of(server().body_get_state(part.body, PhysicsServer3D::BODY_STATE_TRANSFORM));
    if (part.shape == ServerPart::all_shapes) {
        const Vector3 linear =
            server().body_get_state(part.body, PhysicsServer3D::BODY_STATE_LINEAR_VELOCITY);
        const Vector3 angular =
            server().body_get_state(part.body, PhysicsServer3D::BODY_STATE_ANGULAR_VELOCITY);
        part.speed = {from_godot(linear), from_godot(angular)};
    }
}

void read_shapes(ServerPart& part) {
    part.form = {};
    part.key = {{}, scaling_of(part.frame), false};
    const SceneFrame scaling{part.key.scaling};
    const bool is_one = part.shape != ServerPart::all_shapes;
    const int first = is_one ? part.shape : 0;
    const int count = is_one ? 1 : std::min(max_shapes, server().body_get_shape_count(part.body));
    for (int i = first; i < first + count; ++i) {
        const RID shape = server().body_get_shape(part.body, i);
        const SceneFrame place = frame_of(server().body_get_shape_transform(part.body, i));
        part.key.shapes.push_back({static_cast<std::uint64_t>(shape.get_id()), place});
        ShapeReading reading = read_server_shape(shape, compose(scaling, place));
        if (!reading.error.empty()) {
            part.form.problems.push_back(std::move(reading.error));
        }
        std::ranges::move(reading.shapes, std::back_inserter(part.form.shapes));
        std::ranges::move(reading.meshes, std::back_inserter(part.form.meshes));
    }
    part.form.touchable = !part.form.shapes.empty() || !part.form.meshes.empty();
}

void read_values(ServerPart& part) {
    part.values.motion = motion_of(part.body);
    part.values.surface = told_surface(part.body);
    part.values.layers = {static_cast<std::uint32_t>(server().body_get_collision_layer(part.body)),
                          static_cast<std::uint32_t>(server().body_get_collision_mask(part.body))};
    part.values.gravity_scale = told(part.body, PhysicsServer3D::BODY_PARAM_GRAVITY_SCALE);
    part.values.linear_damping = std::max(0.0, told(part.body, PhysicsServer3D::BODY_PARAM_LINEAR_DAMP));
    part.values.angular_damping = std::max(0.0, told(part.body, PhysicsServer3D::BODY_PARAM_ANGULAR_DAMP));
    if (part.values.motion == Motion::Dynamic) {
        part.makings.mass = told(part.body, PhysicsServer3D::BODY_PARAM_MASS);
    }
}

void read(ServerPart& part) {
    read_place(part);
    read_shapes(part);
    read_values(part);
}

void read_soft(ServerPart& part) {
    part.form = part.soft->form();
    part.values.layers = {part.soft->layer(), part.soft->mask()};
}

// What was read of it.
class ServerBody final : public SceneBody {
public:
    ServerBody(std::shared_ptr<const ServerPart> part, const GodotScene& scene)
        : part_(std::move(part)), scene_(scene) {}

    std::uint64_t id() const override { return part_->id; }
    bool is_there() const override { return part_->is_there; }
    bool is_in_scene() const override { return part_->is_there; }
    std::string name() const override {
        const Node* const owner = node_of_id<Node>(part_->owner);
        return owner != nullptr ? from_godot(name_of(*owner)) : "a body of the PhysicsServer3D";
    }
    std::string path() const override { return {}; }
    bool can_be_thrown() const override { return part_->shape == ServerPart::all_shapes; }
    std::uint64_t carrier() const override { return 0; }
    SceneFrame frame() const override { return part_->frame; }
    SceneSpeed speed() const override { return part_->speed; }
    BodyMakings makings(const Mat3&) const override { return part_->makings; }
    ShapeKey shape_key() const override { return part_->key; }
    BodyForm form(const Mat3&) const override { return part_->form; }
    BodyValues values(const BodyDefaults& defaults) override {
        BodyValues values = part_->values;
        values.touch = defaults.touch;
        if (part_->soft != nullptr) {
            part_->soft->soften(values.touch, part_->frame_seconds);
        } else {
            values.detail = defaults.detail;
        }
        return values;
    }

    BodyMotion true_motion() const override {
        return {pose_of(part_->frame), part_->speed.linear, part_->speed.angular};
    }
    void push(const Vec3& impulse, const Vec3& turn) override {
        server().body_apply_central_impulse(part_->body, to_godot(impulse));
        server().body_apply_torque_impulse(part_->body, to_godot(turn));
    }

    void hold_still(bool) override {}
    void listen() override {}
    void tell_of_moves(bool) override {}
    void let_go() override {}
    SceneSpeed set_speed(const SceneSpeed&) override { return part_->speed; }
    SceneFrame stand_at(const Pose&, const Mat3&) override { return part_->frame; }
    SceneFrame put_back(const SceneFrame&) override { return part_->frame; }
    void say(const std::string& problem) const override {
        const Node* const owner = node_of_id<Node>(part_->owner);
        scene_.complaints.say(owner != nullptr ? *owner : scene_.world, problem);
    }

private:
    std::shared_ptr<const ServerPart> part_;
    const GodotScene& scene_;
};

}  // namespace

// A body of the scene tree that has no mirror yet gets one in the next frame.
bool ServerBodies::is_felt(const CloseShape& shape) const {
    Object* const owner = ObjectDB::get_instance(shape.owner);
    auto* const node = Object::cast_to<Node>(owner);
    if (owner == nullptr || node == nullptr) {
        return shape.owner == 0 || owner != nullptr;
    }
    return scene_.world.is_ancestor_of(node) && !is_solid_body(node) && !is_soft_body(*node);
}

// Godot Physics finds none of them by a shape.
void ServerBodies::find_soft(double radius, const PhysicsFrame& frame) {
    std::map<std::uint64_t, std::shared_ptr<SoftSurface>> known = std::exchange(surfaces_, {});
    for (const std::uint64_t id : soft_bodies_) {
        auto* const node = node_of_id<MeshInstance3D>(id);
        if (node == nullptr || !node->is_inside_tree()) {
            continue;
        }
        std::shared_ptr<SoftSurface>& surface = surfaces_[id] = std::move(known[id]);
        if (surface == nullptr) {
            surface = std::make_shared<SoftSurface>(*node);
        } else if (!surface->is_of(*node)) {
            surface = std::make_shared<SoftSurface>(*node);
            surface->refuse(
                "a SoftBody3D is not felt whose mesh was changed in the tree, since Godot's physics keeps "
                "the one before: take it out of the tree and put it back");
        }
        if (surface->is_close(frame.hands, radius)) {
            find_soft(id, surface, frame);
        }
    }
}

void ServerBodies::find_soft(std::uint64_t owner, const std::shared_ptr<SoftSurface>& surface,
                             const PhysicsFrame& frame) {
    const auto is_of = [&](const auto& entry) { return entry.second->soft == surface; };
    const auto found = std::ranges::find_if(parts_, is_of);
    std::shared_ptr<ServerPart> part = found != parts_.end() ? found->second : std::make_shared<ServerPart>();
    part->is_there = true;
    part->frame_seconds = frame.seconds;
    if (found == parts_.end()) {
        part->id = ++last_id_;
        part->owner = owner;
        part->shape = 0;
        part->soft = surface;
        surface->come_close();
        part->frame.origin = surface->place();
        read_soft(*part);
        parts_[{owner, soft_part_index}] = std::move(part);
        has_changed_ = true;
    }
}

void ServerBodies::find(std::span<const CloseShape> close, double radius, const PhysicsFrame& frame) {
    for (const auto& part : parts_ | std::views::values) {
        part->is_there = false;
    }
    int is_new = 0;
    for (const CloseShape& shape : close) {
        if (!is_felt(shape)) {
            continue;
        }
        const int index = motion_of(shape.body) == Motion::Dynamic ? ServerPart::all_shapes : shape.index;
        std::shared_ptr<ServerPart>& part = parts_[{shape.body.get_id(), index}];
        if (part == nullptr && is_new < max_new) {
            ++is_new;
            part = std::make_shared<ServerPart>();
            part->id = ++last_id_;
            part->owner = shape.owner;
            part->body = shape.body;
            part->shape = index;
            read(*part);
        }
        if (part != nullptr) {
            part->is_there = true;
        }
    }
    find_soft(radius, frame);
    const std::size_t gone = std::erase_if(
        parts_, [](const auto& entry) { return entry.second == nullptr || !entry.second->is_there; });
    has_changed_ |= is_new > 0 || gone > 0;
}

// Whether it is made of something else than before, as far as is known now.
bool ServerBodies::read_again(ServerPart& part) const {
    const bool is_turn = (frames_ + part.id) % frames_between_readings == 0;
    if (part.soft != nullptr) {
        const bool has_moved = part.soft->read();
        if (has_moved || is_turn) {
            read_soft(part);
        }
        return has_moved || is_turn;
    }
    if (is_turn && triangle_count(part.form) <= max_triangles_read_again) {
        read(part);
        return true;
    }
    read_place(part);
    return false;
}

const ServerPart* ServerBodies::part_of(SessionHandle body) const {
    const std::uint64_t id = mirrors_.node_of(body);
    const auto found =
        std::ranges::find_if(parts_, [id](const auto& entry) { return id != 0 && entry.second->id == id; });
    return found != parts_.end() ? found->second.get() : nullptr;
}

// What the contacts of a hand have given it since the last frame, soft bodies get: each its share by the
// forces of now, or the last one where the hand has just left it.
void ServerBodies::push_soft(const ProxyState& hand, const Vec3& impulse) {
    Pressing& pressing = pressing_[hand.handle];
    if (const auto surface = pressing.surface.lock(); surface != nullptr && hand.contact_count == 0) {
        surface->push(pressing.point, impulse);
        pressing.surface.reset();
    }
    const auto forces = std::span(hand.forces).first(static_cast<std::size_t>(hand.contact_count));
    double all = 0.0;
    for (const Vec3& force : forces) {
        all += glm::length(force);
    }
    for (std::size_t i = 0; i < forces.size(); ++i) {
        const ServerPart* const part = part_of(hand.bodies[i]);
        if (part != nullptr && part->soft != nullptr) {
            part->soft->push(hand.points[i], all > 0.0 ? impulse * (glm::length(forces[i]) / all)
                                                       : impulse / static_cast<double>(forces.size()));
            pressing.surface = part->soft;
            pressing.point = hand.points[i];
        }
    }
}

// The coupling of a tool is too stiff for what is moved once a frame: it feels it, and presses nothing in.
void ServerBodies::push_soft(const PhysicsFrame& frame) {
    const SessionSnapshot& snapshot = frame.session.snapshot();
    const auto received = std::exchange(received_, snapshot.received);
    for (std::size_t i = 0; frame.keeps_time && i < snapshot.proxy_count; ++i) {
        const ProxyState& hand = snapshot.proxies[i];
        push_soft(hand, received[hand.handle] - snapshot.received[hand.handle]);
    }
}

void ServerBodies::exchange(std::span<const CloseShape> close, double radius, PhysicsFrame frame) {
    if (close.empty() && parts_.empty() && soft_bodies_.empty()) {
        return;
    }
    find(close, radius, frame);
    ++frames_;
    ids_.clear();
    std::vector<std::uint64_t>& changed = mirrors_.news()->changed;
    if (changed.size() > max_told) {  // no synchronise() took them
        changed.clear();
    }
    for (const auto& part : parts_ | std::views::values) {
        ids_.push_back(part->id);
        if (read_again(*part)) {
            changed.push_back(part->id);
        }
    }
    std::ranges::sort(ids_);
    mirrors_.news()->moved = ids_;
    frame.close = ids_;
    mirrors_.exchange(frame);
    push_soft(frame);
}

void ServerBodies::synchronise(const MirrorContext& context) {
    if (std::exchange(has_changed_, false)) {
        std::map<std::uint64_t, std::shared_ptr<ServerPart>> by_id;
        for (const auto& part : parts_ | std::views::values) {
            by_id[part->id] = part;
        }
        const auto make_body = [&](std::uint64_t id) {
            return std::make_unique<ServerBody>(by_id.at(id), scene_);
        };
        const auto make_joint = [](std::uint64_t) { return std::unique_ptr<SceneJoint>(); };
        mirrors_.match(ids_, make_body, {}, make_joint, context.session);
    }
    if (!mirrors_.bodies().empty()) {
        mirrors_.synchronise(context);
    }
}

std::uint64_t ServerBodies::owner_of(SessionHandle body) const {
    const ServerPart* const part = part_of(body);
    return part != nullptr ? part->owner : 0;
}

}  // namespace tactus
