#include "core/tool/tool_group.hpp"

#include <algorithm>
#include <cmath>

#include "core/tool/tool_steps.hpp"

namespace tactus {

using namespace tool_steps;

namespace {

// Of its coupling, at least: a hand that is given nothing gives way to everything.
constexpr double least_share = 1e-6;

}  // namespace

ToolGroup::ToolGroup() {
    constexpr std::size_t most = (max_tools + max_pairs) * ToolContacts::capacity;
    sources_.reserve(most);
    bounds_.reserve(most);
}

void ToolGroup::add(ToolProxy& tool, const Pose& hand, double share) {
    members_[count_++] = {&tool, hand, std::max(share, least_share), {}, State::still, false, false, 1.0, 0};
}

int ToolGroup::place_of(const ToolProxy& tool) {
    for (std::size_t i = 0; i < count_; ++i) {
        if (members_[i].tool == &tool) {
            return static_cast<int>(i);
        }
    }
    return -1;
}

void ToolGroup::find_meetings() {
    meeting_count_ = 0;
    for (const Member& member : members()) {
        for (ToolPair* const pair : member.tool->pairs()) {
            const int spheres = place_of(pair->spheres());
            const int surface = place_of(pair->surface());
            if (&pair->spheres() == member.tool && surface >= 0) {
                Meeting& meeting = meetings_[meeting_count_++];
                meeting.pair = pair;
                meeting.spheres = spheres;
                meeting.surface = surface;
                meeting.is_near = meeting.slid = false;
                meeting.contacts.count = 0;
            }
        }
    }
}

// Up to where bodies have taken them, and which of them may touch another one from there.
void ToolGroup::begin(const TouchScene& scene) {
    WorkBudget looks(count_ > 0 ? members_[0].tool->settings().max_work : 0, 0, cost::pack_look);
    const std::int64_t given = looks.left();
    for (const Meeting& meeting : meetings()) {
        meeting.pair->begin_tick(looks);
    }
    for (Member& member : members()) {
        member.state = member.tool->begin(scene, member.hand, member.tick) ? State::goes : State::still;
    }
    if (count_ > 0) {
        members_[0].tool->work_.spend(given - looks.left());
    }
    std::array<bool, max_tools> near{};
    for (Meeting& meeting : meetings()) {
        Member& a = member(meeting.spheres);
        Member& b = member(meeting.surface);
        const double ways =
            (a.moves() ? a.tool->farthest_to_go() : 0.0) + (b.moves() ? b.tool->farthest_to_go() : 0.0);
        meeting.is_near = meeting.pair->holds() && meeting.pair->is_near(ways);
        near[at(meeting.spheres)] = near[at(meeting.spheres)] || meeting.is_near;
        near[at(meeting.surface)] = near[at(meeting.surface)] || meeting.is_near;
    }
    for (std::size_t i = 0; i < count_; ++i) {
        Member& alone = members_[i];
        if (alone.moves() && !near[i]) {
            alone.tool->descend(alone.tool->hand_, alone.tick);
            alone.tool->finish(alone.tick);
            alone.state = State::still;
        }
    }
}

void ToolGroup::move(const TouchScene& scene) {
    find_meetings();
    begin(scene);
    if (std::ranges::any_of(members(), &Member::moves)) {
        descend_together();
    }
    finish();
}

void ToolGroup::descend_together() {
    std::int64_t given = 0;
    for (Member& member : members()) {
        member.trust = member.tool->trust_;
        given += member.moves() ? std::max<std::int64_t>(0, member.tool->work_.left()) : 0;
    }
    work_ = WorkBudget(given, 0, cost::pack_look);
    const auto goes = [](const Member& member) { return member.state == State::goes; };
    while (std::ranges::any_of(members(), goes) && !work_.is_gone()) {
        collect_meetings();
        std::uint32_t seen = 0;
        for (std::size_t i = 0; i < count_; ++i) {
            if (!members_[i].moves() || (seen >> i & 1u) != 0) {
                continue;
            }
            const std::uint32_t linked = linked_to(static_cast<int>(i));
            seen |= linked;
            Cluster cluster = cluster_of(linked);
            if (cluster.count > 0 && !work_.is_gone()) {
                advance(cluster);
            }
        }
    }
    const auto first = std::ranges::find_if(members(), &Member::moves);
    first->tool->work_.spend(given - work_.left());
}

void ToolGroup::finish() {
    for (Meeting& meeting : meetings()) {
        meeting.pair->set_sliding(meeting.slid);
    }
    for (Member& member : members()) {
        if (member.moves()) {
            member.tool->sliding_ = member.slid;
            member.tool->trust_ = trust_after(member.tool->trust_, member.tick.steps, member.was_cut);
            member.tick.status |=
                member.state == State::arrived ? 0u : static_cast<std::uint32_t>(tool_unfinished);
            member.tool->finish(member.tick);
        }
    }
}

void ToolGroup::collect_meetings() {
    Motions pulls{};
    for (std::size_t i = 0; i < count_; ++i) {
        const ToolProxy& tool = *members_[i].tool;
        pulls[i] = members_[i].moves() ? motion_between(tool.pose_, tool.hand_) : RigidMotion{};
    }
    for (Meeting& meeting : meetings()) {
        const Member& a = member(meeting.spheres);
        const Member& b = member(meeting.surface);
        const double pace = a.tool->pace_ + b.tool->pace_;
        meeting.contacts.count = 0;
        if (meeting.is_near && !work_.is_gone()) {
            meeting.pair->collect(motions_of(meeting, pulls),
                                  ahead_in_air * pace + far_enough * meeting.pair->skin(), meeting.contacts,
                                  work_);
        }
    }
}

// As bits: it, and all that contacts tie to it.
std::uint32_t ToolGroup::linked_to(int place) {
    std::uint32_t linked = 1u << place;
    for (std::size_t i = 0; i < max_tools; ++i) {
        for (const Meeting& meeting : meetings()) {
            const std::uint32_t both = 1u << meeting.spheres | 1u << meeting.surface;
            const bool ties = meeting.contacts.count > 0 && member(meeting.spheres).moves() &&
                              member(meeting.surface).moves();
            linked |= ties && (linked & both) != 0 ? both : 0u;
        }
    }
    return linked;
}

// Empty where none of them goes any more.
ToolGroup::Cluster ToolGroup::cluster_of(std::uint32_t linked) {
    Cluster cluster;
    bool goes = false;
    for (std::size_t i = 0; i < count_; ++i) {
        if ((linked >> i & 1u) == 0) {
            continue;
        }
        const Member& one = members_[i];
        if (cluster.count == 0) {
            cluster.stiffness = one.stiffness();
            cluster.skin = one.tool->skin();
        }
        const auto place = at(cluster.count);
        cluster.members[place] = static_cast<int>(i);
        cluster.space.lengths[place] = one.tool->length_;
        cluster.space.roots[place] = std::sqrt(one.stiffness() / cluster.stiffness);
        cluster.skin = std::min(cluster.skin, one.tool->skin());
        cluster.space.tools = ++cluster.count;
        goes = goes || one.state == State::goes;
    }
    return goes ? cluster : Cluster{};
}

// One step of all of them.
void ToolGroup::advance(Cluster& cluster) {
    const Plan next = plan(cluster);
    if (!goes_on(cluster, next)) {
        return;
    }
    double trust = 1.0;
    for (int i = 0; i < cluster.count; ++i) {
        trust = std::min(trust, member(cluster.members[at(i)]).trust);
    }
    judge(cluster, step(cluster, next, trust));
}

bool ToolGroup::goes_on(const Cluster& cluster, const Plan& plan) {
    const bool fails = work_.is_gone() || !plan.possible;
    const bool rests = !fails && plan.complete && is_at_rest(cluster, plan.motion);
    bool tired = false;
    for (int i = 0; i < cluster.count; ++i) {
        Member& one = member(cluster.members[at(i)]);
        one.tick.residual = fails ? one.tick.residual : cluster.space.way_of(plan.motion, i);
        tired = tired || one.tick.steps >= one.tool->settings_.max_steps;
    }
    if (!fails) {
        keep_touches(cluster, plan.holding);
    }
    for (int i = 0; i < cluster.count; ++i) {
        Member& one = member(cluster.members[at(i)]);
        one.state = rests ? State::arrived : fails || tired ? State::stuck : State::goes;
    }
    return !fails && !rests && !tired;
}

ToolPair::Motions ToolGroup::motions_of(const Meeting& meeting, const Motions& motions) {
    return {motions[at(meeting.spheres)], motions[at(meeting.surface)]};
}

// Along the plan, by one share for all.
ToolGroup::Motions ToolGroup::step(const Cluster& cluster, const Plan& plan, double trust) {
    Motions motions{};
    std::uint32_t moving = 0;
    double straight = 1.0;
    for (int i = 0; i < cluster.count; ++i) {
        const int place = cluster.members[at(i)];
        moving |= 1u << place;
        motions[at(place)] = cluster.space.of(plan.motion, i);
        straight = std::min(straight, member(place).tool->around_.straight_share(motions[at(place)]));
    }
    const auto for_each_meeting = [&](auto&& use) {
        for (Meeting& meeting : meetings()) {
            const std::uint32_t both = 1u << meeting.spheres | 1u << meeting.surface;
            if (meeting.is_near && (both & moving) != 0) {
                use(*meeting.pair, motions_of(meeting, motions));
            }
        }
    };
    for_each_meeting([&](ToolPair& pair, const ToolPair::Motions& both) {
        straight = std::min(straight, pair.straight_share(both));
    });
    for (RigidMotion& motion : motions) {
        motion = motion * (trust * straight);
    }
    double free = 1.0;
    for (int i = 0; i < cluster.count; ++i) {
        const int place = cluster.members[at(i)];
        ToolProxy& tool = *member(place).tool;
        free = std::min(free, tool.around_.free_share(tool.pose_, motions[at(place)], work_));
    }
    for_each_meeting([&](ToolPair& pair, const ToolPair::Motions& both) {
        free = std::min(free, pair.free_share(both, work_));
    });
    for (int i = 0; i < cluster.count; ++i) {
        const int place = cluster.members[at(i)];
        motions[at(place)] = motions[at(place)] * free;
        member(place).tool->go(motions[at(place)]);
    }
    return motions;
}

// See ToolProxy::descend.
void ToolGroup::judge(const Cluster& cluster, const Motions& gone) {
    bool stalled = true;
    for (int i = 0; i < cluster.count; ++i) {
        const int place = cluster.members[at(i)];
        const ToolProxy& tool = *member(place).tool;
        stalled = stalled && tool.around_.farthest_way(gone[at(place)]) < least_step * tool.skin();
    }
    for (int i = 0; i < cluster.count; ++i) {
        Member& one = member(cluster.members[at(i)]);
        ++one.tick.steps;
        one.stalls = stalled ? one.stalls + 1 : 0;
        one.was_cut = stalled && work_.is_gone();
        one.trust = stalled ? 0.25 * one.trust : std::min(1.0, 2.0 * one.trust);
        one.state = one.stalls >= max_stalls ? State::stuck : State::goes;
    }
}

}  // namespace tactus
