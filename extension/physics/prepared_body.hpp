// A body ready to be handed to the loop: everything that takes time or memory has happened.
#pragma once

#include <memory>
#include <string>

#include "physics/body_description.hpp"

namespace tactus {

struct BodyRecord;  // private to physics/

// Owns a body while no world does. Made, moved and destroyed on any thread but the haptic one; the haptic
// thread only passes it on. An empty one (default, or moved from) owns nothing.
class PreparedBody {
public:
    PreparedBody();
    explicit PreparedBody(std::unique_ptr<BodyRecord> record);
    PreparedBody(std::string error);
    ~PreparedBody();
    PreparedBody(PreparedBody&&) noexcept;
    PreparedBody& operator=(PreparedBody&&) noexcept;

    bool ready() const { return record_ != nullptr; }

    // Why the description could not become a body and what to do about it; empty when ready.
    const std::string& error() const { return error_; }

private:
    friend class PhysicsWorld;
    friend PreparedBody duplicate(const PreparedBody& body);
    std::unique_ptr<BodyRecord> record_;
    std::string error_;
};

// Any thread, any time; allocates. A description that makes no sense gives a body that is not ready and says
// why.
PreparedBody prepare(const BodyDescription& description);

// A body like one that is ready and in no world, sharing its shape: for a second world. Any thread,
// allocates.
PreparedBody duplicate(const PreparedBody& body);

}  // namespace tactus
