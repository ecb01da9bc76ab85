#include "world/model_roll.hpp"

#include <utility>

namespace tactus {

void ModelRoll::note(const ObjectDescription& description) {
    described_[description.object] = {description.body.pose, description.touch_shapes.empty()
                                                                 ? description.body.shapes
                                                                 : description.touch_shapes};
}

std::vector<ModelNews> ModelRoll::update(const std::vector<ModelObject>& objects, const Show& show,
                                         const Hide& hide, const IsShown& is_shown) {
    std::vector<ModelNews> news;
    std::unordered_map<ObjectId, Entry> before = std::move(entries_);
    entries_.clear();
    object_of_body_.clear();
    for (const ModelObject& object : objects) {
        Entry entry{object, {}};
        const auto was = before.find(object.object);
        const bool is_known = was != before.end();
        if (is_known && was->second.object.name == object.name && was->second.object.body == object.body &&
            was->second.object.problem == object.problem &&
            (object.body == no_handle || is_shown(object.name, was->second.shown))) {
            entry.shown = was->second.shown;
        } else {
            if (is_known) {
                hide(was->second.shown);
            }
            const bool refused = object.body == no_handle;
            if (!refused) {
                entry.shown = show(object.name, described_[object.object]);
            }
            news.push_back({refused ? ModelNews::Kind::refused : ModelNews::Kind::discovered, object.name,
                            entry.shown.node, object.problem});
        }
        before.erase(object.object);
        if (object.body != no_handle) {
            object_of_body_[object.body] = object.object;
        }
        entries_.emplace(object.object, std::move(entry));
    }
    for (const auto& [id, gone] : before) {
        hide(gone.shown);
        described_.erase(id);
        news.push_back({ModelNews::Kind::removed, gone.object.name, 0, {}});
    }
    return news;
}

void ModelRoll::hide_all(const Hide& hide) {
    for (const auto& [id, entry] : entries_) {
        hide(entry.shown);
    }
    entries_.clear();
    object_of_body_.clear();
}

SessionHandle ModelRoll::body_of(std::uint64_t node) const {
    for (const auto& [id, entry] : entries_) {
        if (entry.shown.node == node) {
            return entry.object.body;
        }
    }
    return no_handle;
}

std::uint64_t ModelRoll::node_of(SessionHandle body) const {
    const auto object = object_of_body_.find(body);
    return object != object_of_body_.end() ? entries_.at(object->second).shown.node : 0;
}

ModelRoll::Shown* ModelRoll::shown(SessionHandle body) {
    const auto object = object_of_body_.find(body);
    return object != object_of_body_.end() ? &entries_.at(object->second).shown : nullptr;
}

}  // namespace tactus
