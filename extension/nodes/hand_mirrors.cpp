#include "nodes/hand_mirrors.hpp"

#include <algorithm>

#include "nodes/conversions.hpp"
#include "nodes/haptic_device.hpp"
#include "nodes/haptic_world.hpp"
#include "nodes/roll.hpp"

namespace tactus {

using namespace godot;

namespace {

bool same(const Workspace& a, const Workspace& b) {
    return a.pose.position == b.pose.position && a.pose.rotation == b.pose.rotation && a.scale == b.scale &&
           a.force_limit == b.force_limit && a.clutch == b.clutch && a.dead_man == b.dead_man &&
           a.force_scale == b.force_scale && a.edge_speed == b.edge_speed;
}

bool same(const ProxyDescription& a, const ProxyDescription& b) {
    return a.device == b.device && a.settings.radius == b.settings.radius &&
           a.settings.mask == b.settings.mask && a.force_law == b.force_law && a.enabled == b.enabled;
}

ProxyPointer::BodyIds body_ids(const ProxyState& state, const HandMirrors::NodeOf& node_of) {
    ProxyPointer::BodyIds ids{};
    for (std::size_t i = 0; i < static_cast<std::size_t>(state.contact_count); ++i) {
        ids[i] = node_of(state.bodies[i]);
    }
    return ids;
}

}  // namespace

void HandMirrors::drop_device(DeviceLink& link, Session& session) {
    if (link.handle != no_handle) {
        session.remove_device(link.handle);
        retired_.push_back(link.port);
        link.node->clear_state();
    }
    link.handle = no_handle;
    link.port.reset();
}

void HandMirrors::connect_device(DeviceLink& link, Session& session, Complaints& complaints) {
    const std::shared_ptr<Device> port = stand_in_ != nullptr ? stand_in_ : link.node->port();
    if (port != link.port) {
        drop_device(link, session);
        link.port = port;
    }
    if (port == nullptr) {
        complaints.say(*link.node, link.node->get_state_text());
        return;
    }
    if (const String hindered = stand_in_ == nullptr ? link.node->hindrance() : String();
        !hindered.is_empty()) {
        complaints.say(*link.node, hindered);
    }
    const Workspace workspace = link.node->workspace();
    if (link.handle == no_handle) {
        const AddResult added = session.add_device(*port, workspace);
        link.handle = added.handle;
        if (link.handle == no_handle) {
            complaints.say(*link.node, to_godot(added.error));
        }
    } else if (!same(workspace, link.sent)) {
        session.set_workspace(link.handle, workspace);
    }
    link.sent = workspace;
}

void HandMirrors::synchronise_devices(Session& session, Complaints& complaints) {
    for (HapticDevice* device : Roll<HapticDevice>::all()) {
        const bool is_known = std::any_of(devices_.begin(), devices_.end(),
                                          [device](const DeviceLink& link) { return link.node == device; });
        if (!is_known && HapticWorld::of(device) == &world_) {
            devices_.push_back({device, nullptr, no_handle, {}});
        }
    }
    for (DeviceLink& link : devices_) {
        connect_device(link, session, complaints);
    }
}

SessionHandle HandMirrors::device_handle(const HapticDevice* node) const {
    const auto link = std::find_if(devices_.begin(), devices_.end(),
                                   [node](const DeviceLink& d) { return d.node == node; });
    return node != nullptr && link != devices_.end() ? link->handle : no_handle;
}

void HandMirrors::synchronise_proxies(Session& session, Complaints& complaints) {
    for (ProxyPointer* proxy : Roll<ProxyPointer>::all()) {
        const bool is_known = std::any_of(proxies_.begin(), proxies_.end(),
                                          [proxy](const ProxyLink& link) { return link.node == proxy; });
        if (!is_known && HapticWorld::of(proxy) == &world_) {
            proxies_.push_back({proxy, no_handle, {}});
        }
    }
    for (ProxyLink& link : proxies_) {
        const HapticDevice* device = link.node->device_node();
        if (const String wrong = link.node->problem(); !wrong.is_empty()) {
            complaints.say(*link.node, wrong);
        }
        if (link.node->is_kept_out()) {
            complaints.say(*link.node,
                           "the hand began inside a body, and is not felt until it has been outside once: "
                           "move the device, or the body, so that it begins in free space");
        }
        const ProxyDescription description = link.node->description(device_handle(device));
        if (link.handle == no_handle) {
            const AddResult added = session.add_proxy(description);
            link.handle = added.handle;
            if (link.handle == no_handle) {
                complaints.say(*link.node, to_godot(added.error));
            }
        } else if (!same(description, link.sent)) {
            session.set_proxy(link.handle, description);
        }
        link.sent = description;
    }
}

void HandMirrors::forget(HapticDevice* device, Session& session) {
    for (DeviceLink& link : devices_) {
        if (link.node == device) {
            drop_device(link, session);
        }
    }
    std::erase_if(devices_, [device](const DeviceLink& link) { return link.node == device; });
}

void HandMirrors::forget(ProxyPointer* proxy, Session& session) {
    for (const ProxyLink& link : proxies_) {
        if (link.node == proxy && link.handle != no_handle) {
            session.remove_proxy(link.handle);
        }
    }
    std::erase_if(proxies_, [proxy](const ProxyLink& link) { return link.node == proxy; });
}

void HandMirrors::synchronise(Session& session, Complaints& complaints) {
    synchronise_devices(session, complaints);
    synchronise_proxies(session, complaints);
}

void HandMirrors::look_at_scene(const SceneFacts& facts, Complaints& complaints) const {
    for (const ProxyLink& link : proxies_) {
        if (const String hindered = link.node->hindrance(facts); !hindered.is_empty()) {
            complaints.say(*link.node, hindered);
        }
    }
}

SessionHandle HandMirrors::handle_of(const ProxyPointer* proxy) const {
    const auto link = std::ranges::find(proxies_, proxy, &ProxyLink::node);
    return proxy != nullptr && link != proxies_.end() ? link->handle : no_handle;
}

void HandMirrors::clear_forces() {
    for (const ProxyLink& link : proxies_) {
        link.node->clear_force();
    }
}

void HandMirrors::release() {
    for (const DeviceLink& link : devices_) {
        link.node->clear_state();
    }
    for (const ProxyLink& link : proxies_) {
        link.node->clear_state();
    }
    devices_.clear();
    proxies_.clear();
}

void HandMirrors::show_devices(const SessionSnapshot& snapshot) {
    for (std::size_t i = 0; i < snapshot.device_count; ++i) {
        for (const DeviceLink& link : devices_) {
            if (link.handle == snapshot.devices[i].handle) {
                link.node->take_state(snapshot.devices[i]);
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
        for (const ProxyLink& link : proxies_) {
            if (link.handle == state.handle) {
                all.push_back({link.node->get_instance_id(), state, body_ids(state, node_of)});
            }
        }
    }
    touched_.clear();
    for (const News& news : all) {
        for (const std::uint64_t body : news.bodies) {
            if (body != 0) {
                touched_.push_back(body);
            }
        }
        if (auto* proxy = Object::cast_to<ProxyPointer>(ObjectDB::get_instance(news.proxy))) {
            proxy->take_state(news.state, news.bodies);
        }
    }
}

}  // namespace tactus
