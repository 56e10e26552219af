#include "motion/cloth.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace peelray {
namespace {

constexpr double kStep = 1.0 / ClothSimulation::steps_per_second;
constexpr double kGravity = 9.81, kSkin = 0.012;  // metres: the sheet's net stays that far off the ball and the floor
constexpr uint32_t kContactsEvery = 8;            // steps
/// How far apart the net's points stay, in spacings. Points in a square of the net's corners lie at most 0.71 from the
/// nearest: so no point passes through the net.
constexpr double kApart = 0.95;

/// How far the ball has turned about the vertical, radians; it starts without a jerk.
double turn_of_ball(double time) {
    return 0.85 * (1 - std::cos(1.15 * time)) + 0.22 * (1 - std::cos(2.9 * time));
}

glm::dvec3 wind_at(const glm::dvec3& p, double time) {
    const double begun = 1 - std::exp(-0.8 * time);
    const double gust = 0.55 + 0.45 * std::sin(1.7 * time + 0.9 * p.x) * std::sin(0.63 * time + 0.4);
    const glm::dvec3 eddies(std::sin(3.1 * time + 4.1 * p.z), 0.5 * std::sin(2.3 * time + 3.7 * p.x + 1),
                            std::sin(2.7 * time - 3.9 * p.x + 2));
    return begun * (gust * glm::dvec3(2.3, 0.25, -1.1) + 0.8 * eddies);
}

double square(double x) {
    return x * x;
}

}  // namespace

ClothSimulation::ClothSimulation(const Cloth& cloth) : cloth_(cloth) {
    if (cloth_.start.empty()) {
        // Turned a little, and not quite flat, so that folds do not have to be born from symmetry.
        const double angle = 0.3, spacing = double(cloth_.spacing());
        for (uint32_t j = 0; j < cloth_.points; j++)
            for (uint32_t i = 0; i < cloth_.points; i++) {
                const double x = i * spacing - 0.5 * double(cloth_.size), z = j * spacing - 0.5 * double(cloth_.size);
                cloth_.start.push_back(
                    glm::dvec3(cloth_.ball) +
                    glm::dvec3(std::cos(angle) * x - std::sin(angle) * z,
                               double(cloth_.radius) + 2 * kSkin + 0.004 * std::sin(9 * x + 1) * std::sin(7 * z + 2),
                               std::sin(angle) * x + std::cos(angle) * z));
            }
    }
    link();
    positions_.assign(cloth_.start.begin(), cloth_.start.end());
    velocities_.assign(positions_.size(), glm::dvec3(0));
}

void ClothSimulation::link() {
    const auto n = int(cloth_.points);
    const double spacing = double(cloth_.spacing());
    // Threads hardly stretch, the weave shears easily, and it hardly resists bending.
    constexpr struct {
        int x, z;
        double compliance;
    } kinds[] = {{1, 0, 1e-8}, {0, 1, 1e-8}, {1, 1, 2e-5}, {1, -1, 2e-5}, {2, 0, 4e-4}, {0, 2, 4e-4}};
    for (const auto& kind : kinds)
        for (int z = 0; z < n; z++)
            for (int x = 0; x < n; x++) {
                const int x1 = x + kind.x, z1 = z + kind.z;
                if (x1 >= n || z1 < 0 || z1 >= n) continue;
                links_.push_back({uint32_t(z * n + x), uint32_t(z1 * n + x1),
                                  spacing * std::sqrt(double(kind.x * kind.x + kind.z * kind.z)), kind.compliance});
            }
}

void ClothSimulation::add_wind(double time, double dt) {
    const uint32_t n = cloth_.points;
    for (uint32_t z = 0; z < n; z++)
        for (uint32_t x = 0; x < n; x++) {
            const uint32_t i = z * n + x;
            const glm::dvec3 along_x = positions_[x + 1 < n ? i + 1 : i] - positions_[x > 0 ? i - 1 : i],
                             along_z = positions_[z + 1 < n ? i + n : i] - positions_[z > 0 ? i - n : i];
            const glm::dvec3 normal = glm::normalize(glm::cross(along_z, along_x));
            const glm::dvec3 air = (wind_ == 0 ? glm::dvec3(0) : wind_ * wind_at(positions_[i], time)) - velocities_[i];
            velocities_[i] += dt * (1.9 * glm::dot(air, normal) * normal + 0.15 * air);
        }
}

