#include "world/narrowed_touch.hpp"

#include <algorithm>

#include "platform/large_pages.hpp"

namespace tactus {

namespace {

std::shared_ptr<const TouchableTriangles> freed_aside(std::shared_ptr<const TouchableTriangles> made) {
    const TouchableTriangles* const triangles = made.get();
    return {triangles, [made = std::move(made)](const TouchableTriangles*) mutable {
                Workers::discard([gone = std::move(made)] {});
            }};
}

void make(NarrowedTree& tree, const ParallelRunner& run) {
    if (const auto narrower = narrowed(tree.whole, tree.radius, run)) {
        tree.touchable = freed_aside(narrower->parts.front().touchable);
        std::ranges::for_each(tree.touchable->tree.memory(), move_to_large_pages);
    }
}

}  // namespace

// One that nobody waited for may be left undone.
std::shared_ptr<const NarrowedTree> NarrowedTrees::get(const TouchPart& part, double radius,
                                                       Workers& workers) {
    const std::pair key(part.tree(), radius);
    if (const auto known = all_.find(key); known != all_.end()) {
        constexpr long ours_and_the_workers = 2;
        const std::shared_ptr<NarrowedTree> made = known->second.lock();
        if (made != nullptr && (made->done || made.use_count() > ours_and_the_workers)) {
            return made;
        }
    }
    std::erase_if(all_, [](const auto& entry) { return entry.second.expired(); });
    const auto tree = std::make_shared<NarrowedTree>();
    tree->whole.parts.emplace_back().surface = part.surface;
    tree->radius = radius;
    all_[key] = tree;
    workers.add_later([tree, run = workers.runner_later()] {
        // Nobody else holds it: nobody waits for it any more.
        if (tree.use_count() > 1) {
            make(*tree, run);
            tree->done.store(true, std::memory_order_release);
        }
    });
    return tree;
}

void NarrowedTouch::begin(const TouchShape& touch, double radius, NarrowedTrees& trees, Workers& workers) {
    std::vector<std::shared_ptr<const NarrowedTree>> begun;
    for (const TouchPart& part : touch.parts) {
        if (part.tree() != nullptr) {
            begun.push_back(trees.get(part, radius, workers));
        }
    }
    trees_ = std::move(begun);
    radius_ = radius;
    is_under_way_ = !trees_.empty();
}

bool NarrowedTouch::is_ready() const {
    return is_under_way_ && std::ranges::all_of(trees_, [](const auto& tree) {
               return tree->done.load(std::memory_order_acquire);
           });
}

std::shared_ptr<const TouchShape> NarrowedTouch::take(const TouchShape& touch) {
    is_under_way_ = false;
    const auto is_of_use = [](const auto& tree) { return tree->touchable != nullptr; };
    if (std::ranges::none_of(trees_, is_of_use)) {
        return nullptr;
    }
    auto narrower = std::make_shared<TouchShape>(touch);
    auto tree = trees_.begin();
    for (TouchPart& part : narrower->parts) {
        if (part.tree() != nullptr) {
            part.touchable = (*tree++)->touchable;
        }
    }
    return narrower;
}

void NarrowedTouch::forget_body() {
    std::erase_if(trees_, [](const auto& tree) { return !tree->done; });
    radius_ = 0.0;
    is_under_way_ = false;
}

}  // namespace tactus
