#include "nodes/editor_probe.hpp"

#include <cstdint>
#include <godot_cpp/classes/engine_debugger.hpp>
#include <godot_cpp/classes/resource_loader.hpp>
#include <godot_cpp/classes/scene_tree.hpp>
#include <godot_cpp/classes/window.hpp>

#include "nodes/addon_folder.hpp"
#include "nodes/tree_walk.hpp"

namespace tactus {

using namespace godot;

void show_to_editor(const Node& world) {
    static std::uint64_t there = 0;  // the probe's instance id; an id is never given twice
    if (!EngineDebugger::get_singleton()->is_active() || node_of_id<Node>(there) != nullptr) {
        return;
    }
    const String path = addon_folder().path_join("overlay/probe.gd");
    ResourceLoader* const loader = ResourceLoader::get_singleton();
    // An export may leave scripts out that no scene names.
    const Ref<Resource> script = loader->exists(path) ? loader->load(path) : Ref<Resource>();
    if (script.is_null()) {
        return;
    }
    Node* const probe = memnew(Node);
    probe->set_name("TactusProbe");
    probe->set_script(script);
    there = probe->get_instance_id();
    // The root is adding the scene just now.
    world.get_tree()->get_root()->call_deferred("add_child", probe);
}

}  // namespace tactus
