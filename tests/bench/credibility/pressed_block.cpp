#include "credibility/pressed_block.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <utility>
#include <vector>

#include "core/math/types.hpp"

namespace tactus::bench {

namespace {

// Places from 0 to `length` whose distances grow from `finest` by a constant factor.
std::vector<double> graded(double length, int count, double finest) {
    double low = 1.0, high = 2.0;
    const auto reached = [&](double factor) {
        double sum = 0.0;
        for (int i = 0; i < count; ++i)
            sum = sum * factor + finest;
        return sum;
    };
    for (int i = 0; i < 60; ++i)
        (reached(0.5 * (low + high)) < length ? low : high) = 0.5 * (low + high);
    std::vector<double> places{0.0};
    for (int i = 0; i < count; ++i)
        places.push_back(places.back() + finest * std::pow(low, i));
    for (double& place : places)
        place *= length / places.back();
    return places;
}

Mat3 rotation_of(const Mat3& f) {
    Mat3 r = f;
    for (int i = 0; i < 8; ++i)
        r = 0.5 * (r + glm::transpose(glm::inverse(r)));
    return r;
}

double trace_of(const Mat3& a, const Mat3& b) {  // of the transpose of a, times b
    return glm::dot(a[0], b[0]) + glm::dot(a[1], b[1]) + glm::dot(a[2], b[2]);
}

using Field = std::vector<Vec3>;

double dot(const Field& a, const Field& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i)
        sum += glm::dot(a[i], b[i]);
    return sum;
}

// The last place of each field is the ball's center, which moves along y.
class Quarter {
public:
    explicit Quarter(const PressedBlock& block) : block_(block) {
        const std::vector<double> wide = graded(block.half, block.across, block.finest);
        const std::vector<double> deep = graded(2.0 * block.half, block.down, block.finest);
        const auto at = [&](int x, int y, int z) {
            return static_cast<std::size_t>((x * (block.down + 1) + y) * (block.across + 1) + z);
        };
        const auto part = [&](int i) {
            const auto k = static_cast<std::size_t>(i);
            return 0.5 *
                   ((i > 0 ? wide[k] - wide[k - 1] : 0.0) + (i < block.across ? wide[k + 1] - wide[k] : 0.0));
        };
        for (int x = 0; x <= block.across; ++x)
            for (int y = 0; y <= block.down; ++y)
                for (int z = 0; z <= block.across; ++z) {
                    places.push_back({wide[static_cast<std::size_t>(x)], -deep[static_cast<std::size_t>(y)],
                                      wide[static_cast<std::size_t>(z)]});
                    const bool stands = y == block.down;
                    free_.push_back({!stands && x > 0, !stands, !stands && z > 0});
                    area_.push_back(y == 0 ? part(x) * part(z) : 0.0);
                }
        for (int x = 0; x < block.across; ++x)
            for (int y = 0; y < block.down; ++y)
                for (int z = 0; z < block.across; ++z)
                    add_brick([&](int c) { return at(x + (c & 1), y + (c >> 1 & 1), z + (c >> 2)); });
        places.push_back({0.0, block.radius, 0.0});
        free_.push_back({0.0, 1.0, 0.0});
        area_.push_back(0.0);
    }

    Field places;
    double hand = 0.0;  // below where the ball touches first

    // Four times that of the quarter's share of the spring.
    double force() const { return block_.spring * (places.back().y - block_.radius + hand); }

    double energy(const Field& x) const {
        double sum = 0.0;
        for (const Point& point : points_) {
            const Mat3 f = deformation(point, x), r = rotation_of(f), d = f - r;
            const double change = trace_of(r, f) - 3.0;
            sum += point.volume * (shear_ * trace_of(d, d) + 0.5 * bulk_ * change * change);
        }
        for (std::size_t i = 0; i + 1 < x.size(); ++i) {
            const double gap = gap_of(x, i);
            sum += gap < 0.0 ? 0.5 * wall_ * area_[i] * gap * gap : 0.0;
        }
        const double spring = x.back().y - block_.radius + hand;
        return sum + 0.125 * block_.spring * spring * spring;
    }

    // Minus the slope of the energy; and the rotations and the normals at which change() is taken.
    Field pull() {
        Field result(places.size(), Vec3(0.0));
        for (Point& point : points_) {
            const Mat3 f = deformation(point, places);
            point.rotation = rotation_of(f);
            const double bulk = bulk_ * (trace_of(point.rotation, f) - 3.0);
            scatter(point, 2.0 * shear_ * (f - point.rotation) + bulk * point.rotation, result);
        }
        normal_.assign(places.size(), Vec3(0.0));
        for (std::size_t i = 0; i + 1 < places.size(); ++i) {
            const double gap = gap_of(places, i);
            if (gap >= 0.0)
                continue;
            normal_[i] = glm::normalize(places[i] - places.back());
            result[i] -= wall_ * area_[i] * gap * normal_[i];
            result.back() += wall_ * area_[i] * gap * normal_[i];
        }
        result.back().y -= 0.25 * block_.spring * (places.back().y - block_.radius + hand);
        return of_free(std::move(result));
    }

