#include "world/scene_telling.hpp"

namespace tactus {

void tell(const BodyMirrors& scene, const std::vector<std::unique_ptr<WorldLink>>& links,
          const SessionSnapshot& snapshot, Nanoseconds now) {
    if (links.empty()) {
        return;
    }
    std::vector<WorldLink::Told> told;
    std::vector<const BodyMirror*> mirrors;
    for (const auto& mirror : scene.bodies()) {
        const SceneBody* const body = mirror->body();
        if (mirror->handle() != no_handle && body != nullptr && body->is_in_scene()) {
            told.push_back({mirror->handle(), mirror->twin().revision()});
            mirrors.push_back(mirror.get());
        }
    }
    std::vector<WorldLink::ToldJoint> joints;
    for (const auto& mirror : scene.joints()) {
        if (const JointTwin& twin = mirror->twin(); twin.handle() != no_handle) {
            joints.push_back(
                {twin.handle(), twin.first(), twin.second(), &twin.joined(), mirror->id(), twin.revision()});
        }
    }
    const auto describe = [&](std::size_t i) {
        return WorldLink::Description{mirrors[i]->body()->path(), mirrors[i]->twin().addition()};
    };
    const auto name = [&](std::size_t i) { return mirrors[i]->body()->path(); };
    for (const auto& link : links) {
        link->tell(told, describe, name, joints, snapshot, now);
    }
}

}  // namespace tactus
