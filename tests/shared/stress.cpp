#include "shared/stress.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <deque>
#include <optional>

#include "core/haptics/force_law.hpp"
#include "platform/clock.hpp"
#include "shared/deforms.hpp"
#include "shared/meshes.hpp"
#include "shared/reference_descent.hpp"
#include "shared/stress_judge.hpp"
#include "shared/stress_scenes.hpp"
#include "shared/touch_rig.hpp"

namespace tactus::shared {

namespace {

constexpr std::size_t max_failures = 40;
constexpr double short_of_end = 1e-3;  // so far from where descent ends it has not arrived (in radii)

// Of this thread (unit: microseconds).
double processor_time() {
    return 1e-3 * static_cast<double>(thread_time());
}

// A second body that appears where the proxy is, jumps and vanishes.
class Visitor {
public:
    Visitor(RandomValues& random, double radius) : random_(random) {
        const double size = radius * random.magnitude(0.3, 5.0);
        kind_ = random.below(4);
        const Vec3 half = size * Vec3(1.0, random.between(0.05, 1.0), random.between(0.3, 1.0));
        mesh_ = kind_ == 0 ? box(half) : icosphere(1 + random.below(2), size);
        const PlacedShape placed{kind_ < 2 ? Shape(MeshShape{std::make_shared<const TriangleMesh>(mesh_)})
                                           : (kind_ == 2 ? Shape(BoxShape{half}) : Shape(SphereShape{size})),
                                 {}};
        shape_ = make_touch_shape({&placed, 1}).shape;
        tree_.emplace(mesh_);
        judge_ = kind_ < 2 ? BodyJudge::of_mesh(*tree_)
                           : (kind_ == 2 ? BodyJudge::of_box(half) : BodyJudge::of_ball(size));
    }
    Visitor(const Visitor&) = delete;
    Visitor& operator=(const Visitor&) = delete;

    // True where it came or jumped in this tick.
    bool act(TouchScene& scene, const Vec3& proxy, double radius, const TouchMaterial& material) {
        if (random_.below(80) != 0) {
            return false;
        }
        const Pose pose{proxy + radius * random_.in_ball(6.0), random_.rotation()};
        if (body_ >= 0 && random_.flip()) {
            scene.remove(body_);
            body_ = -1;
            return false;
        }
        if (body_ < 0) {
            body_ = scene.add(*shape_, pose, material, 1);
        } else {
            scene.set_pose(body_, pose, true);
        }
        judge_.changed();
        judge_.place(pose);
        return true;
    }

    bool is_there() const { return body_ >= 0; }
    BodyJudge& judge() { return judge_; }

private:
    RandomValues& random_;
    int kind_ = 0;
    TriangleMesh mesh_;
    std::shared_ptr<const TouchShape> shape_;
    std::optional<JudgeTree> tree_;
    BodyJudge judge_;
    int body_ = -1;
};

// A plate that comes down on whatever is below it and goes up again; at its lowest it leaves half the
// sphere's width.
class Press {
public:
    Press(RandomValues& random, const StressSetting& setting)
        : radius_(setting.world_radius()),
          half_(radius_ * Vec3(30.0, random.magnitude(0.01, 1.0), 30.0)),
          period_(200 + random.below(800)),
          above_(setting.to_world(setting.around)),
          shape_(touch_of(half_)),
          judge_(BodyJudge::of_box(half_)) {}

    // Two boxes: this one and a floor that stands still.
    void begin(TouchScene& scene, const TouchMaterial& material) {
        floor_ = scene.add(*shape_, floor_pose(), material, 1);
        body_ = scene.add(*shape_, pose(0), material, 1);
    }
    void act(TouchScene& scene, int tick) {
        scene.set_pose(body_, pose(tick));
        judge_.place(pose(tick));
        floor_judge_.place(floor_pose());
    }
    bool has_room(int tick) const { return gap(tick) > 2.001 * radius_; }
    BodyJudge& judge() { return judge_; }
    BodyJudge& floor_judge() { return floor_judge_; }

private:
    static std::shared_ptr<const TouchShape> touch_of(const Vec3& half) {
        const PlacedShape placed{BoxShape{half}, {}};
        return make_touch_shape({&placed, 1}).shape;
    }
    double gap(int tick) const {
        return radius_ * (3.25 + 2.25 * std::cos(6.283185307179586 * tick / period_));
    }
    Pose floor_pose() const { return {above_ - Vec3(0.0, half_.y + 2.75 * radius_, 0.0), Quat(1, 0, 0, 0)}; }
    Pose pose(int tick) const {
        return {above_ + Vec3(0.0, half_.y - 2.75 * radius_ + gap(tick), 0.0), Quat(1, 0, 0, 0)};
    }

