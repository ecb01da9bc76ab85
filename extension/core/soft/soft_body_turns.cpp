// How a soft body turns as a whole in its steps: see soft_body.hpp.
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "core/soft/element_lanes.hpp"
#include "core/soft/soft_body.hpp"

namespace tactus {

namespace {

// The part along `axis` of a symmetric matrix, inverted there alone; of no axis, all of it. Nought where it
// has none.
Mat3 inverse_of_turns(const Mat3& matrix, std::size_t count, const Vec3& axis) {
    if (count == 1) {
        const double part = glm::dot(axis, matrix * axis);
        return part > 0.0 ? glm::outerProduct(axis, axis) / part : Mat3(0.0);
    }
    const double determinant = glm::determinant(matrix);
    const double size = matrix[0][0] + matrix[1][1] + matrix[2][2];
    return determinant > 1e-12 * size * size * size ? glm::inverse(matrix) : Mat3(0.0);
}

// sum of m (e_k x a) . (e_l x b) from the sum of m a b^T
Mat3 turned_moment(const Mat3& moment) {
    return Mat3(moment[0][0] + moment[1][1] + moment[2][2]) - glm::transpose(moment);
}

Mat3 moment_of(const std::vector<double>& mass, const std::vector<Lanes>& a, const std::vector<Lanes>& b) {
    Lanes columns[3] = {splat(0.0), splat(0.0), splat(0.0)};
    for (std::size_t n = 0; n < a.size(); ++n) {
        const Lanes weighed = a[n] * splat(mass[n]);
        for (std::size_t i = 0; i < 3; ++i) {
            columns[i] = multiply_add(weighed, splat(b[n][i]), columns[i]);
        }
    }
    return {vector_of(columns[0]), vector_of(columns[1]), vector_of(columns[2])};
}

}  // namespace

void SoftBody::find_turns() {
    const SoftModel& model = *model_;
    const SoftTurns& turns = model.turns;
    if (turns.count == 0) {
        return;
    }
    // Where the elastic forces are taken: they do not change by a turn of that shape.
    const double seconds = model.design.seconds;
    const Lanes ahead = splat(seconds + model.design.material.damping);
    Lanes sum = splat(0.0);
    double mass = 0.0;
    for (std::size_t n = 0; n < place_.size(); ++n) {
        arm_[n] = multiply_add(velocity_[n], ahead, place_[n]);
        sum = multiply_add(arm_[n], splat(model.mass[n]), sum);
        mass += model.mass[n];
    }
    const Lanes center = model.is_free() ? sum * splat(1.0 / mass) : row_of(turns.center);
    for (std::size_t n = 0; n < place_.size(); ++n) {
        arm_[n] = model.held[n] != 0 ? splat(0.0) : arm_[n] - center;
        arm_answer_[n] = arm_[n] * splat(model.mass[n]);
    }
    model.factor.solve(arm_answer_);
    const Mat3 inertia = turned_moment(moment_of(model.mass, arm_, arm_));
    const Mat3 overlap = turned_moment(moment_of(model.mass, arm_, arm_answer_));
    turn_softness_ = inverse_of_turns(inertia, turns.count, turns.axis) * (seconds * seconds);
    turn_overlap_ = inverse_of_turns(0.5 * (overlap + glm::transpose(overlap)), turns.count, turns.axis);
}

// phi^T and q^T of the rows.
void SoftBody::see_turns(const std::vector<Lanes>& rows, Vec3& torque, Vec3& answer) const {
    torque = answer = Vec3(0.0);
    for (std::size_t n = 0; n < rows.size() && model_->turns.count > 0; ++n) {
        const Vec3 row = vector_of(rows[n]);
        torque += glm::cross(vector_of(arm_[n]), row);
        answer += glm::cross(vector_of(arm_answer_[n]), row);
    }
}

// What W keeps from turning is taken off, and what the inertia lets turn is added.
void SoftBody::move_turns(const Vec3& torque, const Vec3& answer) {
    if (model_->turns.count == 0) {
        return;
    }
    const Vec3 turn = turn_softness_ * torque, kept = turn_overlap_ * answer;
    for (std::size_t n = 0; n < next_.size(); ++n) {
        next_[n] +=
            row_of(glm::cross(turn, vector_of(arm_[n])) - glm::cross(kept, vector_of(arm_answer_[n])));
    }
}

}  // namespace tactus
