#include "nodes/hand_mirrors.hpp"

#include <algorithm>

#include "nodes/conversions.hpp"
#include "nodes/haptic_device.hpp"
#include "nodes/haptic_world.hpp"
#include "nodes/roll.hpp"
#include "nodes/tree_walk.hpp"

namespace tactus {

using namespace godot;

namespace {

ProxyPointer::BodyIds body_ids(const ProxyState& state, const HandMirrors::NodeOf& node_of) {
    ProxyPointer::BodyIds ids{};
    for (std::size_t i = 0; i < static_cast<std::size_t>(state.contact_count); ++i) {
        ids[i] = node_of(state.bodies[i]);
    }
    return ids;
}

// no_handle where the node has none.
template <class Mirrors, class NodeType>
SessionHandle handle_in(const Mirrors& mirrors, const NodeType* node) {
    const auto found = std::ranges::find_if(mirrors, [node](const auto& one) { return one.node == node; });
    return node != nullptr && found != mirrors.end() ? found->twin.handle() : no_handle;
}

// Those nodes of the world that have no mirror yet get one.
template <class NodeType, class Mirrors>
void enlist(const HapticWorld& world, Mirrors& mirrors) {
    for (NodeType* node : Roll<NodeType>::all()) {
        const bool is_known =
            std::ranges::any_of(mirrors, [node](const auto& one) { return one.node == node; });
        if (!is_known && HapticWorld::of(node) == &world) {
            mirrors.push_back({node, {}});
        }
    }
}

}  // namespace

void HandMirrors::synchronise(DeviceMirror& mirror, Session& session, Complaints& complaints) {
    HapticDevice& node = *mirror.node;
    const std::shared_ptr<Device> port = stand_in_ != nullptr ? stand_in_ : node.port();
    const SessionHandle before = mirror.twin.handle();
    const Workspace workspace = port != nullptr ? node.workspace() : Workspace{};
    complaints.say(node, mirror.twin.synchronise(session, port, workspace, retired_));
    if (before != no_handle && mirror.twin.handle() != before) {
        node.clear_state();
    }
    if (port == nullptr) {
        complaints.say(node, node.get_state_text());
    } else if (stand_in_ == nullptr) {
        complaints.say(node, node.hindrance());
    }
}

void HandMirrors::synchronise(ProxyMirror& mirror, Session& session, Complaints& complaints) {
    ProxyPointer& node = *mirror.node;
    complaints.say(node, node.problem());
    if (node.is_kept_out()) {
        complaints.say(node,
                       "the hand began inside a body, and is not felt until it has been outside once: "
                       "move the device, or the body, so that it begins in free space");
    }
    const SessionHandle device = handle_in(devices_, node.device_node());
    complaints.say(node, mirror.twin.synchronise(session, node.description(device)));
}

void HandMirrors::synchronise(Session& session, Complaints& complaints) {
    enlist<HapticDevice>(world_, devices_);
    for (DeviceMirror& device : devices_) {
        synchronise(device, session, complaints);
    }
    enlist<ProxyPointer>(world_, proxies_);
    for (ProxyMirror& proxy : proxies_) {
        synchronise(proxy, session, complaints);
    }
}

void HandMirrors::forget(HapticDevice* device, Session& session) {
    std::erase_if(devices_, [&](DeviceMirror& one) {
        if (one.node == device) {
            one.twin.remove(session, retired_);
            device->clear_state();
        }
        return one.node == device;
    });
}

void HandMirrors::forget(ProxyPointer* proxy, Session& session) {
    std::erase_if(proxies_, [&](ProxyMirror& one) {
        if (one.node == proxy) {
            one.twin.remove(session);
        }
        return one.node == proxy;
    });
}

void HandMirrors::look_at_scene(const SceneFacts& facts, Complaints& complaints) const {
    for (const ProxyMirror& proxy : proxies_) {
        complaints.say(*proxy.node, proxy.node->hindrance(facts));
    }
}

SessionHandle HandMirrors::handle_of(const ProxyPointer* proxy) const {
    return handle_in(proxies_, proxy);
}

void HandMirrors::clear_forces() {
    for (const ProxyMirror& proxy : proxies_) {
        proxy.node->clear_force();
    }
}

void HandMirrors::release() {
    for (const DeviceMirror& device : devices_) {
        device.node->clear_state();
    }
    for (const ProxyMirror& proxy : proxies_) {
        proxy.node->clear_state();
    }
    devices_.clear();
    proxies_.clear();
}

void HandMirrors::show_devices(const SessionSnapshot& snapshot) {
    for (std::size_t i = 0; i < snapshot.device_count; ++i) {
        for (const DeviceMirror& device : devices_) {
            if (device.twin.handle() == snapshot.devices[i].handle) {
                device.node->take_state(snapshot.devices[i]);
            }
        }
    }
}

// From copies: a node that is moved may call a script.
void HandMirrors::show_proxies(const SessionSnapshot& snapshot, const NodeOf& node_of) {
    struct News {
        std::uint64_t proxy;
        ProxyState state;
        ProxyPointer::BodyIds bodies;
    };
    std::vector<News> all;
    for (std::size_t i = 0; i < snapshot.proxy_count; ++i) {
        const ProxyState& state = snapshot.proxies[i];
        for (const ProxyMirror& proxy : proxies_) {
            if (proxy.twin.handle() == state.handle) {
                all.push_back({proxy.node->get_instance_id(), state, body_ids(state, node_of)});
            }
        }
    }
    touched_.clear();
    for (const News& news : all) {
        std::ranges::copy_if(news.bodies, std::back_inserter(touched_), [](auto body) { return body != 0; });
        if (auto* proxy = node_of_id<ProxyPointer>(news.proxy)) {
            proxy->take_state(news.state, news.bodies);
        }
    }
}

}  // namespace tactus
