// The bodies that a node touches: what its contacts are, and what its signals have told of them. Main thread
// only.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <godot_cpp/core/object.hpp>
#include <godot_cpp/variant/dictionary.hpp>
#include <godot_cpp/variant/typed_array.hpp>
#include <set>
#include <utility>

#include "nodes/conversions.hpp"
#include "nodes/signals.hpp"

namespace tactus {

template <std::size_t max_contacts>
class TouchedBodies {
public:
    // Of the nodes that the bodies of a state are, in its order; zero for those that are gone.
    using Ids = std::array<std::uint64_t, max_contacts>;

    // Posts "contact_ended" and "contact_started" of `from` for what has changed.
    void take(const godot::Object& from, const Ids& ids) {
        ids_ = ids;
        std::set<std::uint64_t> now(ids.begin(), ids.end());
        now.erase(0);
        const std::set<std::uint64_t> before = std::exchange(told_, std::move(now));
        post_touch_changes(from, before, told_);
    }

    // Posts "contact_ended" for what is about to go, where it is touched.
    void end(const godot::Object& from, std::uint64_t id) {
        std::ranges::replace(ids_, id, std::uint64_t{0});
        if (told_.erase(id) != 0) {
            post_touch_changes(from, {id}, {});
        }
    }

    // Of the state that the ids were taken with.
    template <class State>
    godot::TypedArray<godot::Dictionary> contacts(const State& state) const {
        godot::TypedArray<godot::Dictionary> contacts;
        for (std::size_t i = 0; i < static_cast<std::size_t>(state.contact_count); ++i) {
            godot::Dictionary contact;
            contact["collider"] = contact["body"] = godot::ObjectDB::get_instance(ids_[i]);
            contact["position"] = contact["point"] = to_godot(state.points[i]);
            contact["normal"] = to_godot(state.normals[i]);
            contact["force"] = to_godot(state.forces[i]);
            contacts.push_back(contact);
        }
        return contacts;
    }

private:
    Ids ids_{};
    std::set<std::uint64_t> told_;
};

}  // namespace tactus
