// The triangles of one mesh, and the trees over them: read once, built once for each scale, shared by every
// body that is made of them.
//
// Threads: any; who comes second while something is built waits and shares.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "core/geometry/touch_shape.hpp"

namespace tactus {

// A mesh at one scale, ready to be touched.
struct BuiltMesh {
    std::shared_ptr<const TriangleMesh> mesh;
    std::shared_ptr<const TriangleTree> tree;
};

// Scaled, mirrored or sheared; the triangles of a mirrored mesh are turned over so that outside stays
// outside.
TriangleMesh scaled(TriangleMesh mesh, const Mat3& scaling);

class TriangleSource {
public:
    struct Checked {
        std::shared_ptr<const TriangleMesh> mesh;  // null where there is an error
        std::string error;                         // what is wrong and what to do
        // By the vertex as its owner counts them, across all surfaces: that of the mesh. Empty: the same.
        std::vector<std::uint32_t> merged = {};
    };

    // Triangles as they were read. Where there is an error, it says why there are none.
    struct Read {
        Read(TriangleMesh triangles, std::string why_none = {})
            : mesh(std::move(triangles)), error(std::move(why_none)) {}

        TriangleMesh mesh;
        std::string error;
        std::vector<std::uint32_t> merged;  // see Checked
    };

    // `read` gives the triangles, about so many, when somebody asks for them: once, on whichever thread that
    // is.
    TriangleSource(std::function<Read()> read, std::size_t triangle_count);
    explicit TriangleSource(Checked checked);  // read elsewhere

    // The same mesh with its corners elsewhere: trees that nobody touches any more are refitted, not rebuilt.
    // Before anybody else has this one.
    void succeed(const std::shared_ptr<TriangleSource>& before);

    // About, before anything is built.
    std::size_t triangle_count() const { return triangle_count_; }

    const Checked& triangles();
    // Trees that any source has built so far, and those that it has refitted in their place.
    static std::uint64_t trees_built();
    static std::uint64_t trees_refitted();

    // Of sound triangles only.
    BuiltMesh built(const Mat3& scaling, const ParallelRunner& run);

private:
    // One scale. The tree is weakly held: it lives as long as a body is made of it.
    struct Kept {
        Mat3 scaling;
        std::shared_ptr<const TriangleMesh> mesh;
        std::weak_ptr<TriangleTree> tree;
    };
    // A tree over these triangles as they were before.
    struct Former {
        Mat3 scaling;
        std::shared_ptr<const TriangleMesh> mesh;
        std::shared_ptr<TriangleTree> tree;
    };

    void take_trees_of(TriangleSource& before);
    std::shared_ptr<TriangleTree> refitted(const Mat3& scaling, const TriangleMesh& mesh,
                                           const ParallelRunner& run);

    std::function<Read()> read_;  // empty once it has been called
    std::size_t triangle_count_ = 0;
    std::recursive_mutex mutex_;  // of all below
    Checked checked_;
    std::vector<Kept> kept_;
    std::vector<Former> former_;
    std::shared_ptr<TriangleSource> before_;  // had no trees yet when this one came; null: none
};

// What one owner's triangles are read from, made anew whenever they are other ones. Its owner's thread.
class OwnSource {
public:
    OwnSource() = default;
    ~OwnSource();
    OwnSource(const OwnSource&) = delete;
    OwnSource& operator=(const OwnSource&) = delete;

    const std::shared_ptr<TriangleSource>& get() const { return now_; }  // null: to be made
    // Until it has been made anew: the one before. Null: there was none.
    const std::shared_ptr<TriangleSource>& former() const { return former_; }

    void forget();
    // The one that was there before is succeeded by whoever made this one; or here.
    void set(std::shared_ptr<TriangleSource> source);
    void succeed_by(std::shared_ptr<TriangleSource> source);

private:
    std::shared_ptr<TriangleSource> now_, former_;
};

// Sources by what they are read from: each is read by the first who asks, as long as somebody has it. One
// thread.
template <class Key>
class KnownSources {
public:
    // `former`: what the asker knows to be out of date, or null: whoever is known by the key and is not that
    // one is newer. `make` gives another one, which succeeds it.
    template <class Make>
    std::shared_ptr<TriangleSource> get(const Key& key, const std::shared_ptr<TriangleSource>& former,
                                        const Make& make) {
        std::erase_if(all_, [](const auto& entry) { return entry.second.expired(); });
        std::shared_ptr<TriangleSource> source = all_[key].lock();
        if (source == nullptr || source == former) {
            source = make();
            if (former != nullptr) {
                source->succeed(former);
            }
            all_[key] = source;
        }
        return source;
    }

private:
    std::unordered_map<Key, std::weak_ptr<TriangleSource>> all_;
};

}  // namespace tactus