    double radius_;
    Vec3 half_;
    int period_;
    Vec3 above_;
    std::shared_ptr<const TouchShape> shape_;
    BodyJudge judge_, floor_judge_ = BodyJudge::of_box(half_);
    int floor_ = -1, body_ = -1;
};

struct Kind {
    bool dense = false, friction = false, moving = false, deforming = false, visited = false, pressed = false;

    bool may_excuse() const { return moving || deforming || visited || pressed; }
    // What stands still in its form lets nobody through, whatever comes and presses.
    bool main_may_let_out() const { return moving || deforming; }
};

// One case, played from its seed; judged where somebody counts.
class StressCase {
public:
    StressCase(std::uint64_t seed, const StressOptions& options)
        : seed_(seed), options_(options), random_(seed), kind_(choose()), setting_(make()), rig_(radius()) {}

    // The processor time of each tick where timed.
    std::vector<double> play(StressCounts* counts);

private:
    Kind choose() {
        Kind kind;
        kind.dense = options_.dense && seed_ % 50 == 0;
        kind.friction = random_.flip();
        const int events = random_.below(8);
        kind.moving = events < 2;
        kind.deforming = options_.deforming && events == 2;
        kind.visited = events == 3;
        kind.pressed = !kind.dense && events == 4;
        return kind;
    }
    StressSetting make() { return kind_.dense ? make_dense_setting(random_) : make_small_setting(random_); }
    double radius() const { return setting_.world_radius(); }
    bool add_body();
    void deform_body(StressCounts* counts);
    void judge(int tick, const Vec3& hand, const Vec3& before, const ProxyTick& at, StressCounts& counts);
    void judge_side(int tick, const Vec3& local, const Vec3& hand, const ProxyTick& at, StressCounts& counts);
    void judge_end(int tick, const Vec3& hand, const Vec3& before, const Vec3& local, const ProxyTick& at,
                   StressCounts& counts);
    void fail(const char* what, int tick, const Vec3& hand, const ProxyTick& at, double number,
              StressCounts& counts);

    std::uint64_t seed_;
    StressOptions options_;
    RandomValues random_;
    Kind kind_;
    StressSetting setting_;
    TouchRig rig_;
    TouchMaterial material_;
    std::deque<std::shared_ptr<const TouchShape>> forms_;
    int body_ = -1;
    Pose pose_;

