// A world as one side of a teleoperation, without an engine: the way is opened and kept, what the far side is
// and does is said in words, bodies that are told become the other side's.
#include "world/world_link.hpp"

#include <gtest/gtest.h>

#include <glm/gtc/quaternion.hpp>
#include <set>

#include "world/model_error.hpp"

namespace tactus::world_link_test {
namespace {

constexpr Nanoseconds period = 1'000'000;
constexpr std::uint8_t model_mediated = 4;

BodyAddition box_at(const Vec3& position) {
    BodyAddition addition;
    addition.description.shapes = {PlacedShape{BoxShape{Vec3(0.5)}, Pose{}}};
    addition.description.pose.position = position;
    return addition;
}

LinkPlan plan_of(bool is_operator, const std::shared_ptr<MemoryLinkPair>& wire) {
    LinkPlan plan;
    plan.is_operator = is_operator;
    plan.scenario = model_mediated;
    plan.revision = 1;
    plan.wire = wire;
    plan.partner = "the other one";
    return plan;
}

// One side whose ticks the test makes.
struct World {
    explicit World(LinkPlan with)
        : plan(std::move(with)), session(SessionSettings{}), link(plan, session, Vec3(0.0), Pose{}, nullptr) {
        WorldLink::attach(session, {&link});
    }
    ~World() {
        session.rest();
        link.end();
    }

    SessionHandle add(const Vec3& position) {
        names.push_back("Box" + std::to_string(additions.size()));
        additions.push_back(box_at(position));
        const AddResult added = session.add_body(additions.back());
        EXPECT_EQ(added.error, "");
        told.push_back({added.handle, 1});
        return added.handle;
    }

    void frame() {
        session.collect();
        session.refresh();
        link.synchronise(is_there ? std::optional(plan) : std::nullopt, Vec3(0.0), workers,
                         {now, true, true});
        if (!link.is_operator()) {
            link.tell(
                told, [this](std::size_t i) { return WorldLink::Description{names[i], additions[i]}; },
                [this](std::size_t i) { return names[i]; }, joints, session.snapshot(), now);
        }
        for (int i = 0; i < 10; ++i, now += period) {
            session.tick(now);
        }
    }

