#include "core/soft/soft_body.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "core/math/shortened.hpp"
#include "core/soft/whole_turn.hpp"

namespace tactus {

namespace {

// No node goes faster (unit: meters per second).
constexpr double fastest = 100.0;
// Slower than this it is still (unit: meters per second).
constexpr double still_speed = 2e-6;
// Of the rotations, in each step: they go on from where they were.
constexpr int turns_a_step = 2;
// Rounds in which contacts that feel each other come to agree.
constexpr int contact_rounds = 16;

// Four rows of x, y, z as four lanes of each.
LanesVec3 gathered(const std::vector<Lanes>& rows, const std::array<std::uint32_t, 4>& node) {
    const Lanes a = rows[node[0]], b = rows[node[1]], c = rows[node[2]], d = rows[node[3]];
    const Lanes ab_low = __builtin_shufflevector(a, b, 0, 4, 2, 6);   // x x z z
    const Lanes ab_high = __builtin_shufflevector(a, b, 1, 5, 3, 7);  // y y . .
    const Lanes cd_low = __builtin_shufflevector(c, d, 0, 4, 2, 6);
    const Lanes cd_high = __builtin_shufflevector(c, d, 1, 5, 3, 7);
    return {__builtin_shufflevector(ab_low, cd_low, 0, 1, 4, 5),
            __builtin_shufflevector(ab_high, cd_high, 0, 1, 4, 5),
            __builtin_shufflevector(ab_low, cd_low, 2, 3, 6, 7)};
}

// And back, added to the rows one after the other: two lanes may belong to one node.
void scatter(std::vector<Lanes>& rows, const std::array<std::uint32_t, 4>& node, const LanesVec3& v) {
    const Lanes none = splat(0.0);
    const Lanes xy_low = __builtin_shufflevector(v.x, v.y, 0, 4, 2, 6);   // x0 y0 x2 y2
    const Lanes xy_high = __builtin_shufflevector(v.x, v.y, 1, 5, 3, 7);  // x1 y1 x3 y3
    const Lanes z_low = __builtin_shufflevector(v.z, none, 0, 4, 2, 6);   // z0 0 z2 0
    const Lanes z_high = __builtin_shufflevector(v.z, none, 1, 5, 3, 7);
    rows[node[0]] += __builtin_shufflevector(xy_low, z_low, 0, 1, 4, 5);
    rows[node[1]] += __builtin_shufflevector(xy_high, z_high, 0, 1, 4, 5);
    rows[node[2]] += __builtin_shufflevector(xy_low, z_low, 2, 3, 6, 7);
    rows[node[3]] += __builtin_shufflevector(xy_high, z_high, 2, 3, 6, 7);
}

LanesVec3 scaled_sum(const LanesVec3& a, Lanes p, const LanesVec3& b, Lanes q) {
    return {multiply_add(a.x, p, b.x * q), multiply_add(a.y, p, b.y * q), multiply_add(a.z, p, b.z * q)};
}

LanesMat3 deformation_of(const std::vector<Lanes>& places, const TetGroup& group) {
    const LanesVec3 origin = gathered(places, group.node[0]);
    const LanesVec3 first = gathered(places, group.node[1]) - origin;
    const LanesVec3 second = gathered(places, group.node[2]) - origin;
    const LanesVec3 third = gathered(places, group.node[3]) - origin;
    const auto column = [&](Lanes a, Lanes b, Lanes c) {
        return along(along(first * a, second, b), third, c);
    };
    return {column(group.gradient[0].x, group.gradient[1].x, group.gradient[2].x),
            column(group.gradient[0].y, group.gradient[1].y, group.gradient[2].y),
            column(group.gradient[0].z, group.gradient[1].z, group.gradient[2].z)};
}

std::array<LanesVec3, 8> corners_of(const std::vector<Lanes>& places, const CellGroup& group) {
    std::array<LanesVec3, 8> corner;
    std::ranges::transform(group.node, corner.begin(),
                           [&](const auto& node) { return gathered(places, node); });
    return corner;
}

LanesMat3 deformation_of(const std::vector<Lanes>& places, const CellGroup& group) {
    const std::array<LanesVec3, 8> x = corners_of(places, group);
    const LanesVec3 low = x[3] - x[0], low_cross = x[1] - x[2];
    const LanesVec3 high = x[7] - x[4], high_cross = x[5] - x[6];
    const LanesVec3 flat = low + high, cross = low_cross + high_cross;
    const LanesVec3 up = (x[4] + x[5] + x[6] + x[7]) - (x[0] + x[1] + x[2] + x[3]);
    return {(flat + cross) * group.slope.x, (flat - cross) * group.slope.y, up * group.slope.z};
}

// The rotation goes on towards that of F. With b = lambda V (tr(R^T F) - 3) - 2 mu V, the stress times the
// volume is 2 mu V F + b R.
LanesMat3 stress_of(const LanesMat3& f, Lanes shear, Lanes bulk, LanesQuat& turn) {
    for (int i = 0; i < turns_a_step; ++i) {
        turn = turned_towards(turn, f);
    }
    const LanesMat3 r = matrix_of(turn);
    const Lanes b = multiply_subtract(bulk, common_trace(r, f) - splat(3.0), shear);
    return {scaled_sum(f.x, shear, r.x, b), scaled_sum(f.y, shear, r.y, b), scaled_sum(f.z, shear, r.z, b)};
}

// V (mu |F - R|^2 + lambda / 2 (tr(R^T F) - 3)^2)
Lanes energy_of(const LanesMat3& f, Lanes shear, Lanes bulk, LanesQuat turn) {
    for (int i = 0; i < 4 * turns_a_step; ++i) {
        turn = turned_towards(turn, f);
    }
    const LanesMat3 r = matrix_of(turn);
    const LanesMat3 d{f.x - r.x, f.y - r.y, f.z - r.z};
    const Lanes change = common_trace(r, f) - splat(3.0);
    return splat(0.5) * (shear * common_trace(d, d) + bulk * change * change);
}

void push(SoftObstacle& obstacle, const Vec3& place, const Vec3& impulse) {
    obstacle.impulse += impulse;
    obstacle.turn += glm::cross(place - obstacle.pose.position, impulse);
}

struct SpringState {
    LanesVec3 sum;  // e
    Lanes length;   // |e|
};

SpringState state_of(const std::vector<Lanes>& places, const SpringGroup& group) {
    LanesVec3 sum = gathered(places, group.node[0]) * group.share[0];
    for (std::size_t c = 1; c < 4; ++c) {
        sum = along(sum, gathered(places, group.node[c]), group.share[c]);
    }
    return {sum, lanes_sqrt(dot(sum, sum))};
}

}  // namespace

SoftBody::SoftBody(std::shared_ptr<const SoftModel> model)
    : iterations(model->iterations_within(max_iteration_time)), model_(std::move(model)) {
    const std::size_t count = model_->rest.size();
    for (std::vector<Lanes>* rows : {&place_, &velocity_, &next_, &inertial_, &seen_, &right_, &answers_}) {
        rows->assign(count, splat(0.0));
    }
    turn_.resize(model_->tetrahedra.size() + model_->cells.size());
    answer_.resize(count);
    supports_.resize(model_->anchors.size());
    reset();
}

void SoftBody::reset() {
    for (std::size_t i = 0; i < place_.size(); ++i) {
        place_[i] = row_of(model_->rest[i]);
        velocity_[i] = splat(0.0);
    }
    std::ranges::fill(turn_, no_turn_lanes());
    std::ranges::fill(supports_, Support{});
    still_ticks_ = 0;
}

void SoftBody::go_on_from(const SoftBody& other) {
    std::ranges::copy(other.place_, place_.begin());
    std::ranges::copy(other.velocity_, velocity_.begin());
    std::ranges::copy(other.turn_, turn_.begin());
    std::ranges::copy(other.supports_, supports_.begin());
    wake();
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
    for (std::size_t c = 0; c < contact_count_; ++c) {
        for (std::size_t d = 0; d < contact_count_; ++d) {
            compliance_[c][d] = 0.0;
            for (std::size_t i = 0; i < corners_of_push; ++i) {
                compliance_[c][d] += contacts_[c].weight[i] * answer_[contacts_[c].node[i]][d];
            }
        }
    }
}

// f = -dE/dx, here and in the next two.
void SoftBody::add_tetrahedra() {
    for (std::size_t g = 0; g < model_->tetrahedra.size(); ++g) {
        const TetGroup& group = model_->tetrahedra[g];
        const LanesMat3 stress = stress_of(deformation_of(seen_, group), group.shear, group.bulk, turn_[g]);
        LanesVec3 sum = splat(Vec3(0.0));
        for (std::size_t c = 0; c < 3; ++c) {
            const LanesVec3& gradient = group.gradient[c];
            const LanesVec3 back =
                along(along(stress.x * gradient.x, stress.y, gradient.y), stress.z, gradient.z);
            scatter(right_, group.node[c + 1], back * splat(-1.0));
            sum = sum + back;
        }
        scatter(right_, group.node[0], sum);
    }
}

void SoftBody::add_cells() {
    const std::size_t first = model_->tetrahedra.size();
    for (std::size_t g = 0; g < model_->cells.size(); ++g) {
        const CellGroup& group = model_->cells[g];
        const LanesMat3 stress =
            stress_of(deformation_of(seen_, group), group.shear, group.bulk, turn_[first + g]);
        const LanesVec3 x = stress.x * group.slope.x, y = stress.y * group.slope.y,
                        z = stress.z * group.slope.z;
        const std::array<LanesVec3, 4> flat{x + y, y - x, x - y, (x + y) * splat(-1.0)};
        for (std::size_t c = 0; c < 4; ++c) {
            scatter(right_, group.node[c], flat[c] + z);
            scatter(right_, group.node[c + 4], flat[c] - z);
        }
    }
}

void SoftBody::add_springs() {
    for (const SpringGroup& group : model_->springs) {
        const SpringState spring = state_of(seen_, group);
        const Lanes rest = group.length / lanes_max(spring.length, splat(1e-12));
        const LanesVec3 pull = spring.sum * (group.stiffness * (rest - splat(1.0)));
        for (std::size_t c = 0; c < 4; ++c) {
            scatter(right_, group.node[c], pull * group.share[c]);
        }
    }
}

void SoftBody::add_force(const SoftAnchor& anchor, const Vec3& force) {
    for (std::size_t k = 0; k < 4; ++k) {
        const std::uint32_t node = anchor.node[k];
        right_[node] += model_->held[node] != 0 ? splat(0.0) : row_of(force * anchor.weight[k]);
    }
}

void SoftBody::add_supports() {
    for (std::size_t v = 0; v < supports_.size(); ++v) {
        if (supports_[v].force != Vec3(0.0)) {
            add_force(model_->anchors[v], supports_[v].force);
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
                left -= d == c ? Vec3(0.0) : contacts_[d].force * compliance_[c][d];
            }
            const double softness = 1.0 / contact.stiffness + compliance_[c][c];
            const double along = glm::dot(left, contact.direction);
            const Vec3 pressing = contact.sticks ? left : contact.direction * along;
            contact.force = along > 0.0 ? pressing / softness : Vec3(0.0);
        }
    }
    for (std::size_t n = 0; n < next_.size(); ++n) {
        Vec3 way(0.0);
        for (std::size_t c = 0; c < contact_count_; ++c) {
            way += contacts_[c].force * answer_[n][c];
        }
        next_[n] += row_of(way);
    }
}

