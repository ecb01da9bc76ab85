#include "shared/kicks.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <memory>

#include "core/mesh/closed_mesh.hpp"
#include "core/mesh/convex_hull.hpp"
#include "core/tool/tool_shape.hpp"
#include "session/session.hpp"
#include "shared/deforms.hpp"
#include "shared/meshes.hpp"
#include "shared/random_values.hpp"
#include "shared/slow_distance.hpp"

namespace tactus::shared {

namespace {

constexpr Nanoseconds period = 1'000'000;
constexpr double hand_step = 0.1;  // what the hand's way changes the force by in a tick (unit: newtons)

class Hand final : public Device {
public:
    DeviceSample read(Nanoseconds) override {
        return {position, Quat(1.0, 0.0, 0.0, 0.0), velocity, 0, true};
    }
    void write(Nanoseconds, const Vec3& given) override { force = given; }
    void twist(const Vec3& given) override { torque = given; }
    DeviceCapabilities capabilities() const override {
        DeviceCapabilities turned;
        turned.max_torque = DeviceCapabilities::any;
        return turned;
    }

    Vec3 position{0.0};
    Vec3 velocity{0.0};
    Vec3 force{0.0};
    Vec3 torque{0.0};
};

// What a hand is given, from tick to tick.
struct Given {
    Vec3 force{0.0};
    Vec3 torque{0.0};
};

// A form around its origin, about as large as `size`, and how far a point is from it.
struct Form {
    Shape shape;
    TriangleMesh mesh;    // empty: closed form
    bool solid = true;    // has an inside
    bool convex = true;   // nothing to slip off, where the hand goes towards the middle
    bool hollow = false;  // closed, and to be touched from inside as well

    double distance(const Vec3& local) const {
        if (!mesh.triangles.empty()) {
            return static_cast<double>(slow_distance(local, mesh));
        }
        return std::visit(
            [&](const auto& closed_form) {
                if constexpr (std::is_constructible_v<Solid, decltype(closed_form)>) {
                    return distance_to_solid(Solid(closed_form), local).distance;
                } else {
                    return 0.0;
                }
            },
            shape);
    }
};

Form form_of(const TriangleMesh& mesh, bool solid, bool one_sided) {
    return {MeshShape{std::make_shared<const TriangleMesh>(mesh), 0.0, one_sided}, mesh, solid, solid,
            solid && !one_sided};
}

Form random_form(RandomValues& random, double size) {
    switch (random.below(8)) {
        case 0:
            return {SphereShape{size}, {}, true};
        case 1:
            return {BoxShape{size * Vec3(1.0, random.between(0.4, 1.0), random.between(0.5, 1.0))}, {}, true};
        case 2:
            return {CapsuleShape{0.5 * size, 0.5 * size}, {}, true};
        case 3:
            return {CylinderShape{size, random.between(0.5, 1.0) * size}, {}, true};
        case 4:
            return form_of(icosphere(random.below(3) + 1, size), true, random.flip());
        case 5:
            return form_of(box(size * Vec3(1.0, random.between(0.4, 1.0), 0.7)), true, random.flip());
        case 6:
            return form_of(terrain(12, 2.0 * size, 0.2 * size), false, false);
        default:
            return form_of(soup(60, size, static_cast<unsigned>(random.below(1000))), false, false);
    }
}

// Whether its owner changes the hand or what is in it, not the scene around it.
constexpr bool is_of_the_hand(KickCase kick) {
    return kick == KickCase::hands || kick == KickCase::workspace || kick == KickCase::tool;
}

constexpr bool is_between_floors(KickCase kick) {
    return kick == KickCase::crosses || kick == KickCase::drags;
}

class KickPlay {
public:
    KickPlay(KickCase kick, std::uint64_t seed) : kick_(kick), random_(seed * 8 + static_cast<int>(kick)) {
        radius_ = random_.magnitude(0.002, 0.03);
        size_ = radius_ * random_.magnitude(1.5, 12.0);
        stiffness_ = random_.magnitude(200.0, 5000.0);
        form_ = kick == KickCase::squeezed || is_between_floors(kick)
                    ? Form{BoxShape{Vec3(1.0, 0.2, 1.0) * size_}, {}, true}
                    : random_form(random_, size_);
        if (kick == KickCase::squeezed && random_.flip()) {
            form_ = form_of(box(Vec3(1.0, 0.2, 1.0) * size_), true, random_.flip());
        }
        if (kick == KickCase::deforms) {
            form_ = form_of(random_.flip() ? icosphere(2, size_) : terrain(10, 3.0 * size_, 0.2 * size_),
                            false, false);
            form_.solid = is_closed(form_.mesh);
            rest_ = form_.mesh;
            touch_ = touch_of(rest_);
        }
        workspace_.force_limit = random_.flip() ? 8.0 : 1e6;
        device_ = session_.add_device(hand_, workspace_).handle;
        other_device_ = session_.add_device(other_hand_, workspace_).handle;
        tool_.device = proxy_.device = device_;
        proxy_.settings.radius = radius_;
        proxy_.force_law = random_.below(4) == 0 ? ForceLaw::smoothed : ForceLaw::spring;
        if (kick == KickCase::tool) {
            tool_shape_ = make_tool_shape(box(Vec3(2.0, 1.2, 1.0) * radius_), {0.1 * radius_, 500}).shape;
            tool_.settings.stiffness = stiffness_ = random_.magnitude(300.0, 2000.0);
            tool_.settings.turning_stiffness = random_.magnitude(0.1, 2.0);
        }
        take_in_hand();
    }

