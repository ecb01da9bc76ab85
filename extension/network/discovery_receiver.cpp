#include "network/discovery_receiver.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

namespace tactus {
namespace {

constexpr std::size_t max_removals_remembered = 65'536;

}  // namespace

DiscoveryReceiver::DiscoveryReceiver(const DiscoverySettings& settings)
    : settings_(settings), pieces_(settings.pieces_waiting), acknowledgements_(settings.pieces_waiting) {}

bool DiscoveryReceiver::put(const DiscoveryFragment& fragment, std::uint64_t packet) {
    Piece piece;
    piece.kind = Piece::Kind::fragment;
    piece.object = fragment.object;
    piece.revision = fragment.revision;
    piece.hash = fragment.hash;
    piece.total_bytes = fragment.total_bytes;
    piece.offset = fragment.offset;
    piece.size = static_cast<std::uint32_t>(fragment.bytes.size());
    piece.packet = packet;
    std::memcpy(piece.bytes.data(), fragment.bytes.data(), fragment.bytes.size());
    return pieces_.try_push(piece);
}

bool DiscoveryReceiver::put(const ObjectRemoval& removal) {
    Piece piece;
    piece.kind = Piece::Kind::removal;
    piece.object = removal.object;
    piece.revision = removal.revision;
    piece.hash = removal.hash;
    return pieces_.try_push(piece);
}

bool DiscoveryReceiver::put_restart() {
    Piece piece;
    piece.kind = Piece::Kind::restart;
    return pieces_.try_push(piece);
}

bool DiscoveryReceiver::next_acknowledgement(DiscoveryAcknowledgement& acknowledgement) {
    return acknowledgements_.try_pop(acknowledgement);
}

std::optional<DiscoveryEvent> DiscoveryReceiver::next() {
    for (std::size_t i = 0; i < settings_.pieces_waiting; ++i) {
        if (std::optional<DiscoveryEvent> event = take_read()) {
            return event;
        }
        const Piece* const piece = pieces_.front();
        if (piece == nullptr) {
            break;
        }
        std::optional<DiscoveryEvent> event = take(*piece);
        pieces_.pop();
        if (event) {
            return event;
        }
    }
    return take_read();
}

std::optional<DiscoveryEvent> DiscoveryReceiver::take(const Piece& piece) {
    ++pieces_taken_;
    switch (piece.kind) {
        case Piece::Kind::fragment:
            ++counts_.pieces;
            newest_packet_ = std::max(newest_packet_, piece.packet);
            take_fragment(piece);
            return std::nullopt;
        case Piece::Kind::removal:
            return remove(piece);
        case Piece::Kind::restart:
            break;
    }
    objects_.clear();
    removed_.clear();
    readings_.clear();
    incomplete_bytes_ = 0;
    newest_packet_ = 0;
    return DiscoveryEvent{DiscoveryEvent::Kind::restarted, no_object, {}, {}};
}

void DiscoveryReceiver::take_fragment(const Piece& piece) {
    Object* const object = object_for(piece);
    if (object == nullptr) {
        return;
    }
    if (object->progress != Progress::gathering) {
        // Complete: its acknowledgement was lost. One answer for each time that it is told.
        ++counts_.repeated;
        if (object->verdict && piece.offset + piece.size == piece.total_bytes) {
            acknowledge({piece.object, object->hash, *object->verdict});
        }
        return;
    }
    object->touched = pieces_taken_;
    const std::uint32_t number = piece.offset / max_fragment_bytes;
    if (object->pieces.contains(number)) {
        ++counts_.repeated;
        return;
    }
    if (!make_room(object)) {
        no_room_for(piece);
        return;
    }
    object->pieces[number].assign(piece.bytes.begin(), piece.bytes.begin() + piece.size);
    incomplete_bytes_ += max_fragment_bytes;
    if (object->pieces.size() == (piece.total_bytes + max_fragment_bytes - 1) / max_fragment_bytes) {
        begin_reading(piece.object, *object);
    }
}

// The object that the piece describes, begun anew where it is the first piece of a new description. Null
// where the piece is of no use.
DiscoveryReceiver::Object* DiscoveryReceiver::object_for(const Piece& piece) {
    if (is_outdated(piece)) {
        ++counts_.outdated;
        return nullptr;
    }
    const auto found = objects_.find(piece.object);
    const bool known = found != objects_.end();
    if (known && found->second.revision == piece.revision) {
        Object& object = found->second;
        if (object.hash == piece.hash && object.total_bytes == piece.total_bytes) {
            return &object;
        }
        ++counts_.wrong_hash;
        if (object.progress != Progress::gathering) {
            return nullptr;
        }
    }
    if (!known && !make_room(nullptr)) {
        no_room_for(piece);
        return nullptr;
    }
    Object& object = objects_[piece.object];
    release(object);
    object = {piece.revision, piece.hash, piece.total_bytes, Progress::gathering, {}, {}, pieces_taken_};
    return &object;
}

void DiscoveryReceiver::no_room_for(const Piece& piece) {
    ++counts_.no_room;
    if (piece.offset + piece.size == piece.total_bytes) {
        acknowledge({piece.object, piece.hash, DiscoveryVerdict::no_room});
    }
}

// For another object (null), or for a piece of `object`.
bool DiscoveryReceiver::has_room(const Object* object) const {
    if (object == nullptr) {
        return objects_.size() < settings_.max_objects;
    }
    const bool has_most = object->pieces.size() * max_fragment_bytes > settings_.max_incomplete_bytes / 2;
    const std::size_t room = settings_.max_incomplete_bytes + (has_most ? object->total_bytes : 0);
    return incomplete_bytes_ + max_fragment_bytes <= room;
}

bool DiscoveryReceiver::make_room(const Object* object) {
    while (!has_room(object)) {
        auto oldest = objects_.end();
        for (auto it = objects_.begin(); it != objects_.end(); ++it) {
            const bool may_go = it->second.progress == Progress::gathering && &it->second != object;
            if (may_go && (oldest == objects_.end() || it->second.touched < oldest->second.touched)) {
                oldest = it;
            }
        }
        if (oldest == objects_.end()) {
            return false;
        }
        release(oldest->second);
        objects_.erase(oldest);
        ++counts_.unfinished;
    }
    return true;
}

// Forgets the pieces of what is incomplete.
void DiscoveryReceiver::release(Object& object) {
    incomplete_bytes_ -= object.pieces.size() * max_fragment_bytes;
    object.pieces.clear();
}

void DiscoveryReceiver::begin_reading(ObjectId id, Object& object) {
    object.progress = Progress::reading;
    auto reading = std::make_shared<Reading>();
    reading->object = id;
    reading->revision = object.revision;
    reading->hash = object.hash;
    reading->total_bytes = object.total_bytes;
    reading->pieces = std::exchange(object.pieces, {});
    readings_.push_back(reading);
    if (run_) {
        run_([reading] { read(*reading); });
    } else {
        read(*reading);
    }
}

// On whatever thread: touches nothing but the reading.
void DiscoveryReceiver::read(Reading& reading) {
    std::vector<std::byte> bytes(reading.total_bytes);
    for (const auto& [number, piece] : reading.pieces) {
        std::memcpy(bytes.data() + number * max_fragment_bytes, piece.data(), piece.size());
    }
    if (content_hash(bytes) == reading.hash) {
        reading.result = understand(bytes, reading) ? Reading::Result::good : Reading::Result::refused;
    }
    reading.done.store(true, std::memory_order_release);
}

bool DiscoveryReceiver::understand(std::span<const std::byte> bytes, Reading& reading) {
    if (is_joint(reading.object)) {
        return decode_joint(bytes, reading.joint) == Refusal::none && reading.joint.object == reading.object;
    }
    return decode_description(bytes, reading.description) == Refusal::none &&
           reading.description.object == reading.object;
}

std::optional<DiscoveryEvent> DiscoveryReceiver::take_read() {
    while (!readings_.empty() && readings_.front()->done.load(std::memory_order_acquire)) {
        const std::shared_ptr<Reading> reading = std::move(readings_.front());
        readings_.pop_front();
        incomplete_bytes_ -= reading->pieces.size() * max_fragment_bytes;
        if (std::optional<DiscoveryEvent> event = accept(*reading)) {
            return event;
        }
    }
    return std::nullopt;
}

// Nothing where the object is described otherwise by now, or is not what it says.
std::optional<DiscoveryEvent> DiscoveryReceiver::accept(Reading& reading) {
    const auto found = objects_.find(reading.object);
    if (found == objects_.end() || found->second.progress != Progress::reading ||
        found->second.revision != reading.revision || found->second.hash != reading.hash) {
        return std::nullopt;
    }
    if (reading.result == Reading::Result::wrong_hash) {
        ++counts_.wrong_hash;
        objects_.erase(found);  // the next telling begins it again
        return std::nullopt;
    }
    found->second.progress = Progress::complete;
    if (reading.result == Reading::Result::refused) {
        ++counts_.refused;
        answer(reading.object, DiscoveryVerdict::refused);
        return std::nullopt;
    }
    DiscoveryEvent event{DiscoveryEvent::Kind::described, reading.object, std::move(reading.description),
                         reading.joint};
    event.description.touch.detail = event.description.detail.get();
    return event;
}

std::optional<DiscoveryEvent> DiscoveryReceiver::remove(const Piece& piece) {
    acknowledge({piece.object, piece.hash, DiscoveryVerdict::removed});
    if (is_outdated(piece)) {
        return std::nullopt;
    }
    if (removed_.size() >= max_removals_remembered) {
        removed_.erase(removed_.begin());
    }
    removed_[piece.object] = piece.revision;
    const auto found = objects_.find(piece.object);
    if (found == objects_.end()) {
        return std::nullopt;
    }
    release(found->second);
    objects_.erase(found);
    return DiscoveryEvent{DiscoveryEvent::Kind::removed, piece.object, {}, {}};
}

// Whether something newer is known of its object.
bool DiscoveryReceiver::is_outdated(const Piece& piece) const {
    const auto removed = removed_.find(piece.object);
    const auto known = objects_.find(piece.object);
    return (removed != removed_.end() && piece.revision <= removed->second) ||
           (known != objects_.end() && piece.revision < known->second.revision);
}

void DiscoveryReceiver::answer(ObjectId object, DiscoveryVerdict verdict) {
    const auto found = objects_.find(object);
    if (found != objects_.end() && found->second.progress == Progress::complete) {
        found->second.verdict = verdict;
        acknowledge({object, found->second.hash, verdict});
    }
}

// Where there is no room for it, the far side tells again and is answered then.
void DiscoveryReceiver::acknowledge(const DiscoveryAcknowledgement& acknowledgement) {
    acknowledgements_.try_push(acknowledgement);
}

}  // namespace tactus
