#include "nodes/hand_mirrors.hpp"

#include <algorithm>
#include <array>
#include <tuple>
#include <type_traits>
#include <utility>

#include "nodes/conversions.hpp"
#include "nodes/haptic_device.hpp"
#include "nodes/haptic_effect.hpp"
#include "nodes/haptic_world.hpp"
#include "nodes/roll.hpp"
#include "nodes/signals.hpp"
#include "nodes/tree_walk.hpp"

namespace tactus {

using namespace godot;

namespace {

template <class State>
using ContactIds = std::array<std::uint64_t, std::tuple_size_v<decltype(State::bodies)>>;

template <class State>
ContactIds<State> body_ids(const State& state, const HandMirrors::NodeOf& node_of) {
    ContactIds<State> ids{};
    for (std::size_t i = 0; i < static_cast<std::size_t>(state.contact_count); ++i) {
        ids[i] = state.bodies[i] != no_handle ? node_of(state.bodies[i]) : 0;
    }
    return ids;
}

// What else than bodies it touches.
template <class Mirror>
void add_others(const ProxyState&, const std::vector<Mirror>&, ContactIds<ProxyState>&) {}

template <class Mirror>
void add_others(const ToolState& state, const std::vector<Mirror>& tools, ContactIds<ToolState>& ids) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(state.contact_count); ++i) {
        const auto other = std::ranges::find_if(tools, [&](const Mirror& tool) {
            return state.tools[i] != no_handle && tool.twin.handle() == state.tools[i];
        });
        ids[i] = other != tools.end() ? other->id : ids[i];
    }
}

// no_handle where the node has none.
template <class Mirror>
SessionHandle handle_in(const std::vector<Mirror>& mirrors, const Node* node) {
    const std::uint64_t id = node != nullptr ? node->get_instance_id() : 0;
    const auto found = std::ranges::find(mirrors, id, &Mirror::id);
    return found != mirrors.end() ? found->twin.handle() : no_handle;
}

// With the id of its body's node; 0: that is gone.
using EventNews = std::pair<TouchEvent, std::uint64_t>;

// Those that have come since, and `read` counts them.
std::vector<EventNews> events_since(const TouchEvents& events, std::uint64_t& read,
                                    const HandMirrors::NodeOf& node_of) {
    std::vector<EventNews> news;
    const std::uint64_t oldest = events.count > TouchEvents::most ? events.count - TouchEvents::most : 0;
    for (std::uint64_t i = std::max(read, oldest); i < events.count; ++i) {
        const TouchEvent& event = events.ring[i % TouchEvents::most];
        news.emplace_back(event, node_of(event.body));
    }
    read = events.count;
    return news;
}

// Tools break no surface.
template <class NodeType>
void post_event(NodeType& from, const EventNews& news) {
    const auto& [event, id] = news;
    if (id == 0) {
        return;
    }
    if (event.kind == TouchEvent::Kind::impact) {
        post_signal(from, "impact", {SignalArgument::object(id), event.speed, event.impulse});
    }
    if constexpr (std::is_same_v<NodeType, ProxyPointer>) {
        if (event.kind == TouchEvent::Kind::broken) {
            from.tell_broken(id, event.force);
        } else if (event.kind == TouchEvent::Kind::left) {
            from.tell_left(id);
        }
    }
}

// use(node, twin) for those that are there.
template <class NodeType>
void for_each_node(auto& mirrors, const auto& use) {
    for (auto& mirror : mirrors) {
        if (auto* node = node_of_id<NodeType>(mirror.id)) {
            use(*node, mirror.twin);
        }
    }
}

}  // namespace

// Those nodes of the world that have no mirror yet get one; mirrors of nodes that have gone go.
template <class NodeType, class Mirror>
void HandMirrors::match(std::vector<Mirror>& mirrors, Session& session) {
    std::erase_if(mirrors, [&](Mirror& mirror) {
        const bool is_gone = node_of_id<NodeType>(mirror.id) == nullptr;
        if (is_gone) {
            remove(mirror.twin, session);
        }
        return is_gone;
    });
    for (const NodeType* node : Roll<NodeType>::all()) {
        const bool is_known =
            std::ranges::find(mirrors, node->get_instance_id(), &Mirror::id) != mirrors.end();
        if (!is_known && HapticWorld::of(node) == &world_) {
            mirrors.push_back({node->get_instance_id(), {}});
        }
    }
}

