#include "nodes/scene_warnings.hpp"

#include <godot_cpp/classes/engine.hpp>
#include <godot_cpp/classes/joint3d.hpp>
#include <godot_cpp/classes/rigid_body3d.hpp>
#include <godot_cpp/classes/scene_tree.hpp>
#include <godot_cpp/classes/static_body3d.hpp>
#include <godot_cpp/classes/time.hpp>
#include <godot_cpp/classes/window.hpp>
#include <godot_cpp/core/object.hpp>
#include <godot_cpp/variant/callable.hpp>
#include <godot_cpp/variant/callable_method_pointer.hpp>
#include <godot_cpp/variant/packed_string_array.hpp>
#include <unordered_map>

#include "nodes/body_reading.hpp"
#include "nodes/conversions.hpp"
#include "nodes/haptic_depth_sensor.hpp"
#include "nodes/haptic_device.hpp"
#include "nodes/haptic_effect.hpp"
#include "nodes/haptic_joint_drive.hpp"
#include "nodes/haptic_material.hpp"
#include "nodes/haptic_mesh.hpp"
#include "nodes/haptic_tool.hpp"
#include "nodes/haptic_world.hpp"
#include "nodes/messages.hpp"
#include "nodes/mmt_link.hpp"
#include "nodes/proxy_pointer.hpp"
#include "nodes/tree_walk.hpp"

