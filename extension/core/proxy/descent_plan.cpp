// The next step of a tick: what it is planned over, and where it leads.
#include <algorithm>
#include <glm/geometric.hpp>

#include "core/proxy/descent.hpp"

namespace tactus {

namespace {

// What stands for a crowd is looked for up to here above rest (of the radius).
constexpr double crowd_reach = 1e-2;
// Where a step of this tick was stopped by what was no contact, the few nearest ones up to that much farther
// (of the radius) are contacts as well: the next steps are planned with them instead of ending there.
constexpr double look_ahead = 1e-3;
// Not where there are more contacts than that: to tell those ahead apart takes more than the stops they save.
constexpr int max_sparse = 16;
constexpr int few_contacts = 16;  // are told apart as soon one by one

}  // namespace

// What a step is planned over. False where that is not all there is: the work has ended before, or it is only
// what is in mind. That does for most steps over fine facets, which the next one stops: the contacts that
// pressed and the one that stopped it. Where nothing is left to go over them, nothing is over all of them; so
// the end of the way is asked of all, and what a step over some does not know of stops its sweep.
bool Descent::look_around() {
    Surroundings& surroundings = sphere_.surroundings;
    WorkBudget& work = sphere_.work();
    Crowd& crowd = hold_.crowd;
    const double ahead = trust_.stops() > 0 && !is_dense_ ? look_ahead * radius() : 0.0;
    if (recalls_) {
        surroundings.recall_contacts(sphere_.position, sphere_.contacts, beyond_ + ahead);
        return false;
    }
    if (!crowd.is_around()) {
        const WorkShare share(work, question_share(sphere_.settings.max_work));
        surroundings.find_contacts(sphere_.position, sphere_.contacts, beyond_, ahead);
        if (share.is_too_small()) {
            crowd.enter();
        }
        is_dense_ = sphere_.contacts.count > max_sparse;
    }
    if (crowd.is_around()) {
        surroundings.find_nearest_contacts(sphere_.position, std::max(beyond_, crowd_reach * radius()),
                                           sphere_.contacts);
    }
    return is_last_ || !work.is_gone();
}

// The step towards the hand over what is known of the contacts. Those that hold it back are looked at closely
// first; what that changes may let others press. Where it takes more than a question's share to tell which
// do, they are a crowd as well.
void Descent::plan() {
    const WorkShare share(sphere_.work(), question_share(sphere_.settings.max_work));
    plan_in_share();
    is_cut_short_ = share.is_too_small();
    if (is_cut_short_) {
        hold_.crowd.enter();
    }
}

void Descent::plan_in_share() {
    WorkBudget& work = sphere_.work();
    ContactList& contacts = sphere_.contacts;
    const ContactLook look = sphere_.look();
    const double length = glm::length(pull_);
    if (contacts.count > few_contacts) {
        look.cover_behind_nearest(contacts);
    }
    for (bool again = true; again;) {
        step_ = flat_step(pull_, contacts, tolerances().same, work);
        again = false;
        for (int i = 0; i < step_.pressing_count && !work.is_gone(); ++i) {
            if (contacts[step_.pressing[i]].state == ContactState::seen) {
                again = look.look_closely(contacts, step_.pressing[i], length) || again;
            }
        }
    }
    bool is_flat = true;
    for (int i = 0; i < step_.pressing_count; ++i) {
        const Contact& contact = contacts[step_.pressing[i]];
        sphere_.surroundings.mind().keep(contact.feature);
        is_flat = is_flat && contact.state == ContactState::face;
    }
    if (step_.pressing_count == 0 || (is_flat && is_end())) {
        return;
    }
    trust_.heed(step_, pull_, sphere_.position, tolerances());
    if (step_.bent || is_flat || step_.pressing_count == TouchList::capacity) {
        return;
    }
    const auto curvature = [&](int i) {
        return i < step_.pressing_count ? look.curvature_of(contacts, step_.pressing[i]) : Curvature{};
    };
    const Curvature curvatures[] = {curvature(0), curvature(1)};
    bend_step(step_, pull_, contacts, {curvatures, static_cast<std::size_t>(step_.pressing_count)},
              {radius(), tolerances().same, trust_.limit()}, work);
}

}  // namespace tactus