// One step towards where G is least. Elastic forces are taken ahead of x' by what damping sees, tau v', but
// not by what of it turns the whole body: straight on, that would stretch it.
void SoftBody::iterate(std::span<SoftObstacle> obstacles) {
    const SoftModel& model = *model_;
    const double inverse_square = 1.0 / (model.design.seconds * model.design.seconds);
    const Lanes ahead = splat(model.design.material.damping / model.design.seconds);
    for (std::size_t n = 0; n < next_.size(); ++n) {
        right_[n] = next_[n] - place_[n];
    }
    WholeTurn whole(model, next_);
    const Vec3 turned = whole.angle_of(right_);
    for (std::size_t n = 0; n < next_.size(); ++n) {
        seen_[n] = multiply_add(right_[n] - row_of(whole.way(turned, n)), ahead, next_[n]);
        right_[n] = splat(0.0);
    }
    add_tetrahedra();
    add_cells();
    add_springs();
    whole.put_under_stress(right_, 1.0 + ahead[0]);
    add_supports();
    for (std::size_t n = 0; n < next_.size(); ++n) {
        const Lanes inertial = (inertial_[n] - next_[n]) * splat(model.mass[n] * inverse_square);
        right_[n] = model.held[n] != 0 ? splat(0.0) : right_[n] + inertial;
    }
    whole.solve(right_);
    for (std::size_t n = 0; n < next_.size(); ++n) {
        next_[n] += right_[n];
    }
    if (contact_count_ > 0) {
        press_contacts();
    }
    if (!obstacles.empty()) {
        bear(whole, obstacles);
    }
}

