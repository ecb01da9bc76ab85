// The devices and proxies of a scene and their twins in the session. Main thread only.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "nodes/haptic_tool.hpp"
#include "nodes/messages.hpp"
#include "nodes/proxy_pointer.hpp"
#include "session/session.hpp"
#include "world/hand_twins.hpp"

namespace tactus {

class HapticDevice;
class HapticWorld;

class HandMirrors {
public:
    // `stand_in`: what plays every device, as at a far side, where the hand is the operator's; null: each
    // its own.
    HandMirrors(const HapticWorld& world, std::shared_ptr<Device> stand_in)
        : world_(world), stand_in_(std::move(stand_in)) {}

    // `waits`: what takes time to be made is waited for.
    void synchronise(Session& session, Complaints& complaints, bool waits);
    // Says what keeps fingertips from touching this.
    void look_at_scene(const SceneFacts& facts, Complaints& complaints) const;
    // Nothing where the node is none of them.
    void forget(std::uint64_t node, Session& session);

    // The node that shows a body; 0: none.
    using NodeOf = std::function<std::uint64_t(SessionHandle)>;
    void show_devices(const SessionSnapshot& snapshot);
    // Fingertips and tools.
    void show_pointers(const SessionSnapshot& snapshot, const NodeOf& node_of);
    // Ids of what they touch, as shown last.
    const std::vector<std::uint64_t>& touched() const { return touched_; }
    // The node is about to go: those that touch it post that this has ended.
    void end_contacts(std::uint64_t node);
    void clear_forces();
    // One of the devices has motors, or may have them.
    bool displays_forces() const;
    // All of them are told that nothing runs.
    void release();

    // Of a fingertip in this world (unit: meters); 0: there is none.
    double smallest_radius() const;

    // Of a proxy, or hand_of_tool(); no_handle where there is none.
    SessionHandle handle_of(const godot::Node3D* hand) const;
    // The session has let go of what has left.
    void forget_retired() { retired_.clear(); }

private:
    struct DeviceMirror {
        std::uint64_t id = 0;  // of the node
        DeviceTwin twin;
    };
    struct ProxyMirror {
        std::uint64_t id = 0;
        ProxyTwin twin;
        std::uint64_t events_read = 0;  // see TouchEvents::count
    };
    struct ToolMirror {
        std::uint64_t id = 0;
        ToolTwin twin;
        std::uint64_t events_read = 0;
    };

    void synchronise(HapticDevice& node, DeviceTwin& twin, Session& session, Complaints& complaints,
                     bool is_stepped);
    void synchronise(ProxyPointer& node, ProxyTwin& twin, Session& session, Complaints& complaints);
    void synchronise(HapticTool& node, ToolTwin& twin, Session& session, Complaints& complaints, bool waits);
    template <class NodeType, class State, class Mirror, std::size_t capacity>
    void show(std::vector<Mirror>& mirrors, const std::array<State, capacity>& states, std::size_t count,
              std::span<const TouchEvents> events, const NodeOf& node_of);
    void remove(DeviceTwin& twin, Session& session) { twin.remove(session, retired_); }
    void remove(ProxyTwin& twin, Session& session) { twin.remove(session); }
    void remove(ToolTwin& twin, Session& session) { twin.remove(session); }
    template <class NodeType, class Mirror>
    void forget(std::uint64_t node, std::vector<Mirror>& mirrors, Session& session);
    template <class NodeType, class Mirror>
    void match(std::vector<Mirror>& mirrors, Session& session);

    const HapticWorld& world_;
    std::shared_ptr<Device> stand_in_;
    std::vector<DeviceMirror> devices_;
    std::vector<ProxyMirror> proxies_;
    std::vector<ToolMirror> tools_;
    RetiredPorts retired_;
    std::vector<std::uint64_t> touched_;
};

}  // namespace tactus
