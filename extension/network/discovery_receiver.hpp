// Puts the pieces of object descriptions together and says which objects the far side has.
//
// Threads: put(), put_restart() and next_acknowledgement() belong to the haptic thread and allocate nothing.
// All else belongs to the owner, who builds what is described, off the loop. In virtual time both may be the
// same thread.
#pragma once

#include <optional>
#include <unordered_map>
#include <vector>

#include "network/messages.hpp"
#include "realtime/spsc_ring.hpp"

namespace tactus {

struct DiscoverySettings {
    std::size_t pieces_waiting = 256;              // between haptic thread and owner; the rest is sent again
    std::size_t most_objects = 4096;               // known or incomplete at once
    std::size_t most_incomplete_bytes = 64 << 20;  // of all descriptions that are incomplete
    Nanoseconds give_up_after = 10'000'000'000;    // an incomplete one that gets no more pieces
};

struct DiscoveryEvent {
    enum class Kind : std::uint8_t {
        described,  // a new object, or a new description of a known one: build it, then call answer()
        removed,    // remove it
        restarted,  // the far side is another one: remove all of its objects
    };

    Kind kind = Kind::described;
    ObjectId object = no_object;
    ObjectDescription description;  // for `described`
};

struct DiscoveryReceiverCounts {
    std::uint64_t pieces = 0;
    std::uint64_t repeated = 0;    // pieces that had come before
    std::uint64_t wrong_hash = 0;  // complete, but not what was sent
    std::uint64_t refused = 0;     // complete, but not to be understood
    std::uint64_t no_room = 0;     // pieces of what finds no room
    std::uint64_t outdated = 0;    // pieces of an earlier description, or of a removed object
    std::uint64_t unfinished = 0;  // given up
};

class DiscoveryReceiver {
public:
    explicit DiscoveryReceiver(const DiscoverySettings& settings = {});

    // --- haptic thread

    // False where there is no room: it will come again.
    bool put(const DiscoveryFragment& fragment);
    bool put(const ObjectRemoval& removal);

    // The far side has another epoch. True once it is handed on; call it again until then, before any put().
    bool put_restart();

    bool next_acknowledgement(DiscoveryAcknowledgement& acknowledgement);

    // --- owner

    // What has happened, oldest first; nothing when all has been said. `now`: any steady clock.
    std::optional<DiscoveryEvent> next(Nanoseconds now);

    // Whether the object described last under this id could be built. The far side is told.
    void answer(ObjectId object, DiscoveryVerdict verdict);

    const DiscoveryReceiverCounts& counts() const { return counts_; }

private:
    struct Piece {
        enum class Kind : std::uint8_t { fragment, removal, restart } kind = Kind::fragment;
        ObjectId object = no_object;
        std::uint32_t revision = 0;
        ContentHash hash{};
        std::uint32_t total_bytes = 0;
        std::uint32_t offset = 0;
        std::uint32_t size = 0;
        std::array<std::byte, most_fragment_bytes> bytes;
    };

    struct Assembly {
        std::vector<std::byte> bytes;
        std::vector<bool> have;  // by piece
        std::size_t missing = 0;
        Nanoseconds touched = 0;
    };

    struct Object {
        std::uint32_t revision = 0;
        ContentHash hash{};
        std::uint32_t total_bytes = 0;
        std::optional<DiscoveryVerdict> verdict;  // empty: incomplete, or being built
        Assembly assembly;                        // empty: complete

        bool is_complete() const { return assembly.bytes.empty(); }
    };

    std::optional<DiscoveryEvent> take(const Piece& piece, Nanoseconds now);
    std::optional<DiscoveryEvent> take_fragment(const Piece& piece, Nanoseconds now);
    std::optional<DiscoveryEvent> remove(const Piece& piece);
    std::optional<DiscoveryEvent> finish(ObjectId id, Object& object);
    Object* object_for(const Piece& piece, Nanoseconds now);
    bool make_room(std::size_t bytes, Nanoseconds now);
    void begin(Object& object, const Piece& piece);
    void release(Object& object);
    bool is_outdated(const Piece& piece) const;
    void acknowledge(ObjectId object, const ContentHash& hash, DiscoveryVerdict verdict);

    DiscoverySettings settings_;
    SpscRing<Piece> pieces_;
    SpscRing<DiscoveryAcknowledgement> acknowledgements_;
    std::unordered_map<ObjectId, Object> objects_;
    // Revisions of removals: a delayed piece does not bring an object back.
    std::unordered_map<ObjectId, std::uint32_t> removed_;
    std::size_t incomplete_bytes_ = 0;
    DiscoveryReceiverCounts counts_;
};

}  // namespace tactus