SoftBody::AtObstacle SoftBody::at(std::size_t vertex, const SoftObstacle& obstacle) const {
    const SoftAnchor& anchor = model_->anchors[vertex];
    Lanes place = splat(0.0), before = splat(0.0);
    for (std::size_t k = 0; k < 4; ++k) {
        const Lanes weight = splat(anchor.weight[k]);
        place = multiply_add(next_[anchor.node[k]], weight, place);
        before = multiply_add(place_[anchor.node[k]], weight, before);
    }
    const SolidDistance found = distance_to_solid(*obstacle.solid, to_local(obstacle.pose, vector_of(place)));
    const Vec3 carried = to_parent(obstacle.pose, to_local(obstacle.previous, vector_of(before)));
    const Vec3 normal = direction_to_parent(obstacle.pose, found.normal);
    const Vec3 slipped = vector_of(place) - carried;
    return {vector_of(place), normal, found.distance, slipped - normal * glm::dot(slipped, normal)};
}

// What solids that do not give way bear the surface by goes on from step to step, so that the solve knows it
// and at rest nothing moves. In each step it takes one step towards what brings every vertex that is borne
// onto its solid, along the change p that would do so if each were alone, by the share at which the ways q of
// all together fit best: sum p . (apart + share q) = 0.
void SoftBody::bear(const WholeTurn& whole, std::span<SoftObstacle> obstacles) {
    std::ranges::fill(right_, splat(0.0));
    double gained = 0.0;  // - sum p . apart
    for (std::size_t i = 0; i < obstacles.size(); ++i) {
        gained += obstacles[i].inverse_mass == 0.0 ? change_supports(obstacles[i], i) : 0.0;
    }
    double share = 0.0;
    if (gained > 0.0) {
        whole.solve(right_);
        double lost = 0.0;  // sum p . q
        for (std::size_t v = 0; v < supports_.size(); ++v) {
            for (std::size_t k = 0; k < 4 && supports_[v].change != Vec3(0.0); ++k) {
                lost += model_->anchors[v].weight[k] *
                        glm::dot(supports_[v].change, vector_of(right_[model_->anchors[v].node[k]]));
            }
        }
        share = std::min(1.0, gained / lost);
    }
    for (std::size_t n = 0; n < next_.size(); ++n) {
        next_[n] = multiply_add(right_[n], splat(share), next_[n]);
    }
    for (std::size_t v = 0; v < supports_.size(); ++v) {
        Support& support = supports_[v];
        support.force += std::exchange(support.change, Vec3(0.0)) * share;
        if (support.force != Vec3(0.0)) {
            SoftObstacle& obstacle = obstacles[support.obstacle];
            push(obstacle, at(v, obstacle).place, support.force * -model_->design.seconds);
        }
    }
}

