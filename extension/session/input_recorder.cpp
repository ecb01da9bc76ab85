#include "session/input_recorder.hpp"

#include <algorithm>

#include "core/geometry/touch_shape.hpp"
#include "core/soft/soft_model.hpp"
#include "core/tree/triangle_tree.hpp"

namespace tactus {

call::Form call::Form::of(const ReadyBody& body) {
    const BodyAddition& source = body.source;
    Form form{source.description, source.touch_shapes, source.touch_material, source.detail, {}, nullptr,
              source.only_touched};
    if (source.soft) {
        form.soft = {source.soft, &source.soft->design};
        return form;
    }
    for (const TouchPart& part : body.touch->parts) {
        form.lineages.push_back(part.tree() != nullptr ? part.tree()->lineage() : 0);
    }
    return form;
}

// Between a side and its link, and beside its port.
class InputRecorder::LinkTap final : public Link, public PortTap {
public:
    LinkTap(InputRecorder& recorder, std::uint32_t number, Link& link)
        : recorder_(recorder), number_(number), link_(link) {}

    // What the way costs is looked up once a tick: it may change at any time.
    void begin_tick() {
        sent_ = 0;
        if (const std::size_t now = link_.overhead(); now != overhead_) {
            overhead_ = now;
            recorder_.put(heard::Overhead{number_, overhead_});
        }
    }

    bool send(std::span<const std::byte> datagram, Nanoseconds now) override {
        const bool taken = link_.send(datagram, now);
        if (!taken) {
            recorder_.put(heard::NotSent{number_, sent_});
        }
        ++sent_;
        return taken;
    }

    ReceivedDatagram receive(std::span<std::byte> into, Nanoseconds now) override {
        const ReceivedDatagram received = link_.receive(into, now);
        if (received) {
            // As heard::Arrival is read, without a copy of its own.
            const std::uint8_t kind = kind_of<heard::Arrival, HeardInput>;
            const auto size = static_cast<std::uint32_t>(received.bytes);
            recorder_.append(&kind, sizeof kind);
            recorder_.append(&number_, sizeof number_);
            recorder_.append(&received.arrived, sizeof received.arrived);
            recorder_.append(&size, sizeof size);
            recorder_.append(into.data(), received.bytes);
        }
        return received;
    }

    std::size_t overhead() const override { return overhead_; }

    void took(const TeleopSettings& settings) override { recorder_.put(heard::Settings{number_, settings}); }
    void took(const ObjectBinding& binding) override { recorder_.put(heard::Binding{number_, binding}); }
    void took(const DiscoveryAcknowledgement& acknowledgement) override {
        recorder_.put(heard::Acknowledged{number_, acknowledgement});
    }
    void took_announced() override { recorder_.put(heard::Announced{number_}); }
    void took_withdrawn(ObjectId object) override { recorder_.put(heard::Withdrawn{number_, object}); }
    void announced(const PreparedDiscovery& discovery) override {
        recorder_.note(call::Announce{number_, discovery});
    }

private:
    InputRecorder& recorder_;
    std::uint32_t number_;
    Link& link_;
    std::uint32_t sent_ = 0;  // in this tick
    std::size_t overhead_ = Link::overhead();
};

InputRecorder::InputRecorder(std::size_t room) : ring_(room) {}
InputRecorder::~InputRecorder() = default;

// --- owner

void InputRecorder::note(const InputCall& call) {
    ValueWriter writer(calls_);
    pass(writer, call);
}

std::vector<LinkEnd> InputRecorder::tap(const std::vector<LinkEnd>& ends) {
    std::vector<LinkEnd> tapped = ends;
    call::Attach attached;
    for (LinkEnd& end : tapped) {
        taps_.push_back(
            std::make_unique<LinkTap>(*this, static_cast<std::uint32_t>(taps_.size()), *end.link));
        end.link = taps_.back().get();
        end.port->tap = taps_.back().get();
        attached.sides.push_back(end.plan);
    }
    note(attached);
    return tapped;
}

std::uint32_t InputRecorder::number_of(const void* ring) {
    const auto found = std::ranges::find(rings_, ring);
    const auto number = static_cast<std::uint32_t>(found - rings_.begin());
    if (found == rings_.end()) {
        rings_.push_back(ring);
    }
    return number;
}

// The ticks first: what they have taken had been noted before.
void InputRecorder::drain(std::vector<std::byte>& calls, std::vector<std::byte>& ticks) {
    ring_.read(ticks);
    std::vector<std::byte>& noted = calls_.bytes();
    calls.insert(calls.end(), noted.begin(), noted.end());
    noted.clear();
}

// --- loop

template <typename Heard>
void InputRecorder::put(const Heard& heard) {
    struct Ring {
        InputRecorder& recorder;
        bool append(const void* from, std::size_t size) {
            recorder.append(from, size);
            return recorder.fits_;
        }
    } ring{*this};
    const std::uint8_t kind = kind_of<Heard, HeardInput>;
    append(&kind, sizeof kind);
    ValueWriter writer(ring);
    pass(writer, heard);
}

void InputRecorder::close() {
    if (fits_) {
        ring_.commit();
    } else {
        ring_.abandon();
    }
}

void InputRecorder::begin_tick(const heard::Tick& tick) {
    put(tick);
    for (const std::unique_ptr<LinkTap>& tap : taps_) {
        tap->begin_tick();
    }
}

void InputRecorder::note_reading(SessionHandle device, const DeviceSample& sample,
                                 const DeviceCapabilities& capabilities) {
    if (capabilities != capabilities_[device]) {
        capabilities_[device] = capabilities;
        put(heard::Abilities{device, capabilities});
    }
    put(heard::Reading{device, sample});
}

void InputRecorder::end_tick(std::uint64_t outcome) {
    put(heard::Done{outcome});
    close();
    if (!fits_) {
        lost_.fetch_add(1, std::memory_order_relaxed);
    }
}

void InputRecorder::note_between_ticks(const HeardInput& input) {
    std::visit([this](const auto& heard) { put(heard); }, input);
    close();
}

}  // namespace tactus
