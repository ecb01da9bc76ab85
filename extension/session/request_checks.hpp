// What is wrong with what the owner of a session asks for: empty, or what to do about it.
#pragma once

#include <string>

#include "session/session_types.hpp"

namespace tactus {

// `detail` may be null.
std::string check_feel(const TouchMaterial& material, const TouchDetail* detail);
std::string check_workspace(const Workspace& workspace);
std::string check_proxy(const ProxyDescription& description);
std::string check_tool(const ToolUse& use);
// That a proxy may have (unit: meters).
bool is_proxy_radius(double radius);

}  // namespace tactus
