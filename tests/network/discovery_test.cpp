// Objects become known on the far side whatever the network does, once, and in bounded memory.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>

#include "endpoint_rig.hpp"
#include "network/discovery_receiver.hpp"
#include "network/discovery_sender.hpp"
#include "shared/object_samples.hpp"
#include "support/realtime_audit.hpp"

namespace tactus::discovery_test {
namespace {

constexpr Nanoseconds ms = 1'000'000;
constexpr int messages_per_tick = 4;

PreparedDiscovery prepared(const ObjectDescription& description) {
    return prepare_discovery(description);
}

// The teleoperator describes, the operator builds a model.
struct DiscoveryRig {
    explicit DiscoveryRig(const LinkConditions& conditions = {}, const DiscoverySettings& settings = {})
        : rig(conditions), receiver(settings) {
        rig.on_near([this](const Message& message) { hear(message); });
        rig.on_far(
            [this](const Message& message) { sender.take(std::get<DiscoveryAcknowledgement>(message)); });
    }

    void run(Nanoseconds span) {
        rig.run(span, [this] {
            tell();
            build();
        });
    }

    void announce(const ObjectDescription& description) {
        PreparedDiscovery discovery = prepared(description);
        ASSERT_TRUE(discovery);
        ASSERT_TRUE(sender.announce(discovery));
    }

    void withdraw(ObjectId object) {
        std::shared_ptr<const std::vector<std::byte>> released;
        sender.withdraw(object, released);
    }

    EndpointRig rig;
    DiscoverySender sender;
    DiscoveryReceiver receiver;
    std::map<ObjectId, ObjectDescription> model;
    int described = 0;
    int restarts = 0;
    DiscoveryVerdict verdict = DiscoveryVerdict::known;

private:
    void hear(const Message& message) {
        if (near_peer_ != rig.near().peer_epoch()) {
            near_peer_ = rig.near().peer_epoch();
            receiver.put_restart();
        }
        if (const auto* fragment = std::get_if<DiscoveryFragment>(&message)) {
            receiver.put(*fragment);
        } else if (const auto* removal = std::get_if<ObjectRemoval>(&message)) {
            receiver.put(*removal);
        }
    }

    void tell() {
        if (far_peer_ != rig.far().peer_epoch()) {
            far_peer_ = rig.far().peer_epoch();
            sender.restart();
        }
        Message message;
        for (int i = 0; rig.far().connected() && i < messages_per_tick && sender.next(rig.now(), message);
             ++i) {
            rig.far().send(message);
        }
    }

    void build() {
        DiscoveryAcknowledgement answer;
        while (receiver.next_acknowledgement(answer)) {
            rig.near().send(answer);
        }
        while (auto event = receiver.next()) {
            if (event->kind == DiscoveryEvent::Kind::removed) {
                model.erase(event->object);
            } else if (event->kind == DiscoveryEvent::Kind::restarted) {
                model.clear();
                ++restarts;
            } else {
                ++described;
                if (verdict == DiscoveryVerdict::known) {
                    model[event->object] = event->description;
                }
                receiver.answer(event->object, verdict);
            }
        }
    }

