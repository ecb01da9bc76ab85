#include "shared/attack_rig.hpp"

#include "shared/endpoints.hpp"

namespace tactus::shared {
namespace {

SessionSettings small_session() {
    SessionSettings settings;
    settings.max_bodies = 32;
    settings.max_parts = 128;
    return settings;
}

BodyAddition body(const Shape& shape, const Vec3& position, Motion motion, double mass = 1.0) {
    BodyAddition addition;
    addition.description.shapes = {PlacedShape{shape, Pose{}}};
    addition.description.pose.position = position;
    addition.description.motion = motion;
    addition.description.mass = mass;
    addition.touch_material = {AttackRig::stiffness, 0.0, 0.0, 0.0};
    return addition;
}

}  // namespace

AttackPlace::AttackPlace() : session(small_session()) {}

void AttackPlace::fill(bool far) {
    Workspace workspace;
    workspace.force_limit = 10.0;
    ProxyDescription pointer;
    pointer.device = session.add_device(device, workspace).handle;
    pointer.settings.mask = AttackRig::touchable;
    session.add_proxy(pointer);
    // A body of its own, on a layer that no pointer touches, apart from all others.
    BodyAddition apart = body(BoxShape{Vec3(0.05)}, {5.0, 1.0, 0.0}, Motion::Dynamic, 0.3);
    apart.description.gravity_scale = 0.0;
    apart.description.collision = {AttackRig::untouchable, AttackRig::untouchable};
    own = session.add_body(apart).handle;
    if (far) {
        session.add_body(body(BoxShape{{1.0, 0.05, 1.0}}, {0.0, -0.05, 0.0}, Motion::Static));
        box = session.add_body(body(BoxShape{Vec3(0.05)}, {0.0, 0.05, 0.0}, Motion::Dynamic, 0.3)).handle;
    }
    session.settle();
}

const BodyState* AttackPlace::body_state(SessionHandle body) const {
    const SessionSnapshot& snapshot = session.snapshot();
    return state_of(snapshot.bodies, snapshot.body_count, body);
}

Vec3 AttackPlace::place_of(SessionHandle body) const {
    const BodyState* const state = body_state(body);
    return state ? state->pose.position : Vec3(0.0);
}

AttackRig::AttackRig(bool sealed, const LinkConditions& conditions)
    : near_way_(near_tap_, {}, 1), far_way_(far_tap_, conditions, 2) {
    const SharedSecret secret{SecretKey{1, 2, 3}, {}};
    if (sealed) {
        near_seal_ = std::make_unique<SealedLink>(near_way_, secret);
        far_seal_ = std::make_unique<SealedLink>(far_way_, secret);
    }
    const auto link = [](std::unique_ptr<SealedLink>& seal, LinkEmulator& way) -> Link& {
        return seal ? static_cast<Link&>(*seal) : way;
    };
    near = std::make_unique<AttackPlace>();
    far = std::make_unique<AttackPlace>();
    near->session.attach(std::make_unique<OperatorSide>(
        near->session.settings(), OperatorRoom{}, TeleopSettings{}, link(near_seal_, near_way_), near->port,
        endpoint(Side::operator_side, near_epoch)));
    far->session.attach(std::make_unique<TeleoperatorSide>(far->session.settings(), TeleopSettings{},
                                                           link(far_seal_, far_way_), far->port,
                                                           endpoint(Side::teleoperator_side, far_epoch)));
    near->fill(false);
    far->fill(true);
    builder_ = std::make_unique<ModelBuilder>(near->session, near->port);
    teller_ = std::make_unique<EnvironmentTeller>(far->port);
    // What is touched; the body of its own is not described.
    teller_->tell(1, "Ground", body(BoxShape{{1.0, 0.05, 1.0}}, {0.0, -0.05, 0.0}, Motion::Static));
    teller_->tell(far->box, "Box", body(BoxShape{Vec3(0.05)}, {0.0, 0.05, 0.0}, Motion::Dynamic, 0.3));
}

void AttackRig::tick() {
    now += period;
    near->tick(now);
    far->tick(now);
    if (now / period % 16 == 0) {
        model_changes += builder_->update(now, near->statistics().link) ? 1 : 0;
        teller_->update(far->session.snapshot(), far->statistics().link.peer_epoch);
    }
}

void AttackRig::press() {
    ticks(1200);
    const Vec3 from = near->device.position;
    for (int i = 0; i < 200; ++i) {
        near->device.position.y = from.y - (from.y - 0.105) * i / 199.0;
        tick();
    }
    ticks(400);
}

bool AttackRig::both_connected() const {
    return near->statistics().link.peer == PeerState::connected &&
           far->statistics().link.peer == PeerState::connected;
}

}  // namespace tactus::shared