    // How the slope changes along a way, rotations and normals as they are.
    Field change(const Field& way) const {
        Field result(way.size(), Vec3(0.0));
        for (const Point& point : points_) {
            const Mat3 local = glm::transpose(point.rotation) * deformation(point, way);
            const double bulk = bulk_ * (local[0].x + local[1].y + local[2].z);
            const Mat3 stress = shear_ * (local + glm::transpose(local)) + bulk * Mat3(1.0);
            scatter(point, -1.0 * (point.rotation * stress), result);
        }
        for (std::size_t i = 0; i + 1 < way.size(); ++i) {
            const Vec3 along = wall_ * area_[i] * glm::dot(way[i] - way.back(), normal_[i]) * normal_[i];
            result[i] += along;
            result.back() -= along;
        }
        result.back().y += 0.25 * block_.spring * way.back().y;
        return of_free(std::move(result));
    }

private:
    struct Point {  // of integration
        std::array<std::size_t, 8> node{};
        std::array<Vec3, 8> slope{};  // of the nodes' shares (unit: 1/meter)
        double volume = 0.0;
        Mat3 rotation{1.0};
    };

    void add_brick(const std::function<std::size_t(int)>& node) {
        const Vec3 size = glm::abs(places[node(7)] - places[node(0)]);
        const Vec3 sign(1.0, -1.0, 1.0);  // y goes down
        for (int p = 0; p < 8; ++p) {
            Point point;
            point.volume = size.x * size.y * size.z / 8.0;
            const auto side = [](int of) {
                return Vec3((of & 1) != 0 ? 1.0 : -1.0, (of & 2) != 0 ? 1.0 : -1.0,
                            (of & 4) != 0 ? 1.0 : -1.0);
            };
            const Vec3 at = side(p) / std::sqrt(3.0);
            for (int c = 0; c < 8; ++c) {
                const Vec3 share = 0.5 * (1.0 + at * side(c));
                const Vec3 slope(share.y * share.z, share.z * share.x, share.x * share.y);
                point.node[static_cast<std::size_t>(c)] = node(c);
                point.slope[static_cast<std::size_t>(c)] = slope * side(c) * sign / size;
            }
            points_.push_back(point);
        }
    }

    static Mat3 deformation(const Point& point, const Field& x) {
        Mat3 f(0.0);
        for (std::size_t c = 0; c < 8; ++c)
            f += glm::outerProduct(x[point.node[c]], point.slope[c]);
        return f;
    }

    static void scatter(const Point& point, const Mat3& stress, Field& to) {
        for (std::size_t c = 0; c < 8; ++c)
            to[point.node[c]] -= point.volume * (stress * point.slope[c]);
    }

    double gap_of(const Field& x, std::size_t i) const {
        return area_[i] > 0.0 ? glm::distance(x[i], x.back()) - block_.radius : 1.0;
    }

    Field of_free(Field field) const {
        for (std::size_t i = 0; i < field.size(); ++i)
            field[i] *= free_[i];
        return field;
    }

    PressedBlock block_;
    double shear_ = block_.modulus / (2.0 * (1.0 + block_.poisson));
    double bulk_ = 2.0 * shear_ * block_.poisson / (1.0 - 2.0 * block_.poisson);
    double wall_ = 50.0 * block_.modulus / block_.finest;  // between the ball and the top
    std::vector<Vec3> free_;                               // 1 along axes on which a place is free
    std::vector<double> area_;                             // of the top that a place stands for
    std::vector<Vec3> normal_;
    std::vector<Point> points_;
};

// The way at which the change of the slope is the pull, within a hundredth.
Field newton_way(const Quarter& quarter, const Field& pull) {
    Field way(pull.size(), Vec3(0.0)), left = pull, direction = pull;
    double now = dot(left, left);
    const double enough = 1e-4 * now;
    for (int i = 0; i < 1000 && now > enough; ++i) {
        const Field bent = quarter.change(direction);
        const double share = now / dot(direction, bent);
        for (std::size_t n = 0; n < way.size(); ++n) {
            way[n] += share * direction[n];
            left[n] -= share * bent[n];
        }
        const double before = std::exchange(now, dot(left, left));
        for (std::size_t n = 0; n < way.size(); ++n)
            direction[n] = left[n] + now / before * direction[n];
    }
    return way;
}

}  // namespace

double force_of(const PressedBlock& block) {
    Quarter quarter(block);
    constexpr int increments = 3;
    for (int increment = 1; increment <= increments; ++increment) {
        quarter.hand = block.depth * increment / increments;
        for (int i = 0; i < 60; ++i) {
            const Field pull = quarter.pull();
            if (std::sqrt(dot(pull, pull)) < 1e-5)
                break;
            const Field way = newton_way(quarter, pull);
            const double energy = quarter.energy(quarter.places), slope = dot(pull, way);
            Field next = quarter.places;
            for (double share = 1.0; share > 1e-4; share *= 0.5) {
                for (std::size_t n = 0; n < next.size(); ++n)
                    next[n] = quarter.places[n] + share * way[n];
                if (quarter.energy(next) <= energy - 1e-4 * share * slope)
                    break;
            }
            quarter.places = next;
        }
    }
    return quarter.force();
}

}  // namespace tactus::bench