void HandMirrors::synchronise(HapticDevice& node, DeviceTwin& twin, Session& session, Complaints& complaints,
                              bool is_stepped) {
    const std::shared_ptr<Device> port = stand_in_ != nullptr ? stand_in_ : node.port();
    if (is_stepped) {  // a script may move its target and advance without a frame between
        node.follow_target();
    }
    const SessionHandle before = twin.handle();
    const Workspace workspace = port != nullptr ? node.workspace() : Workspace{};
    const LoopPace pace{session.settings().period, !is_stepped};
    complaints.say(node, twin.synchronise(session, pace, port, workspace, retired_));
    if (before != no_handle && twin.handle() != before) {
        node.clear_state();
    }
    if (port == nullptr) {
        complaints.say(node, node.get_state_text());
    } else if (stand_in_ == nullptr) {
        complaints.say(node, node.hindrance());
    }
}

namespace {

// Those of the scene, besides its own guide.
void add_aids(const Node3D& hand, Complaints& complaints, HandAids& aids) {
    for (HapticEffect* const effect : Roll<HapticEffect>::all()) {
        if (effect->hand_node() != &hand) {
            continue;
        }
        HandEffects& effects = aids.effects;
        String without_room;
        if (const auto form = effect->closed_form(); form && effects.count == HandEffects::most) {
            without_room = "its hand has eight forces already: switch one of them off";
        } else if (form) {
            effects.items[effects.count++] = *form;
        }
        if (const auto guide = effect->placed_guide(); guide && aids.guide_count == HandAids::most_guides) {
            without_room = "its hand has four guides already: switch one of them off";
        } else if (guide) {
            aids.add(*guide);
        }
        effect->set_without_room(without_room);
        complaints.say(*effect, without_room);
    }
}

}  // namespace

void HandMirrors::synchronise(ProxyPointer& node, ProxyTwin& twin, Session& session, Complaints& complaints) {
    complaints.say(node, node.problem());
    if (node.is_kept_out()) {
        complaints.say(node,
                       "the hand began inside a body, and is not felt until it has been outside once: "
                       "move the device, or the body, so that it begins in free space");
    }
    const SessionHandle device = handle_in(devices_, node.device_node());
    ProxyDescription description = node.description(device);
    add_aids(node, complaints, description.aids);
    complaints.say(node, twin.synchronise(session, description));
}

void HandMirrors::synchronise(HapticTool& node, ToolTwin& twin, Session& session, Complaints& complaints,
                              bool waits) {
    complaints.say(node, node.problem());
    node.make_shape(waits);
    complaints.say(node, node.problem_of_shape());
    if (node.is_kept_out()) {
        complaints.say(node,
                       "it touches something where its hand begins, and is not felt until it has been where "
                       "it fits: move the device, or make the tool smaller than the room it is in");
    }
    complaints.say(node, node.hindrance());
    const SessionHandle device = handle_in(devices_, node.device_node());
    const SessionHandle before = twin.handle();
    ToolUse use = node.use(device);
    add_aids(node, complaints, use.aids);
    complaints.say(node, twin.synchronise(session, node.shape(), use));
    if (before != no_handle && twin.handle() != before) {
        node.clear_state();
    }
}

void HandMirrors::synchronise(Session& session, Complaints& complaints, bool waits) {
    const auto each = [&](auto& node, auto& twin) { synchronise(node, twin, session, complaints); };
    match<HapticDevice>(devices_, session);
    for_each_node<HapticDevice>(
        devices_, [&](auto& node, auto& twin) { synchronise(node, twin, session, complaints, waits); });
    match<ProxyPointer>(proxies_, session);
    for_each_node<ProxyPointer>(proxies_, each);
    match<HapticTool>(tools_, session);
    for_each_node<HapticTool>(
        tools_, [&](auto& node, auto& twin) { synchronise(node, twin, session, complaints, waits); });
}

void HandMirrors::forget(std::uint64_t node, Session& session) {
    forget<HapticDevice>(node, devices_, session);
    forget<ProxyPointer>(node, proxies_, session);
    forget<HapticTool>(node, tools_, session);
}