    KickFigures play();

private:
    BodyAddition body(const Form& form, const Pose& pose, Motion motion) {
        BodyAddition addition;
        addition.description.shapes = {PlacedShape{form.shape, Pose{}}};
        addition.description.pose = pose;
        addition.description.motion = motion;
        addition.touch_material = material(stiffness_);
        addition.touch = kick_ == KickCase::deforms ? touch_ : nullptr;
        return addition;
    }
    TouchMaterial material(double stiffness) {
        const double friction = friction_;
        return {stiffness, 0.0, friction, 0.8 * friction};
    }

    // What the case touches with.
    void take_in_hand() {
        if (kick_ == KickCase::tool) {
            tool_handle_ = session_.add_tool(tool_shape_, tool_).handle;
        } else {
            proxy_handle_ = session_.add_proxy(proxy_).handle;
        }
    }
    void put_down() {
        if (kick_ == KickCase::tool) {
            session_.remove_tool(tool_handle_);
        } else {
            session_.remove_proxy(proxy_handle_);
        }
    }
    void set_in_hand() {
        if (kick_ == KickCase::tool) {
            session_.set_tool(tool_handle_, tool_);
        } else {
            session_.set_proxy(proxy_handle_, proxy_);
        }
    }
    Vec3 place() const {
        return kick_ == KickCase::tool ? session_.snapshot().tools[0].pose.position
                                       : session_.snapshot().proxies[0].position;
    }
    void set_workspace(const Workspace& workspace) { session_.set_workspace(device_, workspace); }

    void add() { body_ = session_.add_body(body(form_, pose_, Motion::Static)).handle; }
    void tick(const Vec3& to);
    void note(const Hand& hand, Given& before);
    void draw(const Vec3& to);
    void wait(int ticks);
    void judge(const ProxyState& state);
    void event();
    void teleport();
    void see();
    void come_or_go();
    void change_hands();
    void change_workspace();
    void change_around_tool();
    void give_back();
    void approach();
    void squeeze();
    SessionHandle add_floor(double half, double side, double height, double stiffness);
    void cross();
    void drag();
    void leave_and_come_back();
    Pose near_hand(double farthest);
    double pace() const { return hand_step / std::max(stiffness_, stiffest_); }
    double size() const { return std::max(size_, radius_); }

