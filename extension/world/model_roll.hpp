// Where the operator is: the objects of the far side, which nodes show them, and what has become of which.
// Owner's thread only.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <unordered_map>
#include <vector>

#include "core/geometry/shape.hpp"
#include "network/messages.hpp"
#include "session/model_builder.hpp"

namespace tactus {

// What has happened to an object of the far side.
struct ModelNews {
    enum class Kind { discovered, removed, refused } kind = Kind::discovered;
    std::string name;
    std::uint64_t node = 0;  // that shows it
    std::string why;         // it was refused
};

class ModelRoll {
public:
    struct Form {
        Pose pose;
        std::vector<PlacedShape> touched;
    };
    struct Shown {
        std::uint64_t node = 0;
        bool is_picture = false;       // made for it; else it is a body of the scene
        Mat3 scaling{1.0};             // that the node keeps
        std::uint64_t changed_at = 0;  // BodyState::changed_at that is shown
        // Nodes of rigid bodies below it, parents first: physics moves each by itself.
        std::vector<std::uint64_t> carried = {};
    };
    using Show = std::function<Shown(const std::string& name, const Form& form)>;
    using Hide = std::function<void(const Shown& shown)>;
    // Whether the object of that name is still shown as it would be shown now: its node may be gone, or a
    // body of the scene may have come that shows it better than a picture.
    using IsShown = std::function<bool(const std::string& name, const Shown& shown)>;

    // Described just now, before it is built.
    void note(const ObjectDescription& description);

    // Has what is new shown and what is gone hidden; what is neither stays as it is shown. What is shown
    // anew is discovered once more, with its new node.
    std::vector<ModelNews> update(const std::vector<ModelObject>& objects, const Show& show, const Hide& hide,
                                  const IsShown& is_shown);
    void hide_all(const Hide& hide);

    std::size_t size() const { return entries_.size(); }
    SessionHandle body_of(std::uint64_t node) const;
    std::uint64_t node_of(SessionHandle body) const;  // 0: none
    Shown* shown(SessionHandle body);                 // null: none

private:
    struct Entry {
        ModelObject object;
        Shown shown;
    };

    std::unordered_map<ObjectId, Form> described_;
    std::unordered_map<ObjectId, Entry> entries_;
    std::unordered_map<SessionHandle, ObjectId> object_of_body_;
};

}  // namespace tactus
