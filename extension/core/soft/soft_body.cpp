#include "core/soft/soft_body.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "core/soft/element_lanes.hpp"

namespace tactus {

namespace {

// No node goes faster (unit: meters per second).
constexpr double fastest = 100.0;
// Slower than this it is still (unit: meters per second).
constexpr double still_speed = 2e-6;
// Rounds in which contacts that feel each other come to agree.
constexpr int contact_rounds = 16;

}  // namespace

SoftBody::SoftBody(std::shared_ptr<const SoftModel> model) : model_(std::move(model)) {
    const std::size_t count = model_->rest.size();
    for (std::vector<Lanes>* rows :
         {&place_, &velocity_, &next_, &inertial_, &seen_, &right_, &answers_, &arm_, &arm_answer_}) {
        rows->assign(count, splat(0.0));
    }
    turn_.resize(model_->tetrahedra.size() + model_->cells.size());
    answer_.resize(count);
    reset();
}

void SoftBody::reset() {
    for (std::size_t i = 0; i < place_.size(); ++i) {
        place_[i] = row_of(model_->rest[i]);
        velocity_[i] = splat(0.0);
    }
    std::ranges::fill(turn_, no_turn_lanes());
    still_ticks_ = 0;
}

bool SoftBody::go_on_from(const SoftBody& other) {
    if (model_->rest != other.model_->rest || model_->held != other.model_->held ||
        turn_.size() != other.turn_.size()) {
        return false;
    }
    place_ = other.place_;
    velocity_ = other.velocity_;
    turn_ = other.turn_;
    wake();
    return true;
}

void SoftBody::put(std::size_t node, const Vec3& place, const Vec3& velocity) {
    place_[node] = row_of(place);
    velocity_[node] = row_of(velocity);
    wake();
}

double SoftBody::write_surface(std::span<Vec3> out) const {
    double farthest2 = 0.0;
    for (std::size_t i = 0; i < out.size(); ++i) {
        const SoftAnchor& anchor = model_->anchors[i];
        Lanes place = splat(0.0);
        for (std::size_t k = 0; k < 4; ++k) {
            place = multiply_add(place_[anchor.node[k]], splat(anchor.weight[k]), place);
        }
        const Vec3 way = vector_of(place) - out[i];
        farthest2 = std::max(farthest2, glm::dot(way, way));
        out[i] = vector_of(place);
    }
    return std::sqrt(farthest2);
}

Vec3 SoftBody::surface_point(std::uint32_t triangle, const Vec3& weights) const {
    Lanes place = splat(0.0);
    for (int corner = 0; corner < 3; ++corner) {
        const SoftAnchor& anchor =
            model_->anchors[model_->surface.triangles[triangle][static_cast<std::size_t>(corner)]];
        for (std::size_t k = 0; k < 4; ++k) {
            place = multiply_add(place_[anchor.node[k]], splat(anchor.weight[k] * weights[corner]), place);
        }
    }
    return vector_of(place);
}

// F0 + k (h - u) - c (v - v0) as k' (s - u): the damper sees the way of the step over its time.
void SoftBody::begin_contacts(std::span<const SoftPush> pushes) {
    contact_count_ = 0;
    for (const SoftPush& push : pushes.first(std::min(pushes.size(), max_pushes))) {
        Contact& contact = contacts_[contact_count_++];
        const double seconds = model_->design.seconds;
        contact.stiffness = push.stiffness + push.damping / seconds;
        contact.sticks = push.sticks;
        contact.direction = push.force / std::max(glm::length(push.force), 1e-300);
        contact.force = push.force;
        Vec3 point_velocity(0.0);
        for (std::size_t i = 0; i < corners_of_push; ++i) {
            const std::size_t corner = i / 4;
            const SoftAnchor& anchor = model_->anchors[model_->surface.triangles[push.triangle][corner]];
            const std::uint32_t node = anchor.node[i % 4];
            const double weight = anchor.weight[i % 4] * push.weights[static_cast<int>(corner)];
            contact.node[i] = node;
            contact.weight[i] = model_->held[node] != 0 ? 0.0 : weight;
            point_velocity += contact.weight[i] * vector_of(velocity_[node]);
        }
        contact.slack =
            (push.force + push.stiffness * seconds * push.hand_velocity + push.damping * point_velocity) /
            contact.stiffness;
    }
}

// How every node goes by a unit force at each contact, and what the contacts see of that: the same along x, y
// and z, since the matrix is.
void SoftBody::find_compliance() {
    for (std::size_t begin = 0; begin < contact_count_; begin += 4) {
        const std::size_t end = std::min(contact_count_, begin + 4);
        std::ranges::fill(answers_, splat(0.0));
        for (std::size_t c = begin; c < end; ++c) {
            for (std::size_t i = 0; i < corners_of_push; ++i) {
                answers_[contacts_[c].node[i]][c - begin] += contacts_[c].weight[i];
            }
        }
        model_->factor.solve(answers_);
        for (std::size_t n = 0; n < answers_.size(); ++n) {
            for (std::size_t c = begin; c < end; ++c) {
                answer_[n][c] = answers_[n][c - begin];
            }
        }
    }
    for (Contact& contact : std::span(contacts_).first(contact_count_)) {
        Vec3 arm(0.0), arm_answer(0.0);
        for (std::size_t i = 0; i < corners_of_push; ++i) {
            arm += contact.weight[i] * vector_of(arm_[contact.node[i]]);
            arm_answer += contact.weight[i] * vector_of(arm_answer_[contact.node[i]]);
        }
        for (int k = 0; k < 3; ++k) {
            Vec3 axis(0.0);
            axis[k] = 1.0;
            contact.turn[static_cast<std::size_t>(k)] = glm::cross(axis, arm);
            contact.answer[static_cast<std::size_t>(k)] = glm::cross(axis, arm_answer);
        }
    }
    for (std::size_t c = 0; c < contact_count_; ++c) {
        for (std::size_t d = 0; d < contact_count_; ++d) {
            double way = 0.0;
            for (std::size_t i = 0; i < corners_of_push; ++i) {
                way += contacts_[c].weight[i] * answer_[contacts_[c].node[i]][d];
            }
            const auto turned = [&](const std::array<Vec3, 3>& a, const Mat3& m,
                                    const std::array<Vec3, 3>& b) {
                return Mat3(a[0], a[1], a[2]) * m * glm::transpose(Mat3(b[0], b[1], b[2]));
            };
            compliance_[c][d] = Mat3(way) + turned(contacts_[c].turn, turn_softness_, contacts_[d].turn) -
                                turned(contacts_[c].answer, turn_overlap_, contacts_[d].answer);
        }
    }
}

Vec3 SoftBody::way_of(const Contact& contact) const {
    Lanes way = splat(0.0);
    for (std::size_t i = 0; i < corners_of_push; ++i) {
        const std::uint32_t node = contact.node[i];
        way = multiply_add(next_[node] - place_[node], splat(contact.weight[i]), way);
    }
    return vector_of(way);
}

// Each contact in turn: what its spring presses with where its point comes to be, given what the others do.
void SoftBody::press_contacts() {
    std::array<Vec3, max_pushes> free{};
    for (std::size_t c = 0; c < contact_count_; ++c) {
        free[c] = way_of(contacts_[c]);
    }
    const int rounds = contact_count_ > 1 ? contact_rounds : 1;
    for (int round = 0; round < rounds; ++round) {
        for (std::size_t c = 0; c < contact_count_; ++c) {
            Contact& contact = contacts_[c];
            Vec3 left = contact.slack - free[c];
            for (std::size_t d = 0; d < contact_count_; ++d) {
                left -= d == c ? Vec3(0.0) : compliance_[c][d] * contacts_[d].force;
            }
            const Mat3 softness = Mat3(1.0 / contact.stiffness) + compliance_[c][c];
            const double along = glm::dot(left, contact.direction);
            const double soft = glm::dot(contact.direction, softness * contact.direction);
            const Vec3 pressing =
                contact.sticks ? glm::inverse(softness) * left : contact.direction * (along / soft);
            contact.force = along > 0.0 ? pressing : Vec3(0.0);
        }
    }
    for (std::size_t n = 0; n < next_.size(); ++n) {
        Vec3 way(0.0);
        for (std::size_t c = 0; c < contact_count_; ++c) {
            way += contacts_[c].force * answer_[n][c];
        }
        next_[n] += row_of(way);
    }
    Vec3 torque(0.0), answer(0.0);
    for (const Contact& contact : std::span(contacts_).first(contact_count_)) {
        for (std::size_t k = 0; k < 3; ++k) {
            torque[static_cast<int>(k)] += glm::dot(contact.turn[k], contact.force);
            answer[static_cast<int>(k)] += glm::dot(contact.answer[k], contact.force);
        }
    }
    move_turns(torque, answer);
}

// One step towards where G is least. Elastic forces are taken ahead of x' by what damping sees, tau v'.
void SoftBody::iterate() {
    const SoftModel& model = *model_;
    const double inverse_square = 1.0 / (model.design.seconds * model.design.seconds);
    const Lanes ahead = splat(model.design.material.damping / model.design.seconds);
    for (std::size_t n = 0; n < next_.size(); ++n) {
        seen_[n] = multiply_add(next_[n] - place_[n], ahead, next_[n]);
        right_[n] = (inertial_[n] - next_[n]) * splat(model.mass[n] * inverse_square);
    }
    add_tetrahedra();
    add_cells();
    add_springs();
    for (std::size_t n = 0; n < next_.size(); ++n) {
        right_[n] = model.held[n] != 0 ? splat(0.0) : right_[n];
    }
    Vec3 torque, answer;
    see_turns(right_, torque, answer);
    model.factor.solve(right_);
    for (std::size_t n = 0; n < next_.size(); ++n) {
        next_[n] += right_[n];
    }
    move_turns(torque, answer);
    if (contact_count_ > 0) {
        press_contacts();
    }
}

// Vertices that have entered are put back onto the surface, their nodes by their share and the less the
// heavier they are; along it they stick as long as friction bears it.
void SoftBody::keep_out(SoftObstacle& obstacle) {
    const SoftModel& model = *model_;
    for (const SoftAnchor& anchor : model.anchors) {
        Lanes place = splat(0.0), before = splat(0.0);
        double give = 0.0;  // way of the vertex by a unit impulse over a unit time
        for (std::size_t k = 0; k < 4; ++k) {
            const std::uint32_t node = anchor.node[k];
            place = multiply_add(next_[node], splat(anchor.weight[k]), place);
            before = multiply_add(place_[node], splat(anchor.weight[k]), before);
            give += model.held[node] != 0 ? 0.0 : anchor.weight[k] * anchor.weight[k] / model.mass[node];
        }
        const Vec3 local = to_local(obstacle.pose, vector_of(place));
        const SolidDistance found = distance_to_solid(*obstacle.solid, local);
        if (found.distance >= 0.0 || give <= 0.0) {
            continue;
        }
        const Vec3 normal = direction_to_parent(obstacle.pose, found.normal);
        const Vec3 carried = to_parent(obstacle.pose, to_local(obstacle.previous, vector_of(before)));
        const Vec3 slipped = vector_of(place) - carried;
        const Vec3 across = slipped - normal * glm::dot(slipped, normal);
        const double most = obstacle.friction * -found.distance;
        const double length = glm::length(across);
        const Vec3 held = across * (length > most ? most / length : 1.0);
        const double share = give / (give + obstacle.inverse_mass);
        const Vec3 back = (normal * -found.distance - held) * share;
        for (std::size_t k = 0; k < 4; ++k) {
            const std::uint32_t node = anchor.node[k];
            if (model.held[node] == 0) {
                next_[node] += row_of(back * (anchor.weight[k] / (model.mass[node] * give)));
            }
        }
        const Vec3 impulse = back * (-1.0 / (give * model.design.seconds));
        obstacle.impulse += impulse;
        obstacle.turn += glm::cross(vector_of(place) - obstacle.pose.position, impulse);
    }
}

// False where it has left the range of numbers.
bool SoftBody::finish() {
    const SoftModel& model = *model_;
    const double farthest = 1e3 * model.size + 1e3;
    const double rate = 1.0 / model.design.seconds;
    const double kept = std::max(0.0, 1.0 - model.design.material.drag * model.design.seconds);
    double quickest = 0.0;
    bool sound = true;
    for (std::size_t n = 0; n < next_.size(); ++n) {
        Vec3 velocity = (vector_of(next_[n]) - vector_of(place_[n])) * rate;
        const double speed = glm::length(velocity);
        velocity *= speed > fastest ? fastest / speed : 1.0;
        sound = sound && std::isfinite(speed) && glm::length(vector_of(next_[n])) <= farthest;
        quickest = std::max(quickest, speed);
        place_[n] = speed > fastest ? place_[n] + row_of(velocity * model.design.seconds) : next_[n];
        velocity_[n] = row_of(velocity * kept);
    }
    still_ticks_ = quickest > still_speed || contact_count_ > 0 ? 0 : still_ticks_ + 1;
    return sound;
}

std::uint32_t SoftBody::step(const Vec3& gravity, std::span<const SoftPush> pushes,
                             std::span<SoftObstacle> obstacles) {
    if (!pushes.empty()) {
        wake();
    }
    if (is_asleep()) {
        return 0;
    }
    const Lanes seconds = splat(model_->design.seconds);
    const Lanes fall = row_of(gravity * (model_->design.seconds * model_->design.seconds));
    for (std::size_t n = 0; n < next_.size(); ++n) {
        next_[n] = model_->held[n] != 0 ? place_[n] : multiply_add(velocity_[n], seconds, place_[n]);
        inertial_[n] = next_[n] + fall;
    }
    find_turns();
    begin_contacts(pushes);
    find_compliance();
    for (int i = 0; i < iterations; ++i) {
        iterate();
    }
    for (SoftObstacle& obstacle : obstacles) {
        keep_out(obstacle);
    }
    if (finish()) {
        return 0;
    }
    reset();
    return soft_lost;
}

}  // namespace tactus