void ClothSimulation::find_contacts() {
    // Cells as wide as points may be apart that come to touch within the next steps.
    const double near = double(cloth_.spacing()) * (kApart + 0.35);
    const auto n = int(cloth_.points);
    contacts_.clear();
    std::vector<std::pair<uint64_t, uint32_t>> cells;
    const auto key = [](int x, int y, int z) {
        return uint64_t(x + 4096) << 40 | uint64_t(y + 4096) << 20 | uint64_t(z + 4096);
    };
    const auto cell = [&](const glm::dvec3& p) { return glm::ivec3(glm::floor(p / near)); };
    for (uint32_t i = 0; i < positions_.size(); i++) {
        const glm::ivec3 c = cell(positions_[i]);
        cells.emplace_back(key(c.x, c.y, c.z), i);
    }
    std::sort(cells.begin(), cells.end());
    for (uint32_t i = 0; i < positions_.size(); i++) {
        const glm::ivec3 c = cell(positions_[i]);
        for (int dx = -1; dx <= 1; dx++)
            for (int dy = -1; dy <= 1; dy++) {
                // Three cells in a row are neighbours in the list.
                auto at = std::lower_bound(cells.begin(), cells.end(),
                                           std::pair(key(c.x + dx, c.y + dy, c.z - 1), uint32_t(0)));
                for (; at != cells.end() && at->first <= key(c.x + dx, c.y + dy, c.z + 1); ++at) {
                    const uint32_t j = at->second;
                    if (j <= i) continue;
                    const int x = std::abs(int(i) % n - int(j) % n), z = std::abs(int(i) / n - int(j) / n);
                    // Neighbours in the sheet are held apart by their links.
                    if (std::max(x, z) <= 2) continue;
                    const glm::dvec3 way = positions_[j] - positions_[i];
                    if (glm::dot(way, way) < near * near) contacts_.emplace_back(i, j);
                }
            }
    }
}

void ClothSimulation::keep_apart() {
    const double least = kApart * double(cloth_.spacing());
    for (const auto& [i, j] : contacts_) {
        const glm::dvec3 way = positions_[j] - positions_[i];
        const double distance = glm::length(way);
        if (distance >= least || distance == 0) continue;
        const glm::dvec3 push = way * (0.5 * (least - distance) / distance);
        positions_[i] -= push;
        positions_[j] += push;
        // Friction: they go on together.
        const glm::dvec3 slip = 0.25 * ((positions_[j] - before_[j]) - (positions_[i] - before_[i]));
        positions_[i] += 0.3 * slip;
        positions_[j] -= 0.3 * slip;
    }
}

void ClothSimulation::keep_outside(double turn) {
    const glm::dvec3 ball(cloth_.ball);
    const double reach = double(cloth_.radius) + kSkin, cosine = std::cos(turn), sine = std::sin(turn);
    for (size_t i = 0; i < positions_.size(); i++) {
        glm::dvec3& p = positions_[i];
        const glm::dvec3 from = p - ball;
        const double distance2 = glm::dot(from, from);
        if (distance2 < reach * reach) {
            p = ball + from * (reach / std::sqrt(distance2));
            // Where the ball takes what lies on it, but for some slip.
            const glm::dvec3 old = before_[i] - ball;
            const glm::dvec3 taken =
                ball + glm::dvec3(cosine * old.x + sine * old.z, old.y, cosine * old.z - sine * old.x);
            p = glm::mix(p, taken, 0.6);
        }
        if (p.y < kSkin) {
            p.y = kSkin;
            p.x = glm::mix(p.x, before_[i].x, 0.7);
            p.z = glm::mix(p.z, before_[i].z, 0.7);
        }
    }
}

