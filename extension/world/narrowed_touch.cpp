#include "world/narrowed_touch.hpp"

#include <algorithm>
#include <functional>

#include "core/tree/triangle_tree.hpp"
#include "platform/large_pages.hpp"

namespace tactus {

namespace {

std::shared_ptr<const TouchableTriangles> freed_aside(std::shared_ptr<const TouchableTriangles> made) {
    const TouchableTriangles* const triangles = made.get();
    return {triangles, [made = std::move(made)](const TouchableTriangles*) mutable {
                Workers::discard([gone = std::move(made)] {});
            }};
}

void make(NarrowedTree& tree, const ParallelRunner& run, const StillWanted& is_wanted) {
    if (const auto narrower = narrowed(tree.whole, tree.radius, run, is_wanted)) {
        tree.touchable = freed_aside(narrower->parts.front().touchable);
        std::ranges::for_each(tree.touchable->tree->memory(), move_to_large_pages);
    }
}

// Until nobody else has held it once: whoever asks then begins anew.
class WantedByOthers {
public:
    explicit WantedByOthers(const std::shared_ptr<NarrowedTree>& tree) : tree_(tree) {}

    bool operator()() {
        if (tree_.use_count() == 1) {
            given_up_.store(true, std::memory_order_relaxed);
        }
        return !given_up_.load(std::memory_order_relaxed);
    }

private:
    const std::shared_ptr<NarrowedTree>& tree_;
    std::atomic<bool> given_up_{false};
};

}  // namespace

// One that nobody waited for is given up.
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
        WantedByOthers is_wanted(tree);
        if (is_wanted()) {
            make(*tree, run, std::ref(is_wanted));
        }
        if (is_wanted()) {
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
