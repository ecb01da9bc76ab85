// What entered a session, recorded and played again, gives the same bits.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/gtc/quaternion.hpp>
#include <limits>

#include "core/soft/soft_model.hpp"
#include "core/tree/triangle_tree.hpp"
#include "linked_places.hpp"
#include "recorded_inputs.hpp"
#include "shared/dice.hpp"
#include "shared/meshes.hpp"
#include "support/realtime_audit.hpp"

namespace tactus::input_replay_test {
namespace {

using namespace session_test;
using testing::AuditScope;

Vec3 hand_at(int i) {
    return {0.3 * std::sin(0.004 * i), 0.05 + 0.1 * std::sin(0.02 * i), 0.3 * std::cos(0.003 * i)};
}

BodyAddition mesh_body(const TriangleMesh& mesh, const Vec3& position, Motion motion) {
    return body(MeshShape{std::make_shared<const TriangleMesh>(mesh)}, position, motion, 0.5);
}

void fill(SessionRig& rig) {
    rig.add(ground());
    for (int i = 0; i < 6; ++i) {
        rig.add(body(BoxShape{Vec3(0.06)}, {0.15 * i - 0.4, 0.07 + 0.13 * (i % 2), 0.05 * i}, Motion::Dynamic,
                     0.3));
    }
    rig.add(mesh_body(shared::icosphere(2, 0.1), {0.0, 0.1, 0.3}, Motion::Static));
}

// A hand among boxes; a frame every 16 ticks.
void play_with_boxes(SessionRig& rig, RecordedInputs& inputs, int ticks) {
    fill(rig);
    rig.session.settle();
    for (int i = 0; i < ticks; ++i) {
        rig.device.position = hand_at(i);
        rig.session.tick(rig.now += period, nullptr, i % 7 * 10'000);
        if (i % 16 == 15) {
            rig.session.collect();
            inputs.drain();
        }
    }
    inputs.end();
}

TEST(InputReplay, AHandAmongBodiesThatMoveGivesTheSameBitsAgain) {
    RecordedInputs inputs;
    SessionRig rig({}, &inputs.recorder);
    play_with_boxes(rig, inputs, 3'000);
    const InputReplay::Report first = inputs.play();
    expect_whole(first, 3'000);
    EXPECT_EQ(inputs.play().outcome, first.outcome);
}

TEST(InputReplay, AnotherHandIsNotTheSame) {
    RecordedInputs inputs;
    SessionRig rig({}, &inputs.recorder);
    fill(rig);
    rig.device.position = hand_at(0);
    rig.ticks(100);
    inputs.drain();
    // A tick of which the outcome is not what was heard.
    inputs.recorder.begin_tick({rig.now + period, 0});
    inputs.recorder.note_reading(rig.hand, {}, {});
    inputs.recorder.end_tick(42);
    inputs.end();
    const InputReplay::Report report = inputs.play();
    EXPECT_EQ(report.ticks, 101u);
    EXPECT_EQ(report.first_different, 101u);
}

TEST(InputReplay, TheRowsThatWereWrittenDownAreTheSame) {
    RecordedInputs inputs;
    std::vector<SessionRecord> then, now;
    {
        SessionRig rig({}, &inputs.recorder);
        RecorderRing<SessionRecord> other(4096), ring(4096);
        rig.session.record(other, rig.proxy, no_handle);
        inputs.recorder.note(call::WriteRows{inputs.recorder.number_of(&ring)});
        inputs.recorder.note(call::Epoch{77});
        rig.session.record(ring, rig.proxy, 1);
        play_with_boxes(rig, inputs, 500);
        ring.drain([&](const SessionRecord& row) { then.push_back(row); });
    }
    inputs.play([&](const SessionRecord& row, Nanoseconds epoch) {
        EXPECT_EQ(epoch, 77);
        now.push_back(row);
    });
    ASSERT_EQ(now.size(), then.size());
    EXPECT_EQ(now.size(), 500u);
    EXPECT_EQ(now[6].ran - now[6].time, 60'000);
    EXPECT_TRUE(std::ranges::equal(then, now, [](const SessionRecord& a, const SessionRecord& b) {
        return a.time == b.time && a.ran == b.ran && a.force == b.force &&
               a.proxy_position == b.proxy_position && a.object_position == b.object_position &&
               a.contacts == b.contacts;
    }));
}

TEST(InputReplay, RowsAreTakenUntilTheirNumberIsReached) {
    RecordedInputs inputs;
    {
        SessionRig rig({}, &inputs.recorder);
        RecorderRing<SessionRecord> ring(4096);
        inputs.recorder.note(call::WriteRows{inputs.recorder.number_of(&ring)});
        rig.session.record(ring, rig.proxy, no_handle);
        rig.ticks(50);
        inputs.recorder.note(call::RowsWritten{inputs.recorder.number_of(&ring), 50});
        rig.ticks(20);
        rig.session.end_recording(ring);
        rig.ticks(10);
        inputs.end();
    }
    int rows = 0;
    expect_whole(inputs.play([&](const SessionRecord&, Nanoseconds) { ++rows; }), 80);
    EXPECT_EQ(rows, 50);
}

// All that an owner can ask for, while a hand is at work and more is asked for than a tick takes.
TEST(InputReplay, EverythingThatAnOwnerAsksForIsPlayed) {
    RecordedInputs inputs;
    SessionRig rig({}, &inputs.recorder);
    fill(rig);
    rig.session.settle();
    HeldDevice second;
    second.can.rotates = true;
    std::vector<SessionHandle> added;
    const auto image = std::make_shared<const TouchImage>(TouchImage{2, 2, {0.0f, 1.0f, 0.5f, 0.25f}});
    TouchMaterial other{300.0, 0.0, 0.6, 0.3};
    other.by_uv = true;
    const auto detail = std::make_shared<const TouchDetail>(
        TouchDetail{{image, nullptr}, {std::nullopt, SurfaceFeel{other, {nullptr, image}}}});
    SessionHandle other_hand = no_handle, other_proxy = no_handle, tool = no_handle;
    for (int round = 0; round < 40; ++round) {
        for (int i = 0; i < 8; ++i) {
            BodyAddition addition = mesh_body(shared::icosphere(1, 0.05), {0.3 * i - 1.0, 0.5, 0.1 * round},
                                              i % 3 == 0 ? Motion::Static : Motion::Dynamic);
            addition.touch_shapes = {PlacedShape{SphereShape{0.05}, Pose{}}};
            addition.description.may_move = true;
            added.push_back(rig.add(addition));
        }
        const SessionHandle last = added.back();
        rig.session.set_touch_material(last, {100.0, 1.0, 0.2, 0.1}, detail);
        rig.session.set_body_motion(last, Motion::Kinematic);
        rig.session.move_body(last, {{1.0, 1.0, 1.0}, Quat(1.0, 0.0, 0.0, 0.0)}, 0.005);
        rig.session.teleport_body(added.front(), {{2.0, 1.0, 1.0}, Quat(1.0, 0.0, 0.0, 0.0)});
        rig.session.set_body_layers(last, {2, 2});
        rig.session.set_body_surface(last, {0.3, 0.1, false, false});
        rig.session.set_body_velocity(last, Vec3(0.1), Vec3(0.0));
        rig.session.set_body_gravity_scale(last, 0.5);
        rig.session.set_body_damping(last, 0.1, 0.2);
        rig.session.set_gravity({0.0, -9.0 - 0.01 * round, 0.0});
        const SessionHandle swinging = added[added.size() - 2];
        rig.session.set_body_push(swinging, {0.1, 0.0, 0.0}, {0.0, 0.01 * round, 0.0});
        rig.session.push_body(swinging, {.impulse = {0.01, 0.0, 0.0}, .central = true});
        rig.session.see_body(swinging, {{{{0.0, 0.4, 0.1 * round}}, Vec3(0.0), Vec3(0.0)}, 0.001, {}});
        const AddResult joint =
            rig.session.add_joint({.kind = JointKind::Hinge, .frame = {}}, swinging, no_handle);
        if (round % 2 == 1) {
            rig.session.remove_joint(joint.handle);
        }
        if (round % 4 == 0) {
            other_hand = rig.session.add_device(second, {}).handle;
            ProxyDescription pointer;
            pointer.device = other_hand;
            other_proxy = rig.session.add_proxy(pointer).handle;
            ToolUse use;
            use.device = other_hand;
            tool = rig.session.add_tool(make_tool_shape(shared::box({0.05, 0.01, 0.01})).shape, use).handle;
        } else if (round % 4 == 2) {
            Workspace workspace;
            workspace.scale = 2.0;
            rig.session.set_workspace(other_hand, workspace);
            ProxyDescription pointer;
            pointer.device = other_hand;
            pointer.force_law = ForceLaw::smoothed;
            rig.session.set_proxy(other_proxy, pointer);
            ToolUse use;
            use.device = rig.hand;
            rig.session.set_tool(tool, use);
        } else if (round % 4 == 3) {
            rig.session.remove_tool(tool);
            rig.session.remove_proxy(other_proxy);
            rig.session.remove_device(other_hand);
        }
        if (round > 10) {
            rig.session.remove_body(added[static_cast<std::size_t>(round)]);
        }
        for (int i = 0; i < 5 + round % 7; ++i) {
            rig.device.position = hand_at(30 * round + i);
            second.position = hand_at(20 * round + i);
            second.rotation = glm::angleAxis(0.01 * i, Vec3(0.0, 1.0, 0.0));
            rig.tick();
        }
        if (round % 3 == 0) {
            rig.session.collect();
            inputs.drain();
        }
        if (round == 20) {
            rig.session.rest();
        }
    }
    inputs.end();
    const InputReplay::Report report = inputs.play();
    expect_whole(report, static_cast<std::uint64_t>(rig.now / period));
}

// A lump whose corners move, as `form` says what it is then.
template <typename Form>
void touch_a_lump(const Form& form) {
    RecordedInputs inputs;
    SessionRig rig({}, &inputs.recorder);
    TriangleMesh mesh = shared::icosphere(3, 0.1);
    const SessionHandle lump = rig.session.add_body(form(mesh)).handle;
    rig.session.settle();
    int touching = 0;
    for (int i = 0; i < 1'500; ++i) {
        if (i % 20 == 10) {
            for (Vec3& corner : mesh.vertices) {
                corner = glm::normalize(corner) * (0.1 + 0.01 * std::sin(0.01 * i + 30.0 * corner.x));
            }
            EXPECT_EQ(rig.session.deform_body(lump, form(mesh)), "");
            rig.session.collect();
        }
        rig.device.position = 0.095 * Vec3(std::sin(0.003 * i), std::cos(0.003 * i), 0.0);
        rig.device.position *= i < 20 ? 2.0 : 1.0;
        rig.tick();
        touching += glm::length(rig.device.force) > 0.0;
    }
    inputs.end();
    EXPECT_GT(touching, 300);
    expect_whole(inputs.play(), 1'500);
}

TEST(InputReplay, ABodyThatTakesOtherFormsTakesThemAgain) {
    touch_a_lump([](const TriangleMesh& mesh) {
        return Session::prepare_body(mesh_body(mesh, Vec3(0.0), Motion::Static));
    });
}

// By turns, those of two trees.
TEST(InputReplay, SoDoesOneWhoseTreesAreRefitted) {
    std::vector<std::shared_ptr<const TriangleTree>> trees(2);
    std::size_t round = 0;
    touch_a_lump([&](const TriangleMesh& mesh) {
        BodyAddition addition = mesh_body(mesh, Vec3(0.0), Motion::Static);
        auto touch = std::make_shared<TouchShape>(*make_touch_shape(addition.description.shapes).shape);
        std::shared_ptr<const TriangleTree>& tree = trees[round++ / 8 % 2];
        tree = std::make_shared<const TriangleTree>(tree != nullptr ? tree->refitted(mesh)
                                                                    : TriangleTree::build(mesh));
        touch->parts[0].surface = tree;
        addition.touch = touch;
        return Session::prepare_body(addition);
    });
}

// Narrowed for the hand that slides over it, and for a smaller one; and of another form no more.
TEST(InputReplay, ABodyThatIsNarrowedIsNarrowedAgain) {
    RecordedInputs inputs;
    SessionRig rig({}, &inputs.recorder);
    ProxyDescription pointer;
    pointer.device = rig.hand;
    pointer.settings.radius = 0.1;
    rig.session.set_proxy(rig.proxy, pointer);
    const BodyAddition lump = mesh_body(shared::rough_sphere(4, 0.5, 1.0), Vec3(0.0), Motion::Static);
    ReadyBody ready = Session::prepare_body(lump);
    const std::shared_ptr<const TouchShape> form = ready.touch;
    const SessionHandle body = rig.session.add_body(std::move(ready)).handle;
    int touching = 0;
    for (int i = 0; i < 200; ++i) {
        if (i == 50 || i == 100) {
            const double radius = i == 50 ? 0.1 : 0.06;
            const auto shape = narrowed(*form, radius);
            ASSERT_NE(shape, nullptr);
            rig.session.narrow_touch(body, shape, radius);
        } else if (i == 150) {
            rig.session.deform_body(body, Session::prepare_body(lump));
            rig.session.narrow_touch(body, narrowed(*form, 0.1), 0.1);
        }
        rig.device.position = (i < 10 ? 0.7 : 0.45) * Vec3(std::sin(0.004 * i), std::cos(0.004 * i), 0.0);
        rig.tick();
        rig.session.collect();
        touching += glm::length(rig.device.force) > 0.0;
    }
    inputs.end();
    EXPECT_GT(touching, 150);
    expect_whole(inputs.play(), 200);
}

// --- what gives

const HeldParts foot{Vec3(-1.0), Vec3(1.0, -0.039, 1.0), {}};

SoftDesign sponge() {
    SoftDesign design;
    design.surface = shared::grid_box(Vec3(0.04), 4);
    design.cells = 4;
    design.held = foot;
    return design;
}

SoftDesign cloth() {
    SoftDesign design;
    design.form = SoftDesign::Form::sheet;
    design.surface = shared::terrain(12, 0.1, 0.0);
    design.material.density = 300.0;
    design.held.vertices = {0, 12};
    return design;
}

SoftDesign tetrahedron() {
    SoftDesign design;
    design.form = SoftDesign::Form::tetrahedra;
    design.points = {Vec3(0.0), {0.05, 0.0, 0.0}, {0.0, 0.05, 0.0}, {0.0, 0.0, 0.05}};
    design.tetrahedra = {{0, 1, 2, 3}};
    return design;
}

TEST(InputReplay, BodiesThatGiveAreTheSameAgain) {
    RecordedInputs inputs;
    SessionRig rig({}, &inputs.recorder);
    rig.add(ground());
    rig.add(body(BoxShape{Vec3(0.02)}, {0.0, 0.2, 0.0}, Motion::Dynamic, 0.1));  // falls on the sponge
    double x = 0.0;
    for (const SoftDesign& design : {sponge(), cloth(), tetrahedron()}) {
        BodyAddition soft;
        soft.description.pose.position = {x, 0.05, 0.0};
        soft.touch_material = {500.0, 0.0, 0.5, 0.5};
        const SoftModelResult made = make_soft(design);
        ASSERT_EQ(made.error, "");
        soft.soft = made.model;
        rig.add(soft);
        x += 0.15;
    }
    rig.session.settle();
    int touching = 0;
    for (int i = 0; i < 2'000; ++i) {
        rig.device.position = {0.15 * (i / 700) + 0.01, 0.09 - 0.05 * std::sin(0.0045 * (i % 700)), 0.01};
        rig.tick();
        touching += glm::length(rig.device.force) > 0.0;
        if (i % 16 == 0) {
            rig.session.collect();
            inputs.drain();
        }
    }
    inputs.end();
    EXPECT_GT(touching, 100);
    const InputReplay::Report first = inputs.play();
    expect_whole(first, 2'000);
    EXPECT_EQ(inputs.play().outcome, first.outcome);
}

// A stiffness that is another in its twelfth digit is seen at once.
TEST(InputReplay, AnotherBodyThatGivesIsNotTheSame) {
    RecordedInputs inputs;
    SessionRig rig({}, &inputs.recorder);
    BodyAddition soft;
    soft.soft = make_soft(sponge()).model;
    SoftDesign other = sponge();
    other.material.stiffness *= 1.0 + 1e-12;
    auto told = std::make_shared<SoftModel>(*soft.soft);
    told->design = other;
    soft.soft = told;
    rig.add(soft);
    rig.device.position = {0.0, 0.06, 0.0};
    rig.draw({0.0, 0.03, 0.0}, 100);
    inputs.end();
    const InputReplay::Report report = inputs.play();
    EXPECT_EQ(report.ticks, 100u);
    EXPECT_GT(report.first_different, 0u);
}

TEST(InputReplay, ADesignOfABodyThatGivesWhichMakesNoSenseEndsIt) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    constexpr std::uint32_t nowhere = 0xffff'ffffu;
    std::vector<SoftDesign> spoilt;
    const auto spoil = [&](const SoftDesign& design, auto&& how) {
        spoilt.push_back(design);
        how(spoilt.back());
    };
    for (const SoftDesign& design : {sponge(), cloth()}) {
        spoil(design, [](SoftDesign& d) { d.surface.triangles[3][1] = nowhere; });
        spoil(design, [](SoftDesign& d) { d.surface.vertices[2].y = nan; });
        spoil(design, [](SoftDesign& d) { d.surface = {}; });
        spoil(design, [](SoftDesign& d) { d.seconds = 0.0; });
        spoil(design, [](SoftDesign& d) { d.material.stiffness = nan; });
        spoil(design, [](SoftDesign& d) { d.form = SoftDesign::Form::tetrahedra; });
    }
    spoil(sponge(), [](SoftDesign& d) { d.cells = 1 << 30; });
    spoil(sponge(), [](SoftDesign& d) { d.cells = 0; });
    spoil(tetrahedron(), [](SoftDesign& d) { d.tetrahedra[0][2] = nowhere; });
    spoil(tetrahedron(), [](SoftDesign& d) { d.points[1].z = nan; });
    for (const SoftDesign& design : spoilt) {
        RecordedInputs inputs;
        SessionRig rig({}, &inputs.recorder);
        rig.ticks(5);
        inputs.drain();
        call::Form form;
        form.soft = std::make_shared<const SoftDesign>(design);
        inputs.recorder.note(call::AddBody{7, form, {}});
        rig.ticks(5);
        inputs.end();
        const InputReplay::Report report = inputs.play();
        EXPECT_EQ(report.ticks, 5u);
        EXPECT_NE(report.problem.find("makes no sense"), std::string::npos) << report.problem;
    }
}

// A vertex that is held and is none is held by nobody.
TEST(InputReplay, AHeldVertexThatIsNoneHoldsNothing) {
    SoftDesign design = cloth();
    design.held.vertices = {0xffff'ffffu};
    const SoftModelResult made = make_soft(design);
    ASSERT_NE(made.model, nullptr);
    EXPECT_TRUE(made.model->is_free());
}

// --- over a link

LinkConditions faults() {
    LinkConditions faults;
    faults.delay = 20'000'000;
    faults.jitter = 8'000'000;
    faults.loss = 0.1;
    faults.burst = bursts(0.05, 8.0);
    faults.duplication = 0.05;
    faults.reordering = 0.05;
    return faults;
}

void touch_over_a_bad_network(TeleopSettings settings, int seconds) {
    const SessionSettings session = LinkedPlaces::session_settings();
    RecordedInputs near(session), far(session);
    LinkedPlaces places(0.04, 0.0, 1, settings, settings, 64, &near.recorder, &far.recorder);
    places.change(faults());
    places.add(ground());
    places.add(body(BoxShape{Vec3(0.1)}, {0.0, 0.1, 0.0}, Motion::Dynamic, 0.5));
    places.settle();
    for (int i = 0; i < 1000 * seconds; ++i) {
        places.near.devices[0].position = {0.2 * std::sin(0.002 * i), 0.12 + 0.08 * std::sin(0.005 * i), 0.0};
        if (i % 1000 == 500) {
            settings.stealth.share = 0.5 + 0.1 * (i / 1000 % 2);
            places.near.port->settings.publish(settings);
        }
        // The link is gone for a while.
        if (i % 5000 == 3000) {
            places.lose_everything(true);
        } else if (i % 5000 == 4500) {
            places.change(faults());
        }
        places.tick();
        if (i % 16 == 0) {
            near.drain();
            far.drain();
        }
    }
    near.end();
    far.end();
    EXPECT_GT(places.statistics().link.packets_received, 10u * static_cast<unsigned>(seconds));
    expect_whole(near.play(), 1000u * static_cast<unsigned>(seconds));
    expect_whole(far.play(), 1000u * static_cast<unsigned>(seconds));
}

TEST(InputReplay, TenMinutesOverABadNetworkAreTheSameAgainOnBothSides) {
    touch_over_a_bad_network({}, 600);
}

TEST(InputReplay, SoAreThoseOfTraditionalTouch) {
    TeleopSettings settings;
    settings.traditional = true;
    touch_over_a_bad_network(settings, 6);
}

// --- files that are not whole

class InputReplayDamaged : public ::testing::Test {
protected:
    InputReplayDamaged() {
        SessionRig rig({}, &inputs_.recorder);
        play_with_boxes(rig, inputs_, 160);
    }
    RecordedInputs inputs_;
};

TEST_F(InputReplayDamaged, AFileThatIsCutShortIsPlayedAsFarAsItGoes) {
    const std::string whole = inputs_.bytes();
    std::uint64_t played = 0;
    for (std::size_t size = 0; size < whole.size(); size += 1 + whole.size() / 97) {
        const InputReplay::Report report = RecordedInputs::play_bytes(whole.substr(0, size));
        EXPECT_NE(report.problem, "") << size;
        EXPECT_GE(report.ticks, played) << size;
        EXPECT_EQ(report.first_different, 0u) << size;
        played = report.ticks;
    }
    EXPECT_GT(played, 100u);
}

TEST_F(InputReplayDamaged, AFlippedBitIsFoundAndWhatStandsBeforeItIsPlayed) {
    const std::string whole = inputs_.bytes();
    for (std::size_t at = 0; at < whole.size(); at += 1 + whole.size() / 97) {
        std::string damaged = whole;
        damaged[at] = static_cast<char>(damaged[at] ^ (1 << at % 8));
        const InputReplay::Report report = RecordedInputs::play_bytes(damaged);
        EXPECT_NE(report.problem, "") << at;
        EXPECT_EQ(report.first_different, 0u) << at;
        EXPECT_LE(report.ticks, 160u);
    }
}

// The first bytes have all kinds of what a piece begins with.
TEST_F(InputReplayDamaged, NoBitOfAPieceHeadMayFlip) {
    const std::string whole = inputs_.bytes();
    for (std::size_t bit = 0; bit < 8 * 56; ++bit) {
        std::string damaged = whole;
        damaged[bit / 8] = static_cast<char>(damaged[bit / 8] ^ (1 << bit % 8));
        EXPECT_NE(RecordedInputs::play_bytes(damaged).problem, "") << bit;
    }
}

TEST_F(InputReplayDamaged, WhatIsNoRecordingSaysSo) {
    EXPECT_NE(RecordedInputs::play_bytes("").problem, "");
    EXPECT_NE(RecordedInputs::play_bytes("time_us,force_x\n0,0\n0,0\n0,0\n").problem.find("no recording"),
              std::string::npos);
}

// Layouts that were: before a side's settings had residuals, before they had a rate, and one that never was.
TEST_F(InputReplayDamaged, ARecordingOfAnotherVersionSaysSo) {
    constexpr std::size_t layout_at = 16;
    const std::string whole = inputs_.bytes();
    for (const std::uint64_t layout :
         std::initializer_list<std::uint64_t>{0xf53f916185ce5cd1, 0xdf3197413154d2b7, 0}) {
        std::string other = whole;
        std::memcpy(other.data() + layout_at, &layout, sizeof layout);
        ASSERT_NE(other, whole) << "a layout has to change with what a recording is made of";
        const InputReplay::Report report = RecordedInputs::play_bytes(other);
        EXPECT_EQ(report.problem, "another version of Tactus has recorded it: play it with that one");
        EXPECT_EQ(report.ticks, 0u);
    }
}

// Pieces that are sealed as they should be, of what nobody has recorded.
TEST(InputReplay, PiecesThatMakeNoSenseEndIt) {
    shared::Dice dice(7);
    for (int round = 0; round < 300; ++round) {
        SessionSettings settings;
        settings.max_bodies = settings.max_parts = 16;
        RecordedInputs inputs(settings, 1 << 16);
        SessionRig rig(settings, &inputs.recorder);
        rig.add(ground());
        rig.ticks(3);
        std::vector<std::byte> calls, ticks;
        inputs.recorder.drain(calls, ticks);
        for (int i = 0; i < 4; ++i) {
            std::vector<std::byte>& content = dice.one_in(2) ? calls : ticks;
            content[dice.below(content.size())] = static_cast<std::byte>(dice.below(256));
        }
        inputs.put(InputPiece::calls, calls);
        inputs.put(InputPiece::ticks, ticks);
        inputs.end();
        EXPECT_LE(inputs.play().ticks, 3u);
    }
}

// --- the haptic thread

TEST(InputRecorder, ATickThatIsRecordedAllocatesNothingWaitsForNobodyAndCallsNoSystem) {
    RecordedInputs inputs;
    SessionRig rig({}, &inputs.recorder);
    fill(rig);
    rig.session.settle();
    AuditScope audit;
    for (int i = 0; i < 2'000; ++i) {
        rig.device.position = hand_at(i);
        rig.tick();
    }
    audit.finish();
    EXPECT_EQ(audit.allocations() + audit.frees(), 0u) << audit.describe();
    EXPECT_EQ(audit.waits() + audit.system_calls(), 0u) << audit.describe();
    inputs.end();
    expect_whole(inputs.play(), 2'000);
}

TEST(InputRecorder, NeitherDoesOneOfALink) {
    const SessionSettings session = LinkedPlaces::session_settings();
    RecordedInputs near(session), far(session);
    LinkedPlaces places(0.02, 0.1, 1, {}, {}, 64, &near.recorder, &far.recorder);
    places.add(ground());
    places.settle();
    places.ticks(100);
    AuditScope audit;
    for (int i = 0; i < 500; ++i) {
        places.now += period;
        places.near.session.tick(places.now);
        places.far.session.tick(places.now);
    }
    audit.finish();
    EXPECT_EQ(audit.allocations() + audit.frees(), 0u) << audit.describe();
    near.end();
    expect_whole(near.play(), 600);
}

TEST(InputRecorder, WhatFindsNoRoomIsCountedAndEndsTheRecording) {
    RecordedInputs inputs({}, 16'384);
    SessionRig rig({}, &inputs.recorder);
    fill(rig);
    rig.session.settle();
    rig.ticks(10);
    inputs.drain();
    rig.ticks(1'000);
    inputs.drain();
    rig.ticks(10);
    const std::uint64_t lost = inputs.recorder.lost_ticks();
    EXPECT_GT(lost, 500u);
    inputs.end();
    const InputReplay::Report report = inputs.play();
    EXPECT_EQ(report.ticks + lost, 1'020u);
    EXPECT_EQ(report.lost, lost);
    EXPECT_EQ(report.first_different, 0u);
    EXPECT_NE(report.problem.find(std::to_string(lost) + " ticks"), std::string::npos);
}

}  // namespace
}  // namespace tactus::input_replay_test