    KickCase kick_;
    RandomValues random_;
    double radius_ = 0.0, size_ = 0.0, stiffness_ = 0.0, friction_ = 0.0, stiffest_ = 0.0;
    Form form_;
    TriangleMesh rest_;
    std::shared_ptr<const TouchShape> touch_;
    Pose pose_;
    Hand hand_, other_hand_;
    Session session_{SessionSettings{}};
    SessionHandle device_ = no_handle, other_device_ = no_handle;
    Workspace workspace_;
    SessionHandle proxy_handle_ = no_handle;
    ProxyDescription proxy_;
    SessionHandle tool_handle_ = no_handle;
    std::shared_ptr<const ToolShape> tool_shape_;
    ToolUse tool_;
    SessionHandle body_ = no_handle;
    bool judged_ = true;
    bool still_ = false;  // the hand, too: whatever changes the force is the scene
    bool had_let_out_ = false;
    Given before_, other_before_;
    Nanoseconds now_ = 0;
    KickFigures figures_;
};

void KickPlay::tick(const Vec3& to) {
    hand_.velocity = (to - hand_.position) * 1e3;
    hand_.position = to;
    session_.tick(now_ += period);
    session_.collect();
    session_.refresh();
    const ProxyState& state = session_.snapshot().proxies[0];
    note(hand_, before_);
    note(other_hand_, other_before_);
    ++figures_.ticks;
    const bool letting_out = (state.status & (proxy_letting_out | proxy_absent)) != 0;
    figures_.let_out += letting_out && !had_let_out_;
    had_let_out_ = letting_out;
    if (judged_ && kick_ != KickCase::tool && proxy_.enabled && !letting_out && body_ != no_handle &&
        figures_.ticks % 7 == 0) {
        judge(state);
    }
}

void KickPlay::note(const Hand& hand, Given& before) {
    if (still_ || form_.convex) {
        figures_.force_step_max = std::max(figures_.force_step_max, glm::distance(hand.force, before.force));
        figures_.torque_step_max =
            std::max(figures_.torque_step_max, glm::distance(hand.torque, before.torque));
    }
    figures_.force_max = std::max(figures_.force_max, glm::length(hand.force));
    before = {hand.force, hand.torque};
}

void KickPlay::judge(const ProxyState& state) {
    const Vec3 local = to_local(pose_, state.position);
    figures_.overlaps += form_.distance(local) < 0.45 * radius_;
}

// Straight there, as fast as the stiffness allows, with a tremor.
void KickPlay::draw(const Vec3& to) {
    while (glm::distance(hand_.position, to) > pace()) {
        const Vec3 step = pace() * glm::normalize(to - hand_.position);
        tick(hand_.position + step);
    }
    tick(to);
}

void KickPlay::wait(int ticks) {
    const Vec3 around = hand_.position;
    still_ = !form_.convex || is_of_the_hand(kick_) || random_.flip();
    for (int i = 0; i < ticks; ++i) {
        if (still_) {
            tick(around);
            continue;
        }
        const Vec3 wanted = around + random_.in_ball(4.0 * pace());
        const Vec3 way = wanted - hand_.position;
        const double length = glm::length(way);
        tick(length > pace() ? hand_.position + way * (pace() / length) : wanted);
    }
    still_ = false;
}

Pose KickPlay::near_hand(double farthest) {
    return {hand_.position + random_.in_ball(farthest), random_.rotation()};
}

// Presses against the body until up to some newtons are felt, or finds nothing on the way.
void KickPlay::approach() {
    const double deep = std::min(random_.between(0.5, 6.0) / stiffness_, 0.12 * size_);
    const Vec3 target = pose_.position;
    for (int i = 0; i < 4'000 && glm::distance(hand_.position, target) > pace(); ++i) {
        tick(hand_.position + pace() * glm::normalize(target - hand_.position));
        if (glm::distance(place(), hand_.position) > deep) {
            return;
        }
    }
}

void KickPlay::teleport() {
    const bool little = random_.flip();
    pose_ = little ? Pose{pose_.position + random_.in_ball(random_.magnitude(0.01, 3.0) * radius_),
                          pose_.rotation}
                   : near_hand(1.2 * size_ + radius_);
    session_.teleport_body(body_, pose_);
}

// By a camera that has moved, or by what it is seen by.
void KickPlay::see() {
    const double off = random_.magnitude(1e-4, 0.02);
    pose_.position += off * random_.direction();
    pose_.rotation =
        glm::normalize(turn_by(random_.direction(), random_.between(0.0, 0.05)) * pose_.rotation);
    BodySighting sighting;
    sighting.motion.pose = pose_;
    session_.see_body(body_, sighting);
}

void KickPlay::come_or_go() {
    if (body_ != no_handle) {
        session_.remove_body(body_);
        body_ = no_handle;
    } else {
        add();
    }
}

// What touches is removed, and another one comes; it is switched off or on; the other hand takes it, which is
// where the first one is, or elsewhere.
void KickPlay::change_hands() {
    switch (random_.below(4)) {
        case 0:
            put_down();
            take_in_hand();
            break;
        case 1:
            proxy_.enabled = tool_.enabled = !proxy_.enabled;
            set_in_hand();
            break;
        default:
            other_hand_.position =
                hand_.position + (random_.flip() ? Vec3(0.0) : random_.in_ball(3.0 * size_));
            tool_.device = proxy_.device = proxy_.device == device_ ? other_device_ : device_;
            set_in_hand();
    }
}

// By a little, as a camera takes it along, or anywhere. A limit that is lowered holds at once, and is no
// kick; so it is only raised.
void KickPlay::change_workspace() {
    Workspace changed = workspace_;
    switch (random_.below(5)) {
        case 0:
            changed.pose.position = random_.in_ball(random_.magnitude(0.01, 3.0) * radius_);
            break;
        case 1:
            changed.pose = {random_.in_ball(size_), random_.rotation()};
            break;
        case 2:
            changed.scale = random_.magnitude(0.3, 3.0);
            break;
        case 3:
            changed.force_scale = random_.magnitude(0.3, 3.0);
            break;
        default:
            changed.force_limit = workspace_.force_limit = random_.magnitude(workspace_.force_limit, 1e7);
    }
    set_workspace(changed);
}

void KickPlay::change_around_tool() {
    switch (body_ == no_handle ? 0 : random_.below(4)) {
        case 0:
            come_or_go();
            break;
        case 1:
            teleport();
            break;
        case 2:
            change_hands();
            break;
        default:
            tool_.settings.stiffness = random_.magnitude(300.0, 2000.0);
            stiffest_ = 2000.0;
            set_in_hand();
    }
}

// All as it began: the first hand has it, in its own workspace.
void KickPlay::give_back() {
    proxy_.enabled = tool_.enabled = true;
    tool_.device = proxy_.device = device_;
    set_in_hand();
    set_workspace(workspace_);
    wait(60);
}

void KickPlay::event() {
    ++figures_.events;
    switch (kick_) {
        case KickCase::appears:
            if (body_ != no_handle) {
                session_.remove_body(body_);
            }
            pose_ = near_hand(1.2 * size_ + radius_);
            add();
            break;
        case KickCase::teleports:
            teleport();
            break;
        case KickCase::hands:
            change_hands();
            break;
        case KickCase::workspace:
            change_workspace();
            break;
        case KickCase::tool:
            change_around_tool();
            break;
        case KickCase::grows:
            radius_ = std::clamp(radius_ * random_.magnitude(0.3, 4.0), 0.001, 0.1);
            proxy_.settings.radius = radius_;
            session_.set_proxy(proxy_handle_, proxy_);
            break;
        case KickCase::vanishes:
            come_or_go();
            break;
        case KickCase::stiffens:
            stiffest_ = std::max(stiffest_, 5000.0);
            session_.set_touch_material(body_, material(random_.magnitude(50.0, 5000.0)));
            break;
        case KickCase::deforms: {
            const RandomWay way(random_, random_.between(0.1, 5.0) * radius_, size_, !form_.solid);
            form_.mesh = moved(rest_, way);
            touch_ = refitted(*touch_, form_.mesh);
            form_.shape = MeshShape{std::make_shared<const TriangleMesh>(form_.mesh)};
            session_.deform_body(body_, session_.prepare_body(body(form_, pose_, Motion::Static)));
            break;
        }
        case KickCase::seen:
            see();
            break;
        case KickCase::squeezed:
        case KickCase::crosses:
        case KickCase::drags:
            break;
    }
}

// A plate comes down on a hand that lies on the ground, or on another plate, and goes up again.
void KickPlay::squeeze() {
    const double way = pace();
    const double pressed = random_.between(0.0, 4.0) / stiffness_;
    const double half = 0.2 * size_;
    const Vec3 aside(random_.between(-0.8, 0.8) * size_, 0.0, random_.between(-0.8, 0.8) * size_);
    const Form ground{BoxShape{Vec3(2.0, 0.5, 2.0) * size_}, {}, true};
    session_.add_body(body(ground, {Vec3(0.0, -0.5 * size_, 0.0), Quat(1, 0, 0, 0)}, Motion::Static));
    double height = 6.0 * radius_ + half;
    pose_ = {aside + Vec3(0.0, height, 0.0), Quat(1.0, 0.0, 0.0, 0.0)};
    tick({0.0, radius_ + 0.1 * way, 0.0});
    add();
    judged_ = false;
    draw({0.0, radius_ - pressed, 0.0});
    for (int round = 0; round < 2; ++round) {
        ++figures_.events;
        const double lowest = half + random_.between(-0.5, 1.8) * radius_;
        for (const double target : {lowest, 6.0 * radius_ + half}) {
            while (height != target) {
                height = target < height ? std::max(target, height - way) : std::min(target, height + way);
                pose_.position.y = height;
                session_.move_body(body_, pose_, 1e-3);
                tick(hand_.position);
            }
            wait(30);
        }
    }
    judged_ = true;
}

SessionHandle KickPlay::add_floor(double half, double side, double height, double stiffness) {
    BodyAddition floor =
        body({BoxShape{Vec3(half)}, {}, true},
             {Vec3(side * half, height - half, 0.0), Quat(1.0, 0.0, 0.0, 0.0)}, Motion::Static);
    floor.touch_material = material(stiffness);
    return session_.add_body(floor).handle;
}

// From a floor to another one beside it, or against a wall that stands on it, and back.
void KickPlay::cross() {
    const double other = random_.magnitude(100.0, 5000.0);
    stiffest_ = 2.0 * std::max(stiffness_, other);  // over an edge the proxy goes farther than the hand
    const double step = random_.flip() ? 0.0 : random_.between(0.1, 4.0) * radius_;
    add_floor(5.0 * size_, -1.0, 0.0, stiffness_);
    add_floor(5.0 * size_, 1.0, step, other);
    const double pressed = random_.between(0.5, 6.0) / stiffness_;
    const double far = 2.0 * radius_ + 3.0 * pressed;
    hand_.position = {-far, 2.0 * radius_, 0.0};
    tick(hand_.position);
    for (int round = 0; round < 2; ++round) {
        ++figures_.events;
        draw({-far, radius_ - pressed, 0.0});
        draw({far, radius_ - pressed, random_.between(-1.0, 1.0) * radius_});
        wait(60);
    }
}

// To and fro over the border of two floors, of which one becomes another one on the way.
void KickPlay::drag() {
    friction_ = 0.0;
    const double other = random_.magnitude(100.0, 5000.0);
    stiffest_ = 5000.0;
    const SessionHandle floors[] = {add_floor(1.0, -1.0, 0.0, stiffness_), add_floor(1.0, 1.0, 0.0, other)};
    const double step = 1e-3 * random_.magnitude(0.05, 1.5);
    const double far = std::max(0.1, 2.0 * radius_);
    const double deep = std::min(random_.magnitude(1.0, 60.0) / stiffest_, 0.9 * radius_);
    hand_.position = {-far, 2.0 * radius_, 0.0};
    tick(hand_.position);
    draw({-far, radius_ - deep, 0.0});
    for (int round = 0; round < 4; ++round) {
        const double to = hand_.position.x < 0.0 ? far : -far;
        const double changes_at = random_.flip() ? random_.between(-far, far) : 2.0 * far;
        for (bool has_changed = false; hand_.position.x != to;) {
            const double x = hand_.position.x;
            tick({to > 0.0 ? std::min(to, x + step) : std::max(to, x - step), hand_.position.y, 0.0});
            if (!has_changed && std::abs(hand_.position.x - changes_at) <= step) {
                has_changed = true;
                ++figures_.events;
                session_.set_touch_material(floors[random_.below(2)],
                                            material(random_.magnitude(100.0, 5000.0)));
            }
        }
        ++figures_.events;
        wait(60);
    }
}

// However it began: far away nothing is felt, and who comes back from outside feels the body again.
void KickPlay::leave_and_come_back() {
    const Vec3 away = glm::normalize(hand_.position - pose_.position + 1e-3 * random_.direction());
    const double rim = form_.mesh.triangles.empty() ? 3.0 * size_ : 3.5 * size_;
    draw(pose_.position + away * (rim + 3.0 * radius_));
    wait(60);
    if (body_ == no_handle || !form_.convex) {
        return;  // a sheet holds from both sides
    }
    // A pointer that begins anew within a shell is in it. A tool may be a step behind the hand in the air.
    const bool began_anew = kick_ == KickCase::hands;
    const double nothing = kick_ == KickCase::tool ? 1e-2 : 1e-9;
    figures_.imprisoned += glm::length(hand_.force) > nothing && !(form_.hollow && began_anew);
    for (int i = 0; i < 40'000; ++i) {
        const Vec3 way = pose_.position - hand_.position;
        if (glm::length(way) < pace() || glm::length(hand_.force) > 0.5) {
            break;
        }
        tick(hand_.position + glm::normalize(way) * pace());
    }
    figures_.untouchable += !(glm::length(hand_.force) > 0.5);
}

KickFigures KickPlay::play() {
    friction_ = random_.flip() ? 0.0 : random_.between(0.1, 1.0);
    if (kick_ == KickCase::squeezed) {
        squeeze();
        return figures_;
    }
    if (is_between_floors(kick_)) {
        kick_ == KickCase::crosses ? cross() : drag();
        return figures_;
    }
    hand_.position = (3.0 * size_ + 2.0 * radius_) * random_.direction();
    tick(hand_.position);
    if (kick_ != KickCase::appears) {
        pose_ = {Vec3(0.0), random_.rotation()};
        add();
        wait(3);
    }
    for (int i = 0; i < 4; ++i) {
        if (kick_ != KickCase::appears || random_.flip()) {
            approach();
        }
        event();
        wait(60);
        if (is_of_the_hand(kick_)) {
            give_back();
        }
    }
    leave_and_come_back();
    return figures_;
}

}  // namespace

std::string_view name_of(KickCase kick) {
    constexpr std::string_view names[] = {"appears",  "teleports", "grows",   "squeezed", "vanishes",
                                          "stiffens", "deforms",   "crosses", "hands",    "workspace",
                                          "tool",     "seen",      "drags"};
    return names[static_cast<std::size_t>(kick)];
}

void KickFigures::add(const KickFigures& other) {
    force_step_max = std::max(force_step_max, other.force_step_max);
    torque_step_max = std::max(torque_step_max, other.torque_step_max);
    force_max = std::max(force_max, other.force_max);
    events += other.events;
    let_out += other.let_out;
    overlaps += other.overlaps;
    imprisoned += other.imprisoned;
    untouchable += other.untouchable;
    ticks += other.ticks;
}

KickFigures play_kick(KickCase kick, std::uint64_t seed) {
    return KickPlay(kick, seed).play();
}

}  // namespace tactus::shared