void ClothSimulation::take_step(double time, double damping) {
    const double keep = std::exp(-damping * kStep);
    add_wind(time, kStep);
    before_ = positions_;
    for (size_t i = 0; i < positions_.size(); i++) {
        velocities_[i] *= keep;
        velocities_[i].y -= kGravity * kStep;
        positions_[i] += kStep * velocities_[i];
    }
    if (step_ % kContactsEvery == 0) find_contacts();
    for (const Link& link : links_) {
        glm::dvec3 &a = positions_[link.a], &b = positions_[link.b];
        const glm::dvec3 way = b - a;
        const double length = glm::length(way);
        // All points weigh the same: 1 each, in units of compliance.
        const glm::dvec3 push = way * ((length - link.length) / (length * (2 + link.compliance / square(kStep))));
        a += push;
        b -= push;
    }
    keep_apart();
    keep_outside(wind_ == 0 ? 0 : turn_of_ball(time + kStep) - turn_of_ball(time));
    for (size_t i = 0; i < positions_.size(); i++) velocities_[i] = (positions_[i] - before_[i]) / kStep;
    step_++;
}

void ClothSimulation::advance(uint64_t steps) {
    if (step_ > steps) {
        positions_.assign(cloth_.start.begin(), cloth_.start.end());
        velocities_.assign(positions_.size(), glm::dvec3(0));
        step_ = 0;
    }
    while (step_ < steps) take_step(double(step_) * kStep, 0.35);
}

void ClothSimulation::settle() {
    wind_ = 0;
    for (int i = 0; i < 1100; i++) take_step(0, i < 550 ? 0.5 : 3);
    wind_ = 1;
    step_ = 0;
    cloth_.start.assign(positions_.begin(), positions_.end());
    // As it comes out of Cloth::start.
    positions_.assign(cloth_.start.begin(), cloth_.start.end());
    velocities_.assign(positions_.size(), glm::dvec3(0));
}

std::vector<glm::dvec3> ClothSimulation::net_at(double time) {
    const double steps = std::floor(time * steps_per_second + 1e-6), rest = std::max(time - steps * kStep, 0.0);
    advance(uint64_t(steps));
    std::vector<glm::dvec3> net = positions_;
    for (size_t i = 0; i < net.size(); i++) net[i] += rest * velocities_[i];
    return net;
}

namespace {

/// The uniform cubic B-spline with its derivative, from the four values around a piece.
struct Spline {
    glm::dvec3 value, slope;
};

Spline spline(const std::array<glm::dvec3, 4>& p, double t) {
    // In powers of t.
    const glm::dvec3 c0 = (p[0] + 4.0 * p[1] + p[2]) / 6.0, c1 = 0.5 * (p[2] - p[0]),
                     c2 = 0.5 * (p[0] - 2.0 * p[1] + p[2]), c3 = (p[3] - p[0] + 3.0 * (p[1] - p[2])) / 6.0;
    return {c0 + t * (c1 + t * (c2 + t * c3)), c1 + t * (2.0 * c2 + 3.0 * t * c3)};
}

/// Number `i` of `n` values; those beyond the ends lie straight ahead.
template <typename Value>
glm::dvec3 extended(const Value& value, int i, int n) {
    if (i < 0) return 2.0 * value(0) - value(1);
    if (i >= n) return 2.0 * value(n - 1) - value(n - 2);
    return value(i);
}

}  // namespace

ClothPoint cloth_point(const Cloth& cloth, const std::vector<glm::dvec3>& net, double u, double v) {
    const auto n = int(cloth.points);
    const auto piece = [&](double at) { return std::min(int(at * (n - 1)), n - 2); };
    const int x = piece(u), z = piece(v);
    const double s = u * (n - 1) - x, t = v * (n - 1) - z;
    // The rows of the net around it, each as a curve along u.
    const auto row = [&](int j) {
        std::array<glm::dvec3, 4> points;
        for (int k = 0; k < 4; k++)
            points[size_t(k)] = extended([&](int i) { return net[size_t(j * n + i)]; }, x - 1 + k, n);
        return spline(points, s);
    };
    std::array<glm::dvec3, 4> values, slopes;
    for (int k = 0; k < 4; k++) {
        values[size_t(k)] = extended([&](int j) { return row(j).value; }, z - 1 + k, n);
        slopes[size_t(k)] = extended([&](int j) { return row(j).slope; }, z - 1 + k, n);
    }
    const Spline across = spline(values, t);
    return {across.value, glm::normalize(glm::cross(across.slope, spline(slopes, t).value))};
}

}  // namespace peelray
