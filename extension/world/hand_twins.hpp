// The session's twins of a scene's devices and proxies. Owner's thread only.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "session/session.hpp"

namespace tactus {

// Ports that the loop may still be using, until Session::collect() says that it has no commands any more.
using RetiredPorts = std::vector<std::shared_ptr<Device>>;

class DeviceTwin {
public:
    SessionHandle handle() const { return handle_; }

    // No port: there is nothing to read and to push. Says why the session takes no more devices; else empty.
    std::string synchronise(Session& session, const LoopPace& pace, const std::shared_ptr<Device>& port,
                            const Workspace& workspace, RetiredPorts& retired);
    void remove(Session& session, RetiredPorts& retired);

private:
    std::shared_ptr<Device> port_;
    SessionHandle handle_ = no_handle;
    Workspace sent_;
};

class ProxyTwin {
public:
    SessionHandle handle() const { return handle_; }

    // Says why the session takes no more proxies; else empty.
    std::string synchronise(Session& session, const ProxyDescription& description);
    void remove(Session& session);

private:
    SessionHandle handle_ = no_handle;
    ProxyDescription sent_;
};

class ToolTwin {
public:
    SessionHandle handle() const { return handle_; }

    // Without a shape there is none yet. Says why the session takes no more tools; else empty.
    std::string synchronise(Session& session, const std::shared_ptr<const ToolShape>& shape,
                            const ToolUse& use);
    void remove(Session& session);

private:
    std::shared_ptr<const ToolShape> shape_;
    SessionHandle handle_ = no_handle;
    ToolUse sent_;
};

// Where another hand is put in the place of the device's own.
class StandInDevice final : public Device {
public:
    DeviceSample read(Nanoseconds) override {
        DeviceSample sample;
        sample.connected = true;
        return sample;
    }
    void write(Nanoseconds, const Vec3&) override {}
};

}  // namespace tactus