    std::uint64_t near_peer_ = 0;
    std::uint64_t far_peer_ = 0;
};

TEST(Discovery, AnObjectIsDescribedOnceAndAcknowledged) {
    DiscoveryRig rig;
    const ObjectDescription box = samples::object_of_all_shapes(3);
    rig.announce(box);
    rig.run(100 * ms);
    ASSERT_EQ(rig.model.count(3), 1u);
    EXPECT_EQ(encode_description(rig.model[3]), encode_description(box));
    EXPECT_EQ(rig.described, 1);
    EXPECT_EQ(rig.sender.counts().known, 1u);
    EXPECT_EQ(rig.sender.counts().waiting, 0u);
    const std::uint64_t sent = rig.sender.counts().pieces_sent;
    rig.run(2000 * ms);
    EXPECT_EQ(rig.sender.counts().pieces_sent, sent) << "once it is acknowledged, nothing is repeated";
}

TEST(Discovery, ALargeMeshComesInPieces) {
    DiscoveryRig rig;
    const ObjectDescription strip = samples::object_of_size(1, 20'000);
    rig.announce(strip);
    rig.run(1000 * ms);
    ASSERT_EQ(rig.model.count(1), 1u);
    EXPECT_EQ(encode_description(rig.model[1]), encode_description(strip));
    EXPECT_GT(rig.sender.counts().pieces_sent, 600u);
}

TEST(Discovery, ArrivesThroughLossDisorderAndCopies) {
    LinkConditions conditions;
    conditions.delay = 50 * ms;
    conditions.jitter = 30 * ms;
    conditions.loss = 0.5;
    conditions.duplication = 0.2;
    DiscoveryRig rig(conditions);
    for (ObjectId id = 0; id < 20; ++id) {
        rig.announce(samples::object_of_size(id, 100 + 50 * id));
    }
    rig.run(15'000 * ms);
    EXPECT_EQ(rig.model.size(), 20u);
    EXPECT_EQ(rig.described, 20) << "however often it was told";
    EXPECT_EQ(rig.sender.counts().known, 20u);
    EXPECT_GT(rig.receiver.counts().repeated, 0u);
    for (const auto& [id, description] : rig.model) {
        EXPECT_EQ(encode_description(description),
                  encode_description(samples::object_of_size(id, 100 + 50 * id)));
    }
}

TEST(Discovery, ALateJoinerIsToldEverything) {
    DiscoveryRig rig;
    rig.announce(samples::object_of_size(1, 50));
    rig.announce(samples::object_of_size(2, 50));
    rig.run(500 * ms);
    rig.rig.start_near(77);
    rig.model.clear();
    rig.receiver.put_restart();  // a new process has a new receiver
    rig.run(500 * ms);
    EXPECT_EQ(rig.model.size(), 2u);
    EXPECT_EQ(rig.sender.counts().known, 2u);
}

// Until all is acknowledged that was there when the two met, whatever comes or is described anew meanwhile.
TEST(Discovery, TheFirstDescriptionEndsWhateverComesMeanwhile) {
    DiscoveryRig rig;
    for (ObjectId object = 0; object < 20; ++object) {
        rig.announce(samples::object_of_all_shapes(object));
    }
    EXPECT_EQ(rig.sender.counts().unanswered, 0u) << "there is no far side yet";
    std::uint32_t most = 0;
    for (ObjectId object = 20; object < 400; ++object) {
        ObjectDescription changes = samples::object_of_all_shapes(0);
        changes.body.mass = 1.0 + object;
        rig.announce(changes);
        rig.announce(samples::object_of_all_shapes(object));
        rig.run(ms);
        most = std::max(most, rig.sender.counts().unanswered);
    }
    EXPECT_GE(most, 20u);
    EXPECT_EQ(rig.sender.counts().unanswered, 0u);
    EXPECT_GT(rig.sender.counts().waiting, 0u);
}

TEST(Discovery, WhatIsWithdrawnIsNotWaitedFor) {
    DiscoverySender sender;
    for (ObjectId object = 0; object < 3; ++object) {
        PreparedDiscovery discovery = prepared(samples::object_of_all_shapes(object));
        ASSERT_TRUE(sender.announce(discovery));
    }
    sender.restart();
    sender.restart();
    EXPECT_EQ(sender.counts().unanswered, 3u);
    std::shared_ptr<const std::vector<std::byte>> released;
    sender.withdraw(1, released);
    EXPECT_EQ(sender.counts().unanswered, 2u);
    sender.restart();
    EXPECT_EQ(sender.counts().unanswered, 2u);
}

TEST(Discovery, AFarSideThatRestartsTakesItsObjectsWithIt) {
    DiscoveryRig rig;
    rig.announce(samples::object_of_size(1, 50));
    rig.announce(samples::object_of_size(2, 50));
    rig.run(500 * ms);
    EXPECT_EQ(rig.model.size(), 2u);
    rig.sender = DiscoverySender();
    rig.announce(samples::object_of_size(2, 60));
    rig.rig.start_far(99);
    rig.run(500 * ms);
    EXPECT_EQ(rig.restarts, 2) << "one at the first meeting";
    ASSERT_EQ(rig.model.size(), 1u);
    EXPECT_EQ(rig.model.count(2), 1u);
}

TEST(Discovery, ANewDescriptionReplacesTheOld) {
    LinkConditions conditions;
    conditions.delay = 20 * ms;
    DiscoveryRig rig(conditions);
    rig.announce(samples::object_of_size(1, 50));
    rig.run(500 * ms);
    ObjectDescription heavier = samples::object_of_size(1, 50);
    heavier.body.mass = 7.0;
    rig.announce(heavier);
    rig.run(30 * ms);
    EXPECT_EQ(rig.sender.counts().known, 0u);
    rig.run(500 * ms);
    EXPECT_EQ(rig.model[1].body.mass, 7.0);
    EXPECT_EQ(rig.sender.counts().known, 1u);
}

TEST(Discovery, SayingTheSameAgainSendsNothing) {
    DiscoveryRig rig;
    rig.announce(samples::object_of_size(1, 50));
    rig.run(500 * ms);
    const std::uint64_t sent = rig.sender.counts().pieces_sent;
    rig.announce(samples::object_of_size(1, 50));
    rig.run(500 * ms);
    EXPECT_EQ(rig.sender.counts().pieces_sent, sent);
}

TEST(Discovery, PiecesOfAnEarlierDescriptionAreOutdated) {
    DiscoveryReceiver receiver;
    const PreparedDiscovery old_one = prepared(samples::object_of_size(1, 3));
    const PreparedDiscovery new_one = prepared(samples::object_of_size(1, 4));
    const auto piece = [](const PreparedDiscovery& d, std::uint32_t revision) {
        return DiscoveryFragment{1, revision,  d.hash, static_cast<std::uint32_t>(d.content->size()),
                                 0, *d.content};
    };
    receiver.put(piece(new_one, 2));
    receiver.put(piece(old_one, 1));
    const auto event = receiver.next();
    ASSERT_TRUE(event);
    EXPECT_EQ(std::get<MeshShape>(event->description.body.shapes[0].shape).mesh->vertices.size(), 4u);
    EXPECT_FALSE(receiver.next());
    EXPECT_EQ(receiver.counts().outdated, 1u);
}

TEST(Discovery, ARemovedObjectStaysRemoved) {
    LinkConditions conditions;
    conditions.delay = 20 * ms;
    conditions.jitter = 15 * ms;
    conditions.loss = 0.3;
    DiscoveryRig rig(conditions);
    rig.announce(samples::object_of_size(1, 500));
    rig.announce(samples::object_of_size(2, 500));
    rig.run(3000 * ms);
    ASSERT_EQ(rig.model.size(), 2u);
    rig.withdraw(1);
    rig.run(3000 * ms);
    EXPECT_EQ(rig.model.size(), 1u);
    EXPECT_EQ(rig.sender.counts().waiting, 0u);
}

TEST(Discovery, ADelayedPieceDoesNotBringAnObjectBack) {
    DiscoveryReceiver receiver;
    const PreparedDiscovery discovery = prepared(samples::object_of_size(1, 3));
    const DiscoveryFragment piece{
        1, 1, discovery.hash, static_cast<std::uint32_t>(discovery.content->size()), 0, *discovery.content};
    receiver.put(piece);
    receiver.put(ObjectRemoval{1, 2, discovery.hash});
    receiver.put(piece);
    EXPECT_EQ(receiver.next()->kind, DiscoveryEvent::Kind::described);
    EXPECT_EQ(receiver.next()->kind, DiscoveryEvent::Kind::removed);
    EXPECT_FALSE(receiver.next());
    EXPECT_EQ(receiver.counts().outdated, 1u);
}

TEST(Discovery, AnIdMayBeGivenToAnotherObject) {
    DiscoveryRig rig;
    rig.announce(samples::object_of_size(1, 50));
    rig.run(500 * ms);
    rig.withdraw(1);
    rig.run(500 * ms);
    ASSERT_TRUE(rig.model.empty());
    rig.announce(samples::object_of_size(1, 60));
    rig.run(500 * ms);
    EXPECT_EQ(rig.model.size(), 1u);
    // At once, before the removal is through.
    rig.withdraw(1);
    rig.announce(samples::object_of_size(1, 70));
    rig.run(500 * ms);
    ASSERT_EQ(rig.model.size(), 1u);
    EXPECT_EQ(std::get<MeshShape>(rig.model[1].body.shapes[0].shape).mesh->vertices.size(), 70u);
    EXPECT_EQ(rig.sender.counts().known, 1u);
}

TEST(Discovery, ADelayedRemovalDoesNotTakeWhatFollowedIt) {
    DiscoveryReceiver receiver;
    const PreparedDiscovery next = prepared(samples::object_of_size(1, 4));
    receiver.put(DiscoveryFragment{1, 3, next.hash, static_cast<std::uint32_t>(next.content->size()), 0,
                                   *next.content});
    receiver.put(ObjectRemoval{1, 2, {}});
    EXPECT_TRUE(receiver.next());
    EXPECT_FALSE(receiver.next());
    DiscoveryAcknowledgement answer;
    EXPECT_TRUE(receiver.next_acknowledgement(answer)) << "it is settled all the same";
}

TEST(Discovery, RemovingWhatIsStillBeingToldStopsTheTelling) {
    DiscoveryRig rig;
    rig.announce(samples::object_of_size(1, 20'000));
    rig.run(30 * ms);
    rig.withdraw(1);
    rig.run(500 * ms);
    EXPECT_TRUE(rig.model.empty());
    EXPECT_EQ(rig.described, 0);
    EXPECT_EQ(rig.sender.counts().waiting, 0u);
}

TEST(Discovery, WhatCannotBeBuiltIsNotRepeated) {
    DiscoveryRig rig;
    rig.verdict = DiscoveryVerdict::refused;
    rig.announce(samples::object_of_size(1, 50));
    rig.run(1000 * ms);
    EXPECT_EQ(rig.sender.counts().refused, 1u);
    EXPECT_EQ(rig.sender.counts().pieces_sent,
              prepared(samples::object_of_size(1, 50)).content->size() / 1024 + 1);
}

TEST(Discovery, WhatFindsNoRoomIsOfferedAgainSlowly) {
    DiscoverySettings settings;
    settings.max_objects = 1;
    DiscoveryRig rig({}, settings);
    rig.announce(samples::object_of_size(1, 10));
    rig.announce(samples::object_of_size(2, 10));
    rig.run(1000 * ms);
    EXPECT_EQ(rig.model.size(), 1u);
    EXPECT_EQ(rig.sender.counts().no_room, 1u);
    const std::uint64_t sent = rig.sender.counts().pieces_sent;
    rig.run(3000 * ms);
    EXPECT_LE(rig.sender.counts().pieces_sent, sent + 1);
    rig.withdraw(rig.model.begin()->first);
    rig.run(6000 * ms);
    EXPECT_EQ(rig.model.size(), 1u);
    EXPECT_EQ(rig.sender.counts().no_room, 0u);
    EXPECT_EQ(rig.sender.counts().known, 1u);
}

TEST(Discovery, IncompleteDescriptionsTakeBoundedMemory) {
    DiscoverySettings settings;
    settings.max_incomplete_bytes = 100 * max_fragment_bytes;
    DiscoveryReceiver receiver(settings);
    const std::vector<std::byte> bytes(max_fragment_bytes);
    for (ObjectId id = 0; id < 300; ++id) {
        receiver.put(DiscoveryFragment{id, 1, ContentHash{}, 4 << 20, 0, bytes});
        EXPECT_FALSE(receiver.next());
    }
    EXPECT_EQ(receiver.counts().unfinished, 200u) << "what has waited longest is given up";
}

// Whoever claims much, and whoever begins ten thousand objects, keeps nobody's own from being described.
TEST(Discovery, ClaimsKeepNobodyOut) {
    DiscoverySettings settings;
    settings.max_objects = 64;
    settings.max_incomplete_bytes = 8 << 20;
    DiscoveryReceiver receiver(settings);
    const std::vector<std::byte> bytes(max_fragment_bytes);
    const PreparedDiscovery honest = prepared(samples::object_of_size(1, 5000));
    const auto total = static_cast<std::uint32_t>(honest.content->size());
    ASSERT_GT(total, 50'000u);
    bool described = false;
    ObjectId junk = 100;
    for (std::uint32_t offset = 0; offset < total; offset += max_fragment_bytes) {
        for (int i = 0; i < 40; ++i) {
            receiver.put(DiscoveryFragment{junk++, 1, ContentHash{}, max_description_bytes, 0, bytes});
        }
        const std::size_t size = std::min<std::size_t>(max_fragment_bytes, total - offset);
        receiver.put(DiscoveryFragment{1, 7, honest.hash, total, offset,
                                       std::span(*honest.content).subspan(offset, size)});
        while (const auto event = receiver.next()) {
            described = described || event->object == 1;
        }
    }
    EXPECT_TRUE(described);
}

// Far more than the receiver holds at once, through loss: what is told is told to its end.
TEST(Discovery, ManyLargeObjectsGetThroughASmallRoom) {
    LinkConditions conditions;
    conditions.delay = 20 * ms;
    conditions.loss = 0.1;
    DiscoveryRig rig(conditions);
    for (ObjectId id = 0; id < 8; ++id) {
        rig.announce(samples::object_of_size(id, 100'000));
    }
    rig.run(60'000 * ms);
    EXPECT_EQ(rig.model.size(), 8u);
    EXPECT_EQ(rig.sender.counts().known, 8u);
}

// Each piece begins the object anew: that costs no more than the piece.
TEST(Discovery, RevisionsThatRiseCostNoMoreThanTheirPieces) {
    DiscoveryReceiver receiver;
    const std::vector<std::byte> bytes(max_fragment_bytes);
    for (std::uint32_t revision = 1; revision <= 100'000; ++revision) {
        receiver.put(DiscoveryFragment{1, revision, ContentHash{}, max_description_bytes, 0, bytes});
        EXPECT_FALSE(receiver.next());
    }
    EXPECT_EQ(receiver.counts().pieces, 100'000u);
}

TEST(Discovery, DescriptionsAreReadWhereTheOwnerSays) {
    std::vector<std::function<void()>> jobs;
    DiscoveryReceiver receiver;
    receiver.set_run([&jobs](std::function<void()> job) { jobs.push_back(std::move(job)); });
    const PreparedDiscovery first = prepared(samples::object_of_size(1, 5));
    const PreparedDiscovery second = prepared(samples::object_of_size(1, 6));
    const auto tell = [&receiver](const PreparedDiscovery& discovery, std::uint32_t revision) {
        receiver.put(DiscoveryFragment{1, revision, discovery.hash,
                                       static_cast<std::uint32_t>(discovery.content->size()), 0,
                                       *discovery.content});
    };
    tell(first, 1);
    EXPECT_FALSE(receiver.next());
    tell(second, 2);
    EXPECT_FALSE(receiver.next());
    ASSERT_EQ(jobs.size(), 2u);
    jobs[1]();
    EXPECT_FALSE(receiver.next());
    jobs[0]();
    ASSERT_TRUE(receiver.next()) << "only what is told last is built";
    EXPECT_FALSE(receiver.next());
    receiver.put_restart();
    EXPECT_EQ(receiver.next()->kind, DiscoveryEvent::Kind::restarted);
}

TEST(Discovery, ContentThatDoesNotMatchItsHashIsNotBelieved) {
    DiscoveryReceiver receiver;
    PreparedDiscovery discovery = prepared(samples::object_of_size(1, 3));
    std::vector<std::byte> damaged = *discovery.content;
    damaged[40] ^= std::byte{1};
    const auto size = static_cast<std::uint32_t>(damaged.size());
    receiver.put(DiscoveryFragment{1, 1, discovery.hash, size, 0, damaged});
    EXPECT_FALSE(receiver.next());
    EXPECT_EQ(receiver.counts().wrong_hash, 1u);
    receiver.put(DiscoveryFragment{1, 1, discovery.hash, size, 0, *discovery.content});
    EXPECT_TRUE(receiver.next()) << "the next telling is believed";
}

TEST(Discovery, ContentThatCannotBeUnderstoodIsRefused) {
    DiscoveryReceiver receiver;
    const std::vector<std::byte> nonsense(100, std::byte{7});
    const ContentHash hash = content_hash(nonsense);
    receiver.put(DiscoveryFragment{1, 1, hash, 100, 0, nonsense});
    EXPECT_FALSE(receiver.next());
    EXPECT_EQ(receiver.counts().refused, 1u);
    DiscoveryAcknowledgement answer;
    ASSERT_TRUE(receiver.next_acknowledgement(answer));
    EXPECT_EQ(answer.verdict, DiscoveryVerdict::refused);
    EXPECT_EQ(answer.hash, hash);
}

TEST(Discovery, AnIdInsideThatIsNotTheIdOutsideIsRefused) {
    DiscoveryReceiver receiver;
    const PreparedDiscovery discovery = prepared(samples::object_of_size(1, 3));
    receiver.put(DiscoveryFragment{
        2, 1, discovery.hash, static_cast<std::uint32_t>(discovery.content->size()), 0, *discovery.content});
    EXPECT_FALSE(receiver.next());
    EXPECT_EQ(receiver.counts().refused, 1u);
}

TEST(Discovery, AThousandObjectsAreKnownWithinSeconds) {
    DiscoveryRig rig;
    for (ObjectId id = 0; id < 1000; ++id) {
        rig.announce(samples::object_of_size(id, 5));
    }
    rig.run(2000 * ms);
    EXPECT_EQ(rig.model.size(), 1000u);
    EXPECT_EQ(rig.sender.counts().known, 1000u);
}

TEST(Discovery, MoreObjectsThanTheSenderHoldsAreRefused) {
    DiscoverySender sender(1);
    PreparedDiscovery first = prepared(samples::object_of_size(1, 3));
    PreparedDiscovery second = prepared(samples::object_of_size(2, 3));
    EXPECT_TRUE(sender.announce(first));
    EXPECT_FALSE(sender.announce(second));
    EXPECT_TRUE(second) << "it stays with the caller";
}

TEST(Discovery, TheHapticThreadsPartAllocatesLocksAndAsksForNothing) {
    DiscoverySender sender;
    DiscoveryReceiver receiver;
    PreparedDiscovery first = prepared(samples::object_of_size(1, 100));
    PreparedDiscovery changed = prepared(samples::object_of_size(1, 120));
    std::shared_ptr<const std::vector<std::byte>> released;
    DiscoveryAcknowledgement answer{1, changed.hash, DiscoveryVerdict::known};
    Message message;
    testing::AuditScope audit;
    sender.announce(first);
    sender.announce(changed);
    sender.restart();
    for (Nanoseconds now = 0; now < 300 * ms; now += ms) {
        while (sender.next(now, message)) {
            receiver.put(std::get<DiscoveryFragment>(message));
        }
    }
    receiver.put_restart();
    receiver.put(ObjectRemoval{1, 9, {}});
    receiver.next_acknowledgement(answer);
    sender.take(answer);
    sender.withdraw(1, released);
    audit.finish();
    EXPECT_EQ(audit.allocations() + audit.frees() + audit.locks() + audit.waits() + audit.system_calls(), 0u)
        << audit.describe();
}

}  // namespace
}  // namespace tactus::discovery_test