    LinkPlan plan;
    bool is_there = true;
    Workers workers;
    Session session;
    WorldLink link;
    Nanoseconds now = 0;
    std::vector<BodyAddition> additions;
    std::vector<std::string> names;
    std::vector<WorldLink::Told> told;
    std::vector<WorldLink::ToldJoint> joints;
};

void frames(World& a, World& b, int count) {
    for (int i = 0; i < count; ++i) {
        a.frame();
        b.frame();
    }
}

struct Sides {
    std::shared_ptr<MemoryLinkPair> wire = std::make_shared<MemoryLinkPair>();
    World here{plan_of(true, wire)};
    World there{plan_of(false, wire)};
};

TEST(WorldLink, TwoSidesOfOneProgramFindEachOther) {
    Sides sides;
    EXPECT_EQ(sides.here.link.report().state, LinkState::opening);
    sides.here.frame();
    sides.here.frame();
    EXPECT_EQ(sides.here.link.report().state, LinkState::waiting);
    EXPECT_EQ(sides.here.link.report().text, "waiting for the other one");
    frames(sides.here, sides.there, 60);
    EXPECT_EQ(sides.here.link.report().state, LinkState::connected);
    EXPECT_EQ(sides.there.link.report().text, "connected");
}

TEST(WorldLink, WhatIsToldBecomesTheModelAndGoesAgain) {
    Sides sides;
    sides.there.add(Vec3(0.0));
    sides.there.add(Vec3(3.0, 0.0, 0.0));
    frames(sides.here, sides.there, 80);
    ASSERT_EQ(sides.here.link.objects().size(), 2u);
    std::set<std::string> names;
    for (const ModelObject& object : sides.here.link.objects()) {
        names.insert(object.name);
    }
    EXPECT_EQ(names, (std::set<std::string>{"Box0", "Box1"}));
    EXPECT_EQ(sides.there.link.report().objects, 2);
    sides.there.told.pop_back();
    frames(sides.here, sides.there, 40);
    EXPECT_EQ(sides.here.link.objects().size(), 1u);
}

TEST(WorldLink, AnotherNameIsTold) {
    Sides sides;
    for (int i = 0; i < 40; ++i) {
        sides.there.add(Vec3(3.0 * i, 0.0, 0.0));
    }
    frames(sides.here, sides.there, 120);
    const auto is_there = [&](const std::string& name) {
        return std::ranges::count(sides.here.link.objects(), name, &ModelObject::name) == 1;
    };
    ASSERT_TRUE(is_there("Box37"));
    const std::uint64_t pieces = sides.there.link.report().teleop.discovery.pieces_sent;
    sides.there.names[37] = "Shelf/Box37";
    frames(sides.here, sides.there, 40);
    EXPECT_TRUE(is_there("Shelf/Box37"));
    EXPECT_FALSE(is_there("Box37"));
    EXPECT_EQ(sides.here.link.objects().size(), 40u);
    EXPECT_LE(sides.there.link.report().teleop.discovery.pieces_sent - pieces, 3u) << "of that one only";
}

// Two that change their names with each other.
TEST(WorldLink, NamesAreExchanged) {
    Sides sides;
    const SessionHandle first = sides.there.add(Vec3(0.0));
    sides.there.add(Vec3(3.0, 0.0, 0.0));
    frames(sides.here, sides.there, 80);
    std::swap(sides.there.names[0], sides.there.names[1]);
    frames(sides.here, sides.there, 40);
    ASSERT_EQ(sides.here.link.objects().size(), 2u);
    for (const ModelObject& object : sides.here.link.objects()) {
        EXPECT_EQ(object.name, object.object == first ? "Box1" : "Box0");
    }
}

TEST(WorldLink, WhatJoinsIsToldOnceAndGoesAgain) {
    Sides sides;
    const SessionHandle body = sides.there.add(Vec3(0.0));
    JointDescription pin;
    pin.second_frame = Pose{};
    const SessionHandle joint = sides.there.session.add_joint(pin, body, no_handle).handle;
    sides.there.joints.push_back({joint, body, no_handle, &pin, 77, 1});
    frames(sides.here, sides.there, 80);
    const auto discovery = [&sides] { return sides.there.link.report().teleop.discovery; };
    EXPECT_EQ(discovery().known, 2u) << "the body and what holds it";
    EXPECT_TRUE(sides.here.link.problems().empty());
    const std::uint64_t pieces = discovery().pieces_sent;
    frames(sides.here, sides.there, 40);
    EXPECT_EQ(discovery().pieces_sent, pieces);
    sides.there.joints.clear();
    frames(sides.here, sides.there, 40);
    EXPECT_EQ(discovery().known, 1u);
}

TEST(WorldLink, AnObjectIsBuiltAsAnExperimentHasIt) {
    Sides sides;
    std::vector<double> masses;
    sides.here.link.set_distortion([&masses](ObjectDescription& description) {
        ModelError error;
        error.mass = 2.0;
        error.move = {0.0, 1.0, 0.0};
        distort(error, description);
        masses.push_back(description.body.mass);
    });
    sides.there.add(Vec3(0.0));
    frames(sides.here, sides.there, 80);
    ASSERT_FALSE(masses.empty());
    for (const double mass : masses) {  // a far side that has just been met is told again
        EXPECT_EQ(mass, 2.0 * box_at(Vec3(0.0)).description.mass);
    }
}

TEST(ModelError, TurnsAboutTheObjectsOwnPlace) {
    ObjectDescription description;
    description.body.pose.position = {1.0, 2.0, 3.0};
    description.touch.stiffness = 100.0;
    ModelError error;
    error.turn = glm::angleAxis(0.5, Vec3(0.0, 1.0, 0.0));
    error.stiffness = 0.5;
    distort(error, description);
    EXPECT_EQ(description.body.pose.position, Vec3(1.0, 2.0, 3.0));
    EXPECT_NEAR(glm::angle(description.body.pose.rotation), 0.5, 1e-12);
    EXPECT_EQ(description.touch.stiffness, 50.0);
}

TEST(WorldLink, AnotherScenarioIsRefusedInWords) {
    const auto wire = std::make_shared<MemoryLinkPair>();
    World here(plan_of(true, wire));
    LinkPlan other = plan_of(false, wire);
    other.scenario = 2;
    other.teleop.traditional = true;
    World there(other);
    frames(here, there, 60);
    EXPECT_EQ(here.link.report().state, LinkState::refused);
    EXPECT_EQ(here.link.report().text,
              "the other side is set to scenario 2 and this side to 4: set both alike");
}

TEST(WorldLink, ASideThatLeavesSaysSo) {
    Sides sides;
    frames(sides.here, sides.there, 60);
    sides.there.link.leave();
    sides.there.frame();
    sides.here.frame();
    sides.here.frame();
    EXPECT_EQ(sides.here.link.report().state, LinkState::left);
    EXPECT_EQ(sides.here.link.report().text, "the other side has ended");
}

TEST(WorldLink, ASideThatFallsSilentIsLost) {
    Sides sides;
    frames(sides.here, sides.there, 60);
    for (int i = 0; i < 120; ++i) {
        sides.here.frame();
    }
    EXPECT_EQ(sides.here.link.report().state, LinkState::lost);
    frames(sides.here, sides.there, 60);
    EXPECT_EQ(sides.here.link.report().state, LinkState::connected);
}

TEST(WorldLink, AProblemTakesTheWayAndItsEndGivesItBack) {
    Sides sides;
    frames(sides.here, sides.there, 60);
    sides.here.plan.problem = "its partner plays the same side";
    for (int i = 0; i < 3; ++i) {
        sides.here.frame();
    }
    EXPECT_EQ(sides.here.link.report().state, LinkState::failed);
    EXPECT_EQ(sides.here.link.report().text, "its partner plays the same side");
    sides.here.plan.problem.clear();
    frames(sides.here, sides.there, 60);
    EXPECT_EQ(sides.here.link.report().state, LinkState::connected);
}

TEST(WorldLink, AnotherWayIsOpenedWhileItRuns) {
    Sides sides;
    frames(sides.here, sides.there, 60);
    const auto other = std::make_shared<MemoryLinkPair>();
    for (World* world : {&sides.here, &sides.there}) {
        world->plan.wire = other;
        ++world->plan.revision;
    }
    frames(sides.here, sides.there, 60);
    EXPECT_EQ(sides.here.link.report().state, LinkState::connected);
    std::array<std::byte, max_datagram_bytes> into{};
    sides.wire->first().receive(into, sides.here.now);
    EXPECT_EQ(sides.wire->first().receive(into, sides.here.now).bytes, 0u) << "the old wire is still used";
}

TEST(WorldLink, AKeyThatCannotBeReadIsSaidAndTriedAgain) {
    LinkPlan plan = plan_of(true, nullptr);
    plan.network.udp.remote_address = "127.0.0.1";
    plan.network.udp.remote_port = 47991;
    plan.key_file = "/nothing/here";
    World world(plan);
    world.frame();
    EXPECT_EQ(world.link.report().state, LinkState::failed);
    EXPECT_NE(world.link.report().text.find("/nothing/here"), std::string::npos) << world.link.report().text;
    world.plan.key_file.clear();
    for (int i = 0; i < 201; ++i) {
        world.frame();
    }
    EXPECT_EQ(world.link.report().state, LinkState::waiting) << world.link.report().text;
}

TEST(WorldLink, OneWhoHasSetItMayGo) {
    Sides sides;
    frames(sides.here, sides.there, 60);
    sides.here.is_there = false;
    for (int i = 0; i < 10; ++i) {
        sides.here.frame();
    }
    EXPECT_EQ(sides.here.link.report().state, LinkState::opening) << "it still has a way";
}

TEST(ProblemOfAddresses, SaysWhatIsMissingOrTheSame) {
    UdpSettings udp;
    udp.local_port = udp.remote_port = 47001;
    EXPECT_EQ(problem_of_addresses(udp), "the other side has no address: set 'remote_address'");
    for (const char* loop : {"127.0.0.1", "localhost", "::1"}) {
        udp.remote_address = loop;
        EXPECT_NE(problem_of_addresses(udp).find("it would talk to itself"), std::string::npos) << loop;
    }
    udp.remote_port = 47002;
    EXPECT_EQ(problem_of_addresses(udp), "");
}

TEST(UsualPorts, AreTheOtherSidesTurnedRoundAndOnlyWhereNoneIsGiven) {
    const UdpSettings here = with_usual_ports({}, true), there = with_usual_ports({}, false);
    EXPECT_NE(here.local_port, here.remote_port);
    EXPECT_EQ(here.local_port, there.remote_port);
    EXPECT_EQ(here.remote_port, there.local_port);
    UdpSettings own;
    own.local_port = 5;
    EXPECT_EQ(with_usual_ports(own, true).local_port, 5);
    EXPECT_EQ(with_usual_ports(own, true).remote_port, here.remote_port);
}

}  // namespace
}  // namespace tactus::world_link_test