    std::optional<JudgeTree> own_tree_;
    const JudgeTree* tree_ = nullptr;
    std::optional<BodyJudge> main_;
    std::optional<ReferenceDescent> reference_;
    std::optional<Visitor> visitor_;
    std::optional<Press> press_;
    SideJudge side_;
    const char* told_ = nullptr;
};

// Half of all meshes are touched through what the sphere can touch of them.
bool StressCase::add_body() {
    material_.static_friction = kind_.friction ? 0.4 : 0.0;
    material_.dynamic_friction = kind_.friction ? 0.3 : 0.0;
    if (!setting_.shape) {
        const PlacedShape placed{MeshShape{setting_.mesh}, {}};
        setting_.shape = make_touch_shape({&placed, 1}).shape;
        if (!setting_.shape) {
            return false;  // all slivers of this seed have no area at all: such a mesh is refused
        }
        own_tree_.emplace(*setting_.mesh);
        if (const auto narrower = seed_ / 2 % 2 == 0 ? narrowed(*setting_.shape, radius()) : nullptr) {
            setting_.shape = narrower;
        }
    } else if (seed_ % 100 == 0) {
        setting_.shape = narrowed_dense(setting_);
    }
    tree_ = setting_.tree ? setting_.tree : &*own_tree_;
    forms_.push_back(setting_.shape);
    kind_.deforming = kind_.deforming && setting_.deforms && own_tree_;
    main_ = BodyJudge::of_mesh(*tree_);
    reference_.emplace(*tree_, radius());
    body_ = rig_.scene.add(*setting_.shape, {}, material_, 1);
    if (kind_.visited) {
        visitor_.emplace(random_, radius());
    }
    if (kind_.pressed) {
        press_.emplace(random_, setting_);
        press_->begin(rig_.scene, material_);
    }
    return body_ >= 0;
}

void StressCase::deform_body(StressCounts* counts) {
    deform(setting_, random_, radius() * random_.magnitude(0.01, 10.0));
    forms_.push_back(refitted(*forms_.back(), *setting_.mesh));
    own_tree_->moved();
    main_->changed();
    if (counts) {
        ++counts->deformations;
    }
}

void StressCase::judge_side(int tick, const Vec3& local, const Vec3& hand, const ProxyTick& at,
                            StressCounts& counts) {
    if (!setting_.side || tick % 16 != 0) {
        return;
    }
    const Vec3 seen = setting_.from_world(local);
    // Beyond the sheets' rims the way leads around.
    const bool within = std::max({std::abs(seen.x), std::abs(seen.y), std::abs(seen.z)}) < stress_sheet_end;
    const std::optional<int> side = within ? std::optional(setting_.side(setting_, local)) : std::nullopt;
    if (side_.has_passed(side)) {
        ++counts.passes;
        fail("pass", tick, hand, at, *side, counts);
    }
}

void StressCase::judge_end(int tick, const Vec3& hand, const Vec3& before, const Vec3& local,
                           const ProxyTick& at, StressCounts& counts) {
    const bool unfinished = (at.status & proxy_unfinished) != 0;
    counts.unfinished_ticks += unfinished;
    const int every = kind_.dense ? 1'009 : 101;
    if (kind_.friction || kind_.visited || kind_.pressed || main_->is_excused() ||
        rig_.proxy.touching().empty() || !(unfinished ? tick % 7 == 0 : tick % every == 0)) {
        return;
    }
    const Vec3 local_hand = to_local(pose_, hand);
    const ReferencePlace place = reference_->settle(local, local_hand);
    const double error = static_cast<double>(glm::distance(place.position, SlowVec3(local))) / radius();
    ++counts.checked_ticks;
    const bool is_short = error > short_of_end;
    if (is_short && reference_->is_balanced(local, local_hand, place.position, short_of_end * radius())) {
        ++counts.balanced_ticks;
        return;
    }
    if (is_short && glm::distance(before, at.position) < short_of_end * radius()) {
        ++counts.stuck_ticks;
        fail("stuck", tick, hand, at, error, counts);
    }
    if (unfinished) {
        return;
    }
    counts.error_max = std::max(counts.error_max, error);
    if (is_short) {
        ++counts.false_ends;
        fail("false end", tick, hand, at, error, counts);
    }
}

void StressCase::judge(int tick, const Vec3& hand, const Vec3& before, const ProxyTick& at,
                       StressCounts& counts) {
    const Vec3& p = at.position;
    ++counts.ticks;
    counts.friction_ticks += kind_.friction;
    counts.moving_ticks += kind_.moving;
    counts.dense_ticks += kind_.dense;
    if (!std::isfinite(p.x + p.y + p.z)) {
        ++counts.nans;
        fail("NaN", tick, hand, at, 0.0, counts);
        return;
    }
    if (at.status & proxy_absent) {
        side_.excuse();
        return;
    }
    if (!kind_.may_excuse() && tick > 0) {
        const double thrown = (glm::distance(p, hand) - glm::distance(before, hand)) / radius();
        counts.thrown_max = std::max(counts.thrown_max, thrown);
    }
    counts.contact_ticks += (at.status & proxy_touching) != 0;
    const bool excused = (at.status & (proxy_squeezed | proxy_letting_out)) != 0;
    if (excused && !kind_.may_excuse()) {
        ++counts.false_excuses;
        fail("excuse", tick, hand, at, 0.0, counts);
    }
    counts.excused_ticks += excused;
    const bool no_room = press_ && !press_->has_room(tick);
    const auto watch = [&](BodyJudge& body, const char* what) {
        if (excused || no_room) {
            body.excuse();
        }
        if (body.is_penetrated(p, radius())) {
            ++counts.penetrations;
            fail(what, tick, hand, at, radius() - body.distance(p, radius()), counts);
        }
    };
    watch(*main_, "penetration");
    if (visitor_ && visitor_->is_there()) {
        watch(visitor_->judge(), "penetration of a visitor");
    }
    if (press_) {
        watch(press_->judge(), "penetration of a press");
        watch(press_->floor_judge(), "penetration of a floor");
    }
    const Vec3 local = to_local(pose_, p);
    if (kind_.main_may_let_out() && (excused || main_->is_excused())) {
        side_.excuse();
    } else {
        judge_side(tick, local, to_local(pose_, hand), at, counts);
    }
    judge_end(tick, hand, before, local, at, counts);
}

void StressCase::fail(const char* what, int tick, const Vec3& hand, const ProxyTick& at, double number,
                      StressCounts& counts) {
    // One of a kind and case tells enough.
    if (what == told_ || counts.failures.size() >= max_failures) {
        return;
    }
    told_ = what;
    char text[400];
    std::snprintf(text, sizeof text,
                  "%s: seed %llu (%s, scale %.3g, radius %.3g, at %.3g%s%s%s%s%s), tick %d, by %.3g, status "
                  "%u, proxy %.17g %.17g %.17g, hand %.17g %.17g %.17g",
                  what, static_cast<unsigned long long>(seed_), setting_.name, setting_.scale, radius(),
                  glm::length(setting_.place), kind_.friction ? ", friction" : "",
                  kind_.moving ? ", moving" : "", kind_.deforming ? ", deforming" : "",
                  kind_.visited ? ", visited" : "", kind_.pressed ? ", pressed" : "", tick, number, at.status,
                  at.position.x, at.position.y, at.position.z, hand.x, hand.y, hand.z);
    counts.failures.emplace_back(text);
}

std::vector<double> StressCase::play(StressCounts* counts) {
    std::vector<double> times;
    if (!add_body()) {
        return times;
    }
    StressHand hand(random_, setting_.reach, setting_.scale);
    StressTumble tumble(random_, setting_);
    Vec3 at = random_.in_box(setting_.reach);
    Vec3 before(0.0);
    for (int tick = 0; tick < options_.ticks; ++tick) {
        const Vec3 in_world = setting_.to_world(setting_.around + at);
        const bool deforms = kind_.deforming && tick > 0 && tick % 40 == 0;
        if (deforms) {
            deform_body(counts);
        }
        const double start = options_.timed ? processor_time() : 0.0;
        rig_.scene.begin_tick();
        if (kind_.moving) {
            pose_ = tumble.next();
            rig_.scene.set_pose(body_, pose_);
            main_->place(pose_);
        }
        if (deforms) {
            rig_.scene.deform(body_, *forms_.back());
        }
        if (press_) {
            press_->act(rig_.scene, tick);
        }
        const bool came = visitor_ && visitor_->act(rig_.scene, rig_.proxy.position(), radius(), material_);
        const ProxyTick moved = rig_.proxy.move(rig_.scene, in_world);
        contact_force(rig_.scene, rig_.proxy.touching(), moved.slide, Vec3(0.0), 1e-3);
        if (options_.timed) {
            times.push_back(processor_time() - start);
        }
        if (counts) {
            if (came) {
                ++counts->appearances;
                visitor_->judge().excuse();
            }
            counts->squeezes += press_ && press_->has_room(tick) && !press_->has_room(tick + 1);
            judge(tick, in_world, before, moved, *counts);
        }
        while (forms_.size() > 3) {
            forms_.pop_front();
        }
        before = moved.position;
        at = hand.next(at);
    }
    if (counts) {
        counts->judge_faults += main_->bound_faults;
    }
    return times;
}

}  // namespace

void StressCounts::add(const StressCounts& other) {
    for (std::uint64_t StressCounts::* const figure :
         {&StressCounts::cases,         &StressCounts::ticks,         &StressCounts::contact_ticks,
          &StressCounts::penetrations,  &StressCounts::passes,        &StressCounts::nans,
          &StressCounts::stuck_ticks,   &StressCounts::false_ends,    &StressCounts::balanced_ticks,
          &StressCounts::false_excuses, &StressCounts::judge_faults,  &StressCounts::unfinished_ticks,
          &StressCounts::excused_ticks, &StressCounts::checked_ticks, &StressCounts::friction_ticks,
          &StressCounts::moving_ticks,  &StressCounts::dense_ticks,   &StressCounts::deformations,
          &StressCounts::appearances,   &StressCounts::squeezes}) {
        this->*figure += other.*figure;
    }
    error_max = std::max(error_max, other.error_max);
    thrown_max = std::max(thrown_max, other.thrown_max);
    if (other.longest_tick_us > longest_tick_us) {
        longest_tick_us = other.longest_tick_us;
        longest_tick_seed = other.longest_tick_seed;
    }
    failures.insert(failures.end(), other.failures.begin(), other.failures.end());
}

void run_stress_case(std::uint64_t seed, const StressOptions& options, StressCounts& counts) {
    ++counts.cases;
    std::vector<double> times = StressCase(seed, options).play(&counts);
    // What an interrupt took counts as the thread's own time: a tick that seems long is played again, the
    // same to the bit.
    constexpr int replays = 2;
    for (int i = 0; i < replays; ++i) {
        if (times.empty() || *std::ranges::max_element(times) <= counts.longest_tick_us) {
            return;
        }
        const std::vector<double> again = StressCase(seed, options).play(nullptr);
        std::ranges::transform(times, again, times.begin(),
                               [](double a, double b) { return std::min(a, b); });
    }
    const double longest = *std::ranges::max_element(times);
    if (longest > counts.longest_tick_us) {
        counts.longest_tick_us = longest;
        counts.longest_tick_seed = seed;
    }
}

}  // namespace tactus::shared