template <class NodeType, class Mirror>
void HandMirrors::forget(std::uint64_t node, std::vector<Mirror>& mirrors, Session& session) {
    const auto found = std::ranges::find(mirrors, node, &Mirror::id);
    if (found != mirrors.end()) {
        remove(found->twin, session);
        mirrors.erase(found);
        node_of_id<NodeType>(node)->clear_state();
    }
}

void HandMirrors::look_at_scene(const SceneFacts& facts, Complaints& complaints) const {
    for_each_node<ProxyPointer>(proxies_, [&](const ProxyPointer& node, const ProxyTwin&) {
        complaints.say(node, node.hindrance(facts));
    });
}

double HandMirrors::smallest_radius() const {
    double smallest = 0.0;
    for (const ProxyPointer* node : Roll<ProxyPointer>::all()) {
        if (HapticWorld::of(node) == &world_ && (smallest == 0.0 || node->get_radius() < smallest)) {
            smallest = node->get_radius();
        }
    }
    return smallest;
}

SessionHandle HandMirrors::handle_of(const Node3D* hand) const {
    const SessionHandle proxy = handle_in(proxies_, hand);
    const SessionHandle tool = proxy == no_handle ? handle_in(tools_, hand) : no_handle;
    return tool == no_handle ? proxy : hand_of_tool(tool);
}

void HandMirrors::end_contacts(std::uint64_t node) {
    const auto end = [node](auto& one, const auto&) { one.end_contact(node); };
    for_each_node<ProxyPointer>(proxies_, end);
    for_each_node<HapticTool>(tools_, end);
}

bool HandMirrors::displays_forces() const {
    bool displays = false;
    for_each_node<HapticDevice>(devices_, [&displays](const HapticDevice& node, const DeviceTwin&) {
        displays = displays || node.displays_forces();
    });
    return displays;
}

void HandMirrors::clear_forces() {
    const auto clear = [](auto& node, const auto&) { node.clear_force(); };
    for_each_node<ProxyPointer>(proxies_, clear);
    for_each_node<HapticTool>(tools_, clear);
}

void HandMirrors::release() {
    const auto clear = [](auto& node, const auto&) { node.clear_state(); };
    for_each_node<HapticDevice>(devices_, clear);
    for_each_node<ProxyPointer>(proxies_, clear);
    for_each_node<HapticTool>(tools_, clear);
    devices_.clear();
    proxies_.clear();
    tools_.clear();
}

void HandMirrors::show_devices(const SessionSnapshot& snapshot) {
    for_each_node<HapticDevice>(devices_, [&](HapticDevice& node, const DeviceTwin& twin) {
        if (const DeviceState* state = state_of(snapshot.devices, snapshot.device_count, twin.handle())) {
            node.take_state(*state);
        }
    });
}

// From copies: a node that is moved may call a script.
template <class NodeType, class State, class Mirror, std::size_t capacity>
void HandMirrors::show(std::vector<Mirror>& mirrors, const std::array<State, capacity>& states,
                       std::size_t count, std::span<const TouchEvents> events, const NodeOf& node_of) {
    struct News {
        std::uint64_t node;
        State state;
        ContactIds<State> bodies;
        std::vector<EventNews> events;
    };
    std::vector<News> all;
    for (Mirror& mirror : mirrors) {
        if (const State* state = state_of(states, count, mirror.twin.handle())) {
            all.push_back({mirror.id, *state, body_ids(*state, node_of),
                           events_since(events[state->handle], mirror.events_read, node_of)});
        }
    }
    for (News& news : all) {
        std::ranges::copy_if(news.bodies, std::back_inserter(touched_), [](auto body) { return body != 0; });
        add_others(news.state, mirrors, news.bodies);
        if (auto* node = node_of_id<NodeType>(news.node)) {
            node->take_state(news.state, news.bodies);
            for (const EventNews& event : news.events) {
                post_event(*node, event);
            }
        }
    }
}

void HandMirrors::show_pointers(const SessionSnapshot& snapshot, const NodeOf& node_of) {
    touched_.clear();
    const std::span events(snapshot.touch_events);
    show<ProxyPointer>(proxies_, snapshot.proxies, snapshot.proxy_count, events, node_of);
    show<HapticTool>(tools_, snapshot.tools, snapshot.tool_count, events.subspan(max_proxies), node_of);
}

}  // namespace tactus
