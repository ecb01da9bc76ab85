#include "world/triangle_source.hpp"

#include <algorithm>
#include <atomic>
#include <glm/matrix.hpp>
#include <iterator>
#include <utility>

#include "core/mesh/mesh_check.hpp"
#include "core/tree/triangle_tree.hpp"
#include "platform/large_pages.hpp"
#include "realtime/workers.hpp"

namespace tactus {

namespace {

// The tree that is touched now, the one before, on the way from which the loop may still be, and one that it
// has let go of: more would only be kept for nothing.
constexpr std::size_t max_former_trees = 3;

std::atomic<std::uint64_t> build_count{0};
std::atomic<std::uint64_t> refit_count{0};

}  // namespace

TriangleMesh scaled(TriangleMesh mesh, const Mat3& scaling) {
    for (Vec3& vertex : mesh.vertices) {
        vertex = scaling * vertex;
    }
    if (glm::determinant(scaling) < 0.0) {
        for (auto& triangle : mesh.triangles) {
            std::swap(triangle[1], triangle[2]);
        }
    }
    return mesh;
}

TriangleSource::TriangleSource(std::function<Read()> read, std::size_t triangle_count)
    : read_(std::move(read)), triangle_count_(triangle_count) {}

TriangleSource::TriangleSource(Checked checked) : checked_(std::move(checked)) {
    triangle_count_ = checked_.mesh != nullptr ? checked_.mesh->triangles.size() : 0;
}

// One that is not built yet has its trees later: they are asked for when this one is built. Whom it waits for
// itself does as well.
void TriangleSource::succeed(const std::shared_ptr<TriangleSource>& before) {
    const std::unique_lock lock(before->mutex_, std::try_to_lock);
    if (lock.owns_lock()) {
        take_trees_of(*before);
    }
    if (former_.empty()) {
        before_ = lock.owns_lock() && before->before_ != nullptr ? before->before_ : before;
    }
}

// Whose lock is held. What it has been built from it may still need.
void TriangleSource::take_trees_of(TriangleSource& before) {
    std::vector<Former> former = before.former_;
    for (const Kept& kept : before.kept_) {
        if (std::shared_ptr<TriangleTree> tree = kept.tree.lock()) {
            former.push_back({kept.scaling, kept.mesh, std::move(tree)});
            before.former_.clear();
        }
    }
    former_.insert(former_.begin(), std::make_move_iterator(former.begin()),
                   std::make_move_iterator(former.end()));
    if (former_.size() > max_former_trees) {
        former_.erase(former_.begin(), former_.end() - max_former_trees);
    }
}

const TriangleSource::Checked& TriangleSource::triangles() {
    const std::lock_guard lock(mutex_);
    if (const auto ask = std::exchange(read_, nullptr)) {
        Read read = ask();
        const auto mesh = Workers::freed_aside(std::move(read.mesh));
        checked_.merged = std::move(read.merged);
        checked_.error = read.error.empty() ? check_mesh(*mesh) : std::move(read.error);
        checked_.mesh = checked_.error.empty() ? mesh : nullptr;
    }
    return checked_;
}

// Where the corners alone have moved, the tree keeps its form. One that only we hold is of no body any more
// and serves again; else a new one is made beside it, and bodies are swept along the way from one to the
// other.
std::shared_ptr<TriangleTree> TriangleSource::refitted(const Mat3& scaling, const TriangleMesh& mesh,
                                                       const ParallelRunner& run) {
    std::erase_if(former_, [&](const Former& former) {
        return former.scaling == scaling && (former.mesh->vertices.size() != mesh.vertices.size() ||
                                             former.mesh->triangles != mesh.triangles);
    });
    const auto is_like = [&](const Former& former) { return former.scaling == scaling; };
    const auto free = std::ranges::find_if(
        former_, [&](const Former& former) { return is_like(former) && former.tree.use_count() == 1; });
    if (free == former_.end()) {
        const auto touched = std::ranges::find_if(former_, is_like);
        return touched == former_.end() ? nullptr
                                        : std::make_shared<TriangleTree>(touched->tree->refitted(mesh, run));
    }
    std::atomic_thread_fence(std::memory_order_acquire);  // use_count() is relaxed
    std::shared_ptr<TriangleTree> tree = std::move(free->tree);
    former_.erase(free);
    tree->refit(mesh, run);
    return tree;
}

std::uint64_t TriangleSource::trees_built() {
    return build_count.load(std::memory_order_relaxed);
}

std::uint64_t TriangleSource::trees_refitted() {
    return refit_count.load(std::memory_order_relaxed);
}

BuiltMesh TriangleSource::built(const Mat3& scaling, const ParallelRunner& run) {
    std::shared_ptr<TriangleSource> before;  // ends after its lock
    const std::lock_guard lock(mutex_);
    while ((before = std::exchange(before_, nullptr)) != nullptr) {
        const std::lock_guard lock_of_before(before->mutex_);
        take_trees_of(*before);
        before_ = former_.empty() ? before->before_ : nullptr;
    }
    std::erase_if(kept_, [](const Kept& kept) { return kept.tree.expired(); });
    for (const Kept& kept : kept_) {
        if (std::shared_ptr<TriangleTree> tree = kept.tree.lock();
            tree != nullptr && kept.scaling == scaling) {
            return {kept.mesh, std::move(tree)};
        }
    }
    const std::shared_ptr<const TriangleMesh> whole = triangles().mesh;
    const auto mesh = scaling == Mat3(1.0) ? whole : Workers::freed_aside(scaled(*whole, scaling));
    std::shared_ptr<TriangleTree> tree = refitted(scaling, *mesh, run);
    (tree != nullptr ? refit_count : build_count).fetch_add(1, std::memory_order_relaxed);
    if (tree == nullptr) {
        tree = Workers::freed_aside(TriangleTree::build(*mesh, run));
        std::ranges::for_each(tree->memory(), move_to_large_pages);
    }
    kept_.push_back({scaling, mesh, tree});
    return {mesh, std::move(tree)};
}

// Millions of triangles take longer to let go than a frame has.
OwnSource::~OwnSource() {
    Workers::discard([now = std::move(now_), former = std::move(former_)] {});
}

void OwnSource::forget() {
    if (now_ != nullptr) {
        former_ = std::exchange(now_, nullptr);
    }
}

void OwnSource::set(std::shared_ptr<TriangleSource> source) {
    now_ = std::move(source);
    former_.reset();
}

void OwnSource::succeed_by(std::shared_ptr<TriangleSource> source) {
    const std::shared_ptr<TriangleSource>& before = now_ != nullptr ? now_ : former_;
    if (before != nullptr) {
        source->succeed(before);
    }
    set(std::move(source));
}

}  // namespace tactus
