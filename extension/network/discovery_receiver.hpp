// Puts the pieces of object descriptions together and says which objects the far side has.
//
// Threads: put(), put_restart() and next_acknowledgement() belong to the haptic thread and allocate nothing.
// All else belongs to the owner, who builds what is described, off the loop. Reading a description that is
// complete takes a while for a large one: `run` may do it elsewhere. In virtual time all may be the same
// thread.
//
// What a far side claims costs nothing: memory is taken for pieces that have come, and where there is no room
// for more, what has waited longest for its next piece is given up.
#pragma once

#include <atomic>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <unordered_map>
#include <vector>

#include "network/messages.hpp"
#include "realtime/spsc_ring.hpp"

namespace tactus {

struct DiscoverySettings {
    std::size_t pieces_waiting = 256;  // between haptic thread and owner; the rest is sent again
    std::size_t max_objects = 4096;    // known or incomplete at once
    // Of pieces of all descriptions that are not read yet. One that has got most of it may go on to its end.
    std::size_t max_incomplete_bytes = 6 << 20;
};

struct DiscoveryEvent {
    enum class Kind : std::uint8_t {
        described,  // a new object, or a new description of a known one: build it, then call answer()
        removed,    // remove it
        restarted,  // the far side is another one: remove all of its objects
    };

    Kind kind = Kind::described;
    ObjectId object = no_object;
    ObjectDescription description;  // for `described`, of a body
    ObjectJoint joint;              // likewise, where is_joint(object)
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
    // Does a job, now or later, on this thread or another one.
    using Run = std::function<void(std::function<void()>)>;

    explicit DiscoveryReceiver(const DiscoverySettings& settings = {});

    // --- haptic thread

    // False where there is no room: it will come again. `packet`: the sequence of the packet it came in.
    bool put(const DiscoveryFragment& fragment, std::uint64_t packet = 0);
    bool put(const ObjectRemoval& removal);

    // The far side has another epoch. True once it is handed on; call it again until then, before any put().
    bool put_restart();

    bool next_acknowledgement(DiscoveryAcknowledgement& acknowledgement);

    // --- owner

    // Who reads descriptions; the caller of next() where nobody is set.
    void set_run(Run run) { run_ = std::move(run); }

    // What has happened; nothing when all has been said. The work of a call is bounded by `pieces_waiting`.
    std::optional<DiscoveryEvent> next();

    // The newest packet of this start of the far side with a piece that next() has taken; 0: none. The far
    // side counts its objects before it describes them: a later hello has all of which a piece has been
    // taken.
    std::uint64_t newest_packet() const { return newest_packet_; }

    // Whether the object described last under this id could be built. The far side is told.
    void answer(ObjectId object, DiscoveryVerdict verdict);
    // The far side is told this, whatever was described.
    void acknowledge(const DiscoveryAcknowledgement& acknowledgement);

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
        std::uint64_t packet = 0;
        std::array<std::byte, max_fragment_bytes> bytes;
    };

    // Pieces that have come, by their number.
    using Pieces = std::unordered_map<std::uint32_t, std::vector<std::byte>>;

    enum class Progress : std::uint8_t { gathering, reading, complete };

    struct Object {
        std::uint32_t revision = 0;
        ContentHash hash{};
        std::uint32_t total_bytes = 0;
        Progress progress = Progress::gathering;
        std::optional<DiscoveryVerdict> verdict;  // complete: empty while it is being built
        Pieces pieces;                            // gathering
        std::uint64_t touched = 0;                // when the last of them came, in pieces
    };

    // A description that is being read. Shared with who does it.
    struct Reading {
        ObjectId object = no_object;
        std::uint32_t revision = 0;
        ContentHash hash{};
        std::uint32_t total_bytes = 0;
        Pieces pieces;
        enum class Result : std::uint8_t { wrong_hash, refused, good } result = Result::wrong_hash;
        ObjectDescription description;
        ObjectJoint joint;
        std::atomic<bool> done{false};
    };

    std::optional<DiscoveryEvent> take(const Piece& piece);
    void take_fragment(const Piece& piece);
    std::optional<DiscoveryEvent> remove(const Piece& piece);
    void begin_reading(ObjectId id, Object& object);
    static void read(Reading& reading);
    static bool understand(std::span<const std::byte> bytes, Reading& reading);
    std::optional<DiscoveryEvent> take_read();
    std::optional<DiscoveryEvent> accept(Reading& reading);
    Object* object_for(const Piece& piece);
    bool has_room(const Object* object) const;
    bool make_room(const Object* object);
    void no_room_for(const Piece& piece);
    void release(Object& object);
    bool is_outdated(const Piece& piece) const;

    DiscoverySettings settings_;
    SpscRing<Piece> pieces_;
    SpscRing<DiscoveryAcknowledgement> acknowledgements_;
    std::unordered_map<ObjectId, Object> objects_;
    // Revisions of removals: a delayed piece does not bring an object back.
    std::unordered_map<ObjectId, std::uint32_t> removed_;
    std::deque<std::shared_ptr<Reading>> readings_;
    std::size_t incomplete_bytes_ = 0;  // of pieces, those being read included
    std::uint64_t pieces_taken_ = 0;
    std::uint64_t newest_packet_ = 0;
    Run run_;
    DiscoveryReceiverCounts counts_;
};

}  // namespace tactus