// A solid never pulls, and holds along its surface as far as friction bears. Returns - sum p . apart.
double SoftBody::change_supports(const SoftObstacle& obstacle, std::size_t index) {
    const SoftModel& model = *model_;
    double gained = 0.0;
    for (std::size_t v = 0; v < supports_.size(); ++v) {
        Support& support = supports_[v];
        const bool bears = support.obstacle == index && support.force != Vec3(0.0);
        if (!bears && support.force + support.change != Vec3(0.0)) {
            continue;  // another bears it
        }
        const SoftAnchor& anchor = model.anchors[v];
        double give = 0.0;  // way of the vertex by a unit force if nothing else moved
        for (std::size_t k = 0; k < 4; ++k) {
            const std::uint32_t node = anchor.node[k];
            give += model.held[node] != 0 ? 0.0 : anchor.weight[k] * anchor.weight[k] / model.firmness[node];
        }
        const AtObstacle found = at(v, obstacle);
        if (give <= 0.0 || (found.distance >= 0.0 && !bears)) {
            continue;
        }
        const Vec3 apart = found.normal * found.distance + found.slipped;
        const Vec3 wanted = support.force - apart / give;
        const double pressing = std::max(0.0, glm::dot(wanted, found.normal));
        const Vec3 holding = wanted - found.normal * glm::dot(wanted, found.normal);
        support.obstacle = index;
        support.change =
            found.normal * pressing + shortened(holding, obstacle.friction * pressing) - support.force;
        gained -= glm::dot(support.change, apart);
        add_force(anchor, support.change);
    }
    return gained;
}

