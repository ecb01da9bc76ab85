#include "core/tool/tool_proxy.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <utility>

#include "core/safety/hand_place.hpp"
#include "core/tool/tool_pair.hpp"
#include "core/tool/tool_steps.hpp"

namespace tactus {

using namespace tool_steps;

ToolProxy::ToolProxy(std::shared_ptr<const ToolShape> shape, std::size_t max_parts,
                     const ToolSettings& settings)
    : around_(std::move(shape), max_parts) {
    set_settings(settings);
}

void ToolProxy::set_settings(const ToolSettings& settings) {
    if (settings.mask != settings_.mask) {
        around_.forget();
    }
    settings_ = settings;
    is_changed_ = true;
    length_ = std::sqrt(settings.turning_stiffness / settings.stiffness);
}

void ToolProxy::give_work(std::int64_t units) {
    work_ = WorkBudget(units, 0, cost::pack_look);
    work_given_ = units;
}

ToolMemory ToolProxy::memory() const {
    ToolMemory memory{pose_, present_, sliding_, false, pace_, trust_, {}, 0};
    const auto hardest = hardest_touch();
    if (hardest != touching().end()) {
        memory.rests = true;
        memory.on = *hardest;
    }
    for (std::size_t i = 0; i < pairs().size(); ++i) {
        memory.slides_on |= pairs()[i]->sliding() ? 1u << i : 0u;
    }
    return memory;
}

// What its spheres know of what is around them holds wherever they are.
void ToolProxy::recall(const ToolMemory& memory, const TouchScene& scene) {
    const bool elsewhere = pose_.position != memory.pose.position || pose_.rotation != memory.pose.rotation;
    around_.went(motion_between(pose_, memory.pose));
    pose_ = memory.pose;
    present_ = memory.present;
    sliding_ = memory.sliding;
    pace_ = memory.pace;
    trust_ = memory.trust;
    touch_count_ = memory.rests ? 1 : 0;
    meeting_count_ = 0;
    touches_[0] = memory.on;
    for (std::size_t i = 0; i < pairs().size(); ++i) {
        pairs()[i]->set_sliding((memory.slides_on >> i & 1u) != 0);
        if (elsewhere) {
            pairs()[i]->displaced();
        }
    }
    revision_ = scene.revision();
    at_rest_ = false;
}

// What its spheres know of what is around them holds wherever the hand goes: where one tick's work does not
// suffice for all of them, the next one looks at the others.
ToolTick ToolProxy::appear(const Pose& hand) {
    around_.went(motion_between(pose_, hand));
    around_.begin_tick(*scene_, settings_.mask, hand, 0.0);
    give_work(2 * settings_.max_work);
    pose_ = start_ = hand;
    present_ = around_.is_free(hand, work_) && fits_beside_tools();
    sliding_ = at_rest_ = false;
    touch_count_ = meeting_count_ = 0;
    pace_ = 0.0;
    trust_ = 1.0;
    ToolTick tick;
    tick.pose = hand;
    tick.jumped = true;
    tick.status = present_ ? 0u : static_cast<std::uint32_t>(tool_absent);
    return tick;
}

double ToolProxy::way_since(const Pose& from) const {
    return length_of(lifted(motion_between(from, pose_), length_));
}

// The tick's first look leaves work for a step: with whatever contacts it has found, sweeps keep the tool
// outside. False where it has not come to its end.
bool ToolProxy::look_around(const RigidMotion& pull, double far, bool is_first) {
    const WorkShare look(work_, is_first ? work_given_ * 3 / 5 : work_.left());
    around_.collect(pose_, pull, far, contacts_, work_, at_rest_);
    return !work_.is_gone();
}

void ToolProxy::descend(const Pose& hand, ToolTick& tick) {
    const double least = least_step * skin();
    const Pose from = pose_;
    bool slid = false;
    bool ended = false;
    double trust = trust_;
    const bool touches = touch_count_ > 0;
    const double farthest = (touches ? ahead_of_tick : ahead_in_air) * pace_;
    const double at_least = (touches ? near_enough : far_enough) * skin();
    double ahead = farthest;
    bool was_cut = false;  // the last step, where the work has ended
    for (int stalls = 0; stalls < max_stalls;) {
        const RigidMotion pull = motion_between(pose_, hand);
        const bool sees_all = look_around(pull, ahead + at_least, tick.steps == 0);
        const Plan next = plan(pull);
        if (work_.is_gone() || !next.possible) {
            break;
        }
        slid = slid || next.slides;
        tick.residual = length_of(next.motion);
        keep_touches(next.holding);
        if (!sees_all && tick.residual <= least) {
            break;  // the next tick looks at the others
        }
        if (tick.residual <= least && !std::exchange(at_rest_, true)) {
            continue;  // only with all that it touches
        }
        at_rest_ = tick.residual <= least;
        const bool is_held = next.holding.push_count > 0;
        ended = sees_all && (at_rest_ || (is_held && tick.residual <= left_over * way_since(from)));
        if (ended || tick.steps == settings_.max_steps) {
            break;
        }
        const RigidMotion wanted = lowered(next.motion, length_);
        const RigidMotion step = wanted * (trust * straight_share(wanted));
        const RigidMotion gone = step * free_share(step);
        go(gone);
        ++tick.steps;
        // What a turn bends towards a surface grows with its square, what lifts the tool off with the turn.
        const double way = around_.farthest_way(gone);
        const bool stalled = way < least;
        was_cut = stalled && work_.is_gone();
        stalls = stalled ? stalls + 1 : 0;
        trust = stalled ? 0.25 * trust : std::min(1.0, 2.0 * trust);
        ahead = touches ? std::min(farthest, ahead_of_step * way) : farthest;
    }
    trust_ = trust_after(trust_, tick.steps, was_cut);
    sliding_ = slid;
    tick.status |= ended ? 0u : static_cast<std::uint32_t>(tool_unfinished);
}

// It ends no farther from the hand than it is after its ride (unit: meters).
double ToolProxy::farthest_to_go() const {
    const double ridden = longest_ride() + farthest_ride * length_;
    return 2.0 * (length_of(lifted(motion_between(pose_, hand_), length_)) + ridden);
}

// Whether something has come to stand in it; where that takes too long to tell, not.
bool ToolProxy::is_entered() {
    WorkBudget look(2 * settings_.max_work, 0, cost::pack_look);
    return !around_.is_free(pose_, look, entered) && !look.is_gone();
}

// True where it has to go on from there.
bool ToolProxy::begin(const TouchScene& scene, const Pose& given_hand, ToolTick& tick) {
    scene_ = &scene;
    const Pose hand_before = hand_;
    if (is_hand_pose(given_hand)) {
        hand_ = {given_hand.position, glm::normalize(given_hand.rotation)};
    }
    const Pose hand = hand_;
    if (!present_) {
        tick = appear(hand);
        return false;
    }
    start_ = pose_;
    meeting_count_ = 0;
    // What gives comes nearer everywhere, tick after tick, and most spheres have to look again.
    give_work(settings_.max_work * (scene.deformed_bodies().empty() ? 1 : 2));
    const bool other_scene = !scene.only_gives_since(std::exchange(revision_, scene.revision()));
    if (other_scene) {
        touch_count_ = 0;
    }
    const bool other_material =
        std::exchange(material_changes_, scene.material_changes()) != scene.material_changes();
    tick.jumped = std::exchange(is_changed_, false) || other_scene || other_material;
    around_.begin_tick(scene, settings_.mask, pose_, farthest_to_go(), longest_ride());
    if ((other_scene && is_entered()) || !ride()) {
        tick = appear(hand);
        tick.status |= tool_squeezed;
        return false;
    }
    given_way_ = way_since(start_) + length_of(lifted(motion_between(hand_before, hand), length_));
    return true;
}

void ToolProxy::finish(ToolTick& tick) {
    pace_ = around_.farthest_way(motion_between(start_, pose_));
    const RigidMotion pull = motion_between(pose_, hand_);
    tick.pose = pose_;
    tick.force = pull.way * -settings_.stiffness;
    tick.torque = pull.turn * -settings_.turning_stiffness;
    const bool slipped = way_since(start_) > farthest_led * given_way_ + skin();
    tick.jumped = tick.jumped || slipped;
    const bool slides = sliding_ && touch_count_ > 0;
    const bool slides_on_tool = meeting_count_ > 0 && std::ranges::any_of(pairs(), &ToolPair::sliding);
    tick.status |= (touch_count_ + meeting_count_ > 0 ? static_cast<std::uint32_t>(tool_touching) : 0u) |
                   (slides || slides_on_tool ? static_cast<std::uint32_t>(tool_sliding) : 0u);
}

ToolTick ToolProxy::move(const TouchScene& scene, const Pose& hand) {
    ToolTick tick;
    if (begin(scene, hand, tick)) {
        descend(hand_, tick);
        finish(tick);
    }
    return tick;
}

void ToolProxy::meet(ToolPair& pair) {
    pairs_[at(pair_count_++)] = &pair;
    is_changed_ = true;
}

void ToolProxy::leave(const ToolPair& pair) {
    const auto last = pairs_.begin() + pair_count_;
    pair_count_ -= static_cast<int>(last - std::remove(pairs_.begin(), last, &pair));
    meeting_count_ = 0;
    is_changed_ = true;
}

}  // namespace tactus
