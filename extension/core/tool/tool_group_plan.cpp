// Where the tools of a cluster go next, and what holds them back: ToolProxy::plan for all of them at once.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/tool/tool_group.hpp"
#include "core/tool/tool_steps.hpp"

namespace tactus {

using namespace tool_steps;

namespace {

// Each of them lets go of what sticks, and there are no more than four tools and six pairs.
constexpr int max_breaks = 4;

}  // namespace

bool ToolGroup::Source::touches() const {
    return contact.gap <= touching_gap * skin;
}

void ToolGroup::add_walls(const Cluster& cluster, int place) {
    ToolProxy& tool = *member(cluster.members[at(place)]).tool;
    const RigidMotion pull = motion_between(tool.pose_, tool.hand_);
    tool.around_.collect(tool.pose_, pull, ahead_in_air * tool.pace_ + far_enough * tool.skin(), walls_,
                         work_);
    for (const ToolContact& contact : walls_.all()) {
        sources_.push_back({contact, nullptr, cluster.members[at(place)], tool.skin()});
        bounds_.push_back({{contact.normal, contact.point - tool.pose_.position, contact.gap, 0.0, 0.0},
                           Vec3(0.0),
                           place,
                           -1});
    }
}

// What of a pair takes no steps stands still for the other one.
void ToolGroup::add_meeting(const Cluster& cluster, Meeting& meeting) {
    const auto begin = cluster.members.begin();
    const auto end = begin + cluster.count;
    const auto a = std::find(begin, end, meeting.spheres);
    const auto b = std::find(begin, end, meeting.surface);
    if (a == end && b == end) {
        return;
    }
    const bool turned = a == end;
    const auto one = turned ? b : a;
    const Vec3& origin = member(*one).tool->pose_.position;
    for (const ToolContact& contact : meeting.contacts.all()) {
        const Vec3 normal = turned ? -contact.normal : contact.normal;
        GroupBound bound{{normal, contact.point - origin, contact.gap, 0.0, 0.0},
                         Vec3(0.0),
                         static_cast<int>(one - begin),
                         -1};
        if (!turned && b != end) {
            bound.other = static_cast<int>(b - begin);
            bound.other_arm = contact.point - member(meeting.surface).tool->pose_.position;
        }
        sources_.push_back({contact, &meeting, *one, meeting.pair->skin()});
        bounds_.push_back(bound);
    }
}

void ToolGroup::collect_bounds(const Cluster& cluster) {
    sources_.clear();
    bounds_.clear();
    for (int i = 0; i < cluster.count; ++i) {
        add_walls(cluster, i);
    }
    for (Meeting& meeting : meetings()) {
        add_meeting(cluster, meeting);
    }
}

// Without friction, and gaps as they are.
void ToolGroup::release_bounds() {
    for (std::size_t i = 0; i < bounds_.size(); ++i) {
        bounds_[i].of.gap = sources_[i].contact.gap;
        bounds_[i].of.friction = bounds_[i].of.slide = 0.0;
    }
}

GroupMotion ToolGroup::nearest(const Cluster& cluster, const GroupVector& goal, double tolerance,
                               WorkBudget& work, const GroupMotion* like) {
    GroupMotion nearest =
        nearest_group_motion(goal, bounds_, cluster.space, tolerance * cluster.skin, work, like);
    if (!nearest.possible) {
        // See ToolProxy::nearest.
        for (GroupBound& bound : bounds_) {
            bound.of.gap = std::max(bound.of.gap, 0.0);
        }
        nearest = nearest_group_motion(goal, bounds_, cluster.space, tolerance * cluster.skin, work);
    }
    return nearest;
}

// Coulomb's coefficient as it is now.
double ToolGroup::friction_of(const Source& source) const {
    if (source.meeting) {
        return source.meeting->pair->friction(source.meeting->pair->sliding());
    }
    const ToolProxy& tool = *members_[at(source.member)].tool;
    return tool.friction_at(source.contact, tool.sliding_);
}

bool ToolGroup::is_held(const GroupMotion& holding) const {
    const auto pushes = std::span(holding.pushes).first(at(holding.push_count));
    return std::ranges::any_of(pushes, [&](const MotionPush& push) {
        const Source& source = sources_[at(push.bound)];
        return source.touches() && friction_of(source) > 0.0;
    });
}

void ToolGroup::bound_friction() {
    for (std::size_t i = 0; i < bounds_.size(); ++i) {
        bounds_[i].of.friction = sources_[i].touches() ? friction_of(sources_[i]) : 0.0;
        bounds_[i].of.slide = 0.0;
    }
}

// What slides may do so without lifting. False where that is known already.
bool ToolGroup::bound_slides(const Cluster& cluster, const GroupVector& x) {
    constexpr double same = 0.01;
    double most = 0.0;
    double changed = 0.0;
    for (std::size_t i = 0; i < bounds_.size(); ++i) {
        const Source& source = sources_[i];
        const bool slides =
            source.meeting ? source.meeting->pair->sliding() : member(source.member).tool->sliding_;
        MotionBound& bound = bounds_[i].of;
        if (slides && bound.friction > 0.0) {
            const double before = bound.slide;
            bound.slide = glm::length(along_surface(bounds_[i].way(cluster.space, x), bound.normal));
            most = std::max(most, bound.slide);
            changed = std::max(changed, std::abs(bound.slide - before));
        }
    }
    return changed > same * most;
}

bool ToolGroup::is_at_rest(const Cluster& cluster, const GroupVector& x) const {
    for (int i = 0; i < cluster.count; ++i) {
        const ToolProxy& tool = *members_[at(cluster.members[at(i)])].tool;
        if (cluster.space.way_of(x, i) > least_step * tool.skin()) {
            return false;
        }
    }
    return true;
}

// Where Coulomb's friction lets the tools go, with the forces that hold them.
GroupMotion ToolGroup::hold(const Cluster& cluster, const GroupVector& goal, const GroupMotion& like,
                            WorkBudget& work) {
    bound_friction();
    GroupMotion held = nearest(cluster, goal, cones_met, work, &like);
    for (int i = 0; i < slide_rounds && !is_at_rest(cluster, held.x) && bound_slides(cluster, held.x); ++i) {
        held = nearest(cluster, goal, cones_met, work, &held);
    }
    return held;
}

// Where a point that friction holds moves along its surface nevertheless, static friction has given way: of a
// tool to bodies, or of a pair. True where that is new.
bool ToolGroup::begins_to_slide(const Cluster& cluster, const GroupMotion& held) {
    bool is_new = false;
    for (const MotionPush& push : std::span(held.pushes).first(at(held.push_count))) {
        const GroupBound& bound = bounds_[at(push.bound)];
        const Source& source = sources_[at(push.bound)];
        const Vec3 slide = along_surface(bound.way(cluster.space, held.x), bound.of.normal);
        if (bound.of.friction <= 0.0 || glm::length(slide) <= least_step * source.skin) {
            continue;
        }
        if (source.meeting) {
            is_new = is_new || !source.meeting->pair->sliding();
            source.meeting->pair->set_sliding(true);
            source.meeting->slid = true;
        } else {
            Member& one = member(source.member);
            is_new = is_new || !one.tool->sliding_;
            one.tool->sliding_ = one.slid = true;
        }
    }
    return is_new;
}

// What friction gives, as one wrench for each tool.
GroupVector ToolGroup::goal_with_friction(const Cluster& cluster, const GroupVector& goal,
                                          const GroupMotion& held) const {
    GroupVector with = goal;
    for (const MotionPush& push : std::span(held.pushes).first(at(held.push_count))) {
        const GroupBound& bound = bounds_[at(push.bound)];
        const GroupVector row = bound.row(push.direction - bound.of.normal, cluster.space);
        for (std::size_t i = 0; i < with.size(); ++i) {
            with[i] += push.size * row[i];
        }
    }
    return with;
}

ToolGroup::Plan ToolGroup::plan(Cluster& cluster) {
    collect_bounds(cluster);
    GroupVector goal{};
    for (int i = 0; i < cluster.count; ++i) {
        const ToolProxy& tool = *member(cluster.members[at(i)]).tool;
        cluster.space.put(goal, i, motion_between(tool.pose_, tool.hand_));
    }
    Plan plan;
    plan.holding = nearest(cluster, goal, bounds_met, work_);
    plan.motion = plan.holding.x;
    plan.possible = plan.holding.possible && plan.holding.missing == 0.0;
    if (!plan.possible || !is_held(plan.holding)) {
        return plan;
    }
    // Friction that the work does not suffice for is weaker or elsewhere than it should be in this step. What
    // is kept back is for the motion with it: so they get on in every tick.
    const std::int64_t for_friction = work_.left() * 2 / 3;
    WorkBudget work(for_friction);
    GroupMotion held = hold(cluster, goal, plan.holding, work);
    for (int i = 0; i < max_breaks && begins_to_slide(cluster, held) && !work.is_gone(); ++i) {
        held = hold(cluster, goal, held, work);
    }
    work_.spend(for_friction - work.left());
    plan.complete = held.missing == 0.0 && !work.is_gone();
    if (plan.complete) {
        plan.holding = held;
        plan.motion = held.x;
    }
    if (!plan.complete || !is_at_rest(cluster, plan.motion)) {
        const GroupVector along_goal = goal_with_friction(cluster, goal, held);
        release_bounds();
        const GroupMotion along = nearest(cluster, along_goal, bounds_met, work_, &held);
        plan.motion = along.x;
        plan.possible = along.possible && along.missing == 0.0;
    }
    return plan;
}

void ToolGroup::keep_touches(const Cluster& cluster, const GroupMotion& holding) {
    for (int i = 0; i < cluster.count; ++i) {
        ToolProxy& tool = *member(cluster.members[at(i)]).tool;
        tool.touch_count_ = tool.meeting_count_ = 0;
    }
    for (const MotionPush& push : std::span(holding.pushes).first(at(holding.push_count))) {
        keep_touch(cluster, sources_[at(push.bound)], push.direction * (push.size * cluster.stiffness));
    }
}

// `force` on the source's member, as its hand is given it.
void ToolGroup::keep_touch(const Cluster& cluster, const Source& source, const Vec3& force) {
    Member& one = member(source.member);
    ToolProxy& tool = *one.tool;
    const ToolContact& contact = source.contact;
    if (source.meeting) {
        const bool is_spheres = source.member == source.meeting->spheres;
        const int other = is_spheres ? source.meeting->surface : source.meeting->spheres;
        const Vec3 normal = is_spheres ? contact.normal : -contact.normal;
        keep_meeting(source.member, source, normal, force);
        keep_meeting(other, source, -normal, -force);
        return;
    }
    if (at(tool.touch_count_) == tool.touches_.size()) {
        return;
    }
    // Where other tools hold this one, their couplings are behind it as well.
    double stiffness = 0.0;
    for (int i = 0; i < cluster.count; ++i) {
        stiffness += member(cluster.members[at(i)]).stiffness();
    }
    const Vector6 row = lifted_row(contact.normal, contact.point - tool.pose_.position, tool.length_);
    const double give = length_of(row);
    tool.touches_[at(tool.touch_count_++)] = {contact.point,     contact.normal,
                                              force / one.share, stiffness / (one.share * give * give),
                                              contact.body,      contact.feature};
}

void ToolGroup::keep_meeting(int place, const Source& source, const Vec3& normal, const Vec3& force) {
    Member& one = member(place);
    ToolProxy& tool = *one.tool;
    const ToolPair& pair = *source.meeting->pair;
    const ToolMeeting meeting{source.contact.point, normal, force / one.share, &pair.other_than(tool)};
    const auto size = [](const ToolMeeting& m) { return glm::dot(m.force, m.force); };
    if (at(tool.meeting_count_) < tool.meetings_.size()) {
        tool.meetings_[at(tool.meeting_count_++)] = meeting;
        return;
    }
    ToolMeeting& least = *std::ranges::min_element(tool.meetings_, {}, size);
    if (size(meeting) > size(least)) {
        least = meeting;
    }
}

}  // namespace tactus