// Vertices that are in a solid still are put back onto its surface, their nodes by their share and the less
// the heavier they are; along it they stick as long as friction bears it.
void SoftBody::keep_out(SoftObstacle& obstacle) {
    const SoftModel& model = *model_;
    for (std::size_t v = 0; v < supports_.size(); ++v) {
        const SoftAnchor& anchor = model.anchors[v];
        const AtObstacle found = at(v, obstacle);
        if (found.distance >= 0.0) {
            continue;
        }
        double give = 0.0;  // way of the vertex by a unit impulse over a unit time
        for (std::size_t k = 0; k < 4; ++k) {
            const std::uint32_t node = anchor.node[k];
            give += model.held[node] != 0 ? 0.0 : anchor.weight[k] * anchor.weight[k] / model.mass[node];
        }
        if (give <= 0.0) {
            continue;
        }
        const Vec3 held = shortened(found.slipped, obstacle.friction * -found.distance);
        const double share = give / (give + obstacle.inverse_mass);
        const Vec3 back = (found.normal * -found.distance - held) * share;
        for (std::size_t k = 0; k < 4; ++k) {
            const std::uint32_t node = anchor.node[k];
            if (model.held[node] == 0) {
                next_[node] += row_of(back * (anchor.weight[k] / (model.mass[node] * give)));
            }
        }
        push(obstacle, found.place, back * (-1.0 / (give * model.design.seconds)));
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
    for (Support& support : supports_) {
        const bool stands =
            support.obstacle < obstacles.size() && obstacles[support.obstacle].inverse_mass == 0.0;
        support = stands ? support : Support{};
    }
    begin_contacts(pushes);
    find_compliance();
    for (int i = 0; i < iterations; ++i) {
        iterate(i + 1 == iterations ? obstacles : std::span<SoftObstacle>());
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

SoftEnergy SoftBody::energy() const {
    SoftEnergy energy;
    for (std::size_t n = 0; n < place_.size(); ++n) {
        const Vec3 velocity = vector_of(velocity_[n]);
        energy.kinetic += 0.5 * model_->mass[n] * glm::dot(velocity, velocity);
    }
    const auto add = [&](const Lanes& values) {
        energy.elastic += values[0] + values[1] + values[2] + values[3];
    };
    const auto add_elements = [&](const auto& groups, std::size_t first) {
        for (std::size_t g = 0; g < groups.size(); ++g) {
            add(energy_of(deformation_of(place_, groups[g]), groups[g].shear, groups[g].bulk,
                          turn_[first + g]));
        }
    };
    add_elements(model_->tetrahedra, 0);
    add_elements(model_->cells, model_->tetrahedra.size());
    for (const SpringGroup& group : model_->springs) {
        const Lanes longer = state_of(place_, group).length - group.length;
        add(splat(0.5) * group.stiffness * longer * longer);
    }
    return energy;
}

}  // namespace tactus
