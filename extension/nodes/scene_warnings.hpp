// What every scene needs, and warnings in the editor that keep up with what they say. Main thread only.
#pragma once

#include <cstdint>
#include <godot_cpp/classes/node.hpp>
#include <godot_cpp/variant/string.hpp>
#include <string>
#include <vector>

#include "world/scene_facts.hpp"

namespace tactus {

class HapticWorld;

// The scene is open in the editor and does not play.
bool is_edited();

// Why no HapticWorld runs this node, and what to do; empty where one does, or will when the scene plays.
godot::String problem_without_world(const godot::Node& node);

// Of a world without bodies below it: what to do; empty where it needs none.
godot::String problem_of_emptiness(const HapticWorld& world);

// Why a body that is made to be felt is not, as it stands outside of every world; empty where none does.
// Joints that stand outside of the world and lead to its bodies, and what its bodies fall through; each names
// its node.
std::vector<std::string> problems_across(const HapticWorld& world);
godot::String problem_of_outside(const HapticWorld& world);

// Of a body in those layers, what of its material a tool does not feel, and what to do; empty where a tool
// feels all of them.
godot::String problem_of_tool_surfaces(const HapticWorld& world, std::uint32_t mask);

// What of a world's bodies is not transmitted to the operator, and what to do; empty where all of it is.
godot::String problem_of_transmission(const HapticWorld& world);

// The bodies below a world as they stand, whether it runs or not.
struct SceneReading {
    SceneFacts facts;
    const godot::Node* around_hand = nullptr;  // a body that holds the ball that was asked for
};
SceneReading read_scene(const HapticWorld& world, const Vec3& hand, double radius);

// In the editor: the node's warnings are asked for every half second, and shown anew when they are other
// ones. In the game: says once, when the first frames have passed, that there is no world.
void watch_warnings(godot::Node& node);

}  // namespace tactus