namespace tactus {

using namespace godot;

namespace {

// A world of many bodies takes longer to look at: so rarely that it is a hundredth of the time.
constexpr std::uint64_t max_share = 100;

constexpr std::uint64_t look_again_after = 500;  // (unit: milliseconds)

struct Watched {
    PackedStringArray said;
    std::uint64_t not_before = 0;  // (unit: milliseconds)
    bool is_told = false;          // in the game: that there is no world
};

std::unordered_map<std::uint64_t, Watched>& watched() {
    static std::unordered_map<std::uint64_t, Watched> nodes;
    return nodes;
}

void look_in_editor(Node& node, Watched& memory) {
    const PackedStringArray now = node._get_configuration_warnings();
    if (!(now == memory.said)) {
        memory.said = now;
        node.update_configuration_warnings();
    }
}

// What a running world does not say by itself.
void look_in_game(Node& node, Watched& memory) {
    if (const auto* link = Object::cast_to<MMTLink>(&node)) {
        static Complaints complaints;
        complaints.say(node, link->is_networked() ? link->problem() : String());
        complaints.say(node, link->problem_of_bodies());
        return;
    }
    const auto* mesh = Object::cast_to<HapticMesh>(&node);
    const String problem = memory.is_told    ? String()
                           : mesh != nullptr ? mesh->problem()
                                             : problem_without_world(node);
    memory.is_told = memory.is_told || mesh != nullptr;  // of many meshes, each is looked at once
    if (!problem.is_empty()) {
        memory.is_told = true;
        UtilityFunctions::push_warning(name_of(node), ": ", problem, ".");
    }
}

void look_at_all() {
    static std::uint64_t next = 0;
    const std::uint64_t now = Time::get_singleton()->get_ticks_msec();
    if (now < next) {
        return;
    }
    next = now + look_again_after;
    const bool in_editor = is_edited();
    for (auto one = watched().begin(); one != watched().end();) {
        auto* node = node_of_id<Node>(one->first);
        if (node == nullptr || !node->is_inside_tree()) {
            one = watched().erase(one);
            continue;
        }
        Watched& memory = one->second;
        if (const std::uint64_t begin = Time::get_singleton()->get_ticks_msec(); begin >= memory.not_before) {
            in_editor ? look_in_editor(*node, memory) : look_in_game(*node, memory);
            const std::uint64_t end = Time::get_singleton()->get_ticks_msec();
            memory.not_before = end + max_share * (end - begin);
        }
        ++one;
    }
}

// Every one, or only those that have a material for touch.
enum class Outside { any, made_to_be_felt };

// Below a node, or the node itself.
const Node* body_outside(const Node& top, Outside which) {
    const auto is_one = [which](const Node& node) {
        return is_solid_body(&node) &&
               (which == Outside::any ||
                Object::cast_to<HapticMaterial>(
                    material_of(*Object::cast_to<CollisionObject3D>(&node)).ptr()) != nullptr);
    };
    if (Object::cast_to<HapticWorld>(&top) != nullptr) {
        return nullptr;
    }
    const Node* found = is_one(top) ? &top : nullptr;
    const auto look = [&](const Node& node) {
        const bool is_world = Object::cast_to<HapticWorld>(&node) != nullptr;
        found = !is_world && is_one(node) ? &node : nullptr;
        return found != nullptr ? Walk::end : is_world ? Walk::past : Walk::on;
    };
    if (found == nullptr) {
        walk_below(top, look);
    }
    return found;
}

// Of the scene that the world is part of.
const Node& top_of(const HapticWorld& world) {
    if (is_edited()) {
        const Node* scene = world.get_tree()->get_edited_scene_root();
        return scene != nullptr ? *scene : world;
    }
    const Node* top = &world;
    while (top->get_parent() != nullptr && Object::cast_to<Window>(top->get_parent()) == nullptr) {
        top = top->get_parent();
    }
    return *top;
}

bool has_world(const Node& scene) {
    const auto is_world = [](const Node& node) { return Object::cast_to<HapticWorld>(&node) != nullptr; };
    return is_world(scene) || find_below(scene, is_world) != nullptr;
}

// A camera and a far side bring bodies while the scene runs; a robot has a real place in their stead, and a
// script's force and a guide are felt without any.
bool needs_no_bodies(const Node& node) {
    if (const auto* link = Object::cast_to<MMTLink>(&node)) {
        return link->is_networked() && (link->is_operator() || link->has_robots());
    }
    const auto* const pointer = Object::cast_to<ProxyPointer>(&node);
    const auto* const tool = Object::cast_to<HapticTool>(&node);
    if (Object::cast_to<HapticEffect>(&node) != nullptr || (pointer != nullptr && pointer->has_guide()) ||
        (tool != nullptr && tool->has_guide())) {
        return true;
    }
    const auto* const device = Object::cast_to<HapticDevice>(&node);
    if (device != nullptr && device->applies_force()) {
        return true;
    }
    const auto* sensor = Object::cast_to<HapticDepthSensor>(&node);
    return sensor != nullptr && sensor->makes_bodies();
}

// They touch each other.
bool has_two_tools(const Node& world) {
    int tools = 0;
    return find_below(world, [&tools](const Node& node) {
               tools += Object::cast_to<HapticTool>(&node) != nullptr ? 1 : 0;
               return tools == 2;
           }) != nullptr;
}

struct NamedProperties {
    String names;  // of properties
    String body;   // that has them; empty: none does
};

// Of the first body in those layers whose material has any.
NamedProperties find_properties(const HapticWorld& world, std::uint32_t mask,
                                std::string (HapticMaterial::*names_of)() const) {
    std::string names;
    const Node* const found = find_below(world, [&](const Node& node) {
        const auto* body = is_solid_body(&node) ? Object::cast_to<CollisionObject3D>(&node) : nullptr;
        if (body == nullptr || (body->get_collision_layer() & mask) == 0) {
            return false;
        }
        const auto* material = Object::cast_to<HapticMaterial>(material_of(*body).ptr());
        names = material != nullptr ? (material->*names_of)() : std::string();
        return !names.empty();
    });
    return found == nullptr ? NamedProperties() : NamedProperties{to_godot(names), found->get_name()};
}

}  // namespace

bool is_edited() {
    return Engine::get_singleton()->is_editor_hint();
}

String problem_without_world(const Node& node) {
    const Node* scene = is_edited() ? node.get_tree()->get_edited_scene_root() : nullptr;
    const bool is_there =
        is_edited() ? HapticWorld::above(&node) != nullptr || (scene != nullptr && has_world(*scene))
                    : HapticWorld::of(&node) != nullptr;
    return is_there ? String()
                    : String(
                          "there is no HapticWorld: put one into the scene, with this node and the bodies "
                          "below it");
}

String problem_of_outside(const HapticWorld& world) {
    const Node* outside = body_outside(top_of(world), Outside::made_to_be_felt);
    return outside == nullptr ? String()
                              : "'" + String(outside->get_name()) +
                                    "' has a HapticMaterial and is not felt, because it stands outside of "
                                    "every HapticWorld: put it below one";
}

std::vector<std::string> problems_across(const HapticWorld& world) {
    std::uint32_t fallen_on = 0;  // layers that the world's bodies would lie on
    for_each_below(world, [&fallen_on](const Node& node) {
        if (const auto* body = Object::cast_to<RigidBody3D>(&node);
            body != nullptr && !body->is_freeze_enabled()) {
            fallen_on |= body->get_collision_mask();
        }
    });
    std::vector<std::string> all;
    const auto look = [&](const Node& node) {
        const std::string name = "'" + from_godot(String(node.get_name())) + "' ";
        if (Object::cast_to<HapticWorld>(&node) != nullptr) {
            return Walk::past;
        }
        const auto* joint = Object::cast_to<Joint3D>(&node);
        for (const NodePath& path : joint != nullptr ? std::vector{joint->get_node_a(), joint->get_node_b()}
                                                     : std::vector<NodePath>()) {
            Node* const body = path.is_empty() ? nullptr : joint->get_node_or_null(path);
            if (body != nullptr && world.is_ancestor_of(body)) {
                all.push_back(name + "stands outside of the HapticWorld that moves '" +
                              from_godot(String(body->get_name())) +
                              "', and does not hold it: put the joint below that world");
                break;
            }
        }
        const auto* floor = Object::cast_to<StaticBody3D>(&node);
        if (floor != nullptr && (floor->get_collision_layer() & fallen_on) != 0) {
            all.push_back(
                name +
                "stands outside of every HapticWorld, and the world's bodies pass through it: put it "
                "below the world, or take its layer out of their masks");
        }
        return Walk::on;
    };
    if (Object::cast_to<HapticWorld>(&top_of(world)) == nullptr) {
        walk_below(top_of(world), look);
    }
    return all;
}

SceneReading read_scene(const HapticWorld& world, const Vec3& hand, double radius) {
    SceneReading scene;
    for_each_below(world, [&](Node& node) {
        if (!is_solid_body(&node)) {
            return;
        }
        auto& body = *Object::cast_to<CollisionObject3D>(&node);
        const BodyForm form = read_form(body, false);
        if (!form.touchable) {
            return;
        }
        scene.facts.add(static_cast<std::uint32_t>(body.get_collision_layer()), reach_of(form));
        if (scene.around_hand == nullptr &&
            is_inside(form, pose_of(body.get_global_transform()), hand, radius)) {
            scene.around_hand = &node;
        }
    });
    return scene;
}

String problem_of_tool_surfaces(const HapticWorld& world, std::uint32_t mask) {
    const NamedProperties unfelt = find_properties(world, mask, &HapticMaterial::unfelt_by_tools);
    return unfelt.body.is_empty() ? String()
                                  : "a tool does not feel " + unfelt.names + " of the material of '" +
                                        unfelt.body + "': use a ProxyPointer, or set them to nothing";
}

String problem_of_transmission(const HapticWorld& world) {
    if (const NamedProperties lost = find_properties(world, ~0u, &HapticMaterial::untransmitted);
        !lost.body.is_empty()) {
        return lost.names + String(" of the material of '") + lost.body +
               "' is not transmitted, and the operator feels the surface without: leave it out";
    }
    Node* const drive = find_below(world, [](const Node& node) {
        return Object::cast_to<HapticJointDrive>(&node) != nullptr &&
               Object::cast_to<Joint3D>(node.get_parent()) != nullptr;
    });
    return drive == nullptr ? String()
                            : "the drive '" + String(world.get_path_to(drive)) +
                                  "' is not transmitted, and the operator's model of its joint goes without: "
                                  "take it away";
}

String problem_of_emptiness(const HapticWorld& world) {
    if (find_below(world, needs_no_bodies) != nullptr || has_two_tools(world)) {
        return String();
    }
    const Node* outside = body_outside(top_of(world), Outside::any);
    return String("nothing in it can be touched: put bodies with collision shapes below this node") +
           (outside != nullptr
                ? "; '" + String(outside->get_name()) + "' stands outside of it and is not felt"
                : String());
}

void watch_warnings(Node& node) {
    watched()[node.get_instance_id()];
    const Callable look = callable_mp_static(&look_at_all);
    if (!node.get_tree()->is_connected("process_frame", look)) {
        node.get_tree()->connect("process_frame", look);
    }
}

}  // namespace tactus
