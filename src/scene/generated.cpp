#include "scene/generated.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

#include "motion/swarm_motion.h"
#include "scene/scene.h"

namespace peelray {
namespace {

constexpr double kDropEvery = 0.55;  // seconds

/// Repeatable numbers in [0, 1).
float random_of(uint64_t a, uint64_t b) {
    uint64_t x = a * 0x9E3779B97F4A7C15ull + b * 0xD1B54A32D192ED03ull + 0x632BE59BD9B4E019ull;
    x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9ull;
    x = (x ^ (x >> 27)) * 0x94D049BB133111EBull;
    return float((x ^ (x >> 31)) >> 40) * 0x1p-24f;
}

/// One step of the heights, see Water.
void take_step(Water& water) {
    const uint32_t row = water.cells + 1;
    const double dt = 1.0 / water.steps_per_second, dx = water.spacing();
    const double stiffness = double(water.speed) * water.speed / (dx * dx);
    const WaterDrop drop = drop_at(water, water.step);
    std::vector<double> next(water.heights.size());
    for (uint32_t z = 0; z < row; z++)
        for (uint32_t x = 0; x < row; x++) {
            const size_t i = size_t(z) * row + x;
            const auto height = [&](uint32_t xi, uint32_t zi) { return water.heights[size_t(zi) * row + xi]; };
            const double around = height(x > 0 ? x - 1 : x, z) + height(std::min(x + 1, row - 1), z) +
                                  height(x, z > 0 ? z - 1 : z) + height(x, std::min(z + 1, row - 1));
            double velocity = water.velocities[i];
            if (drop.strength != 0) {
                const glm::dvec2 p(x * dx - 0.5 * water.size - drop.at.x, z * dx - 0.5 * water.size - drop.at.y);
                const double q = glm::dot(p, p) / (2.0 * drop.width * drop.width);
                velocity += drop.strength * (1 - q) * std::exp(-q);
            }
            velocity += dt * (stiffness * (around - 4 * water.heights[i]) - water.damping * velocity);
            water.velocities[i] = velocity;
            next[i] = water.heights[i] + dt * velocity;
        }
    water.heights = std::move(next);
    water.step++;
}

void advance(Water& water, uint64_t steps) {
    if (water.heights.empty() || water.step > steps) {
        water.heights.assign(water.start.begin(), water.start.end());
        water.velocities.assign(water.start.size(), 0);
        water.step = 0;
    }
    while (water.step < steps) take_step(water);
}

/// Heights at a moment between two steps.
class Surface {
  public:
    Surface(const Water& water, double rest) : water_(water), rest_(rest), row_(water.cells + 1) {}

    double at(uint32_t x, uint32_t z) const {
        const size_t i = size_t(z) * row_ + x;
        return water_.heights[i] + rest_ * water_.velocities[i];
    }
    /// Bilinear, at a place in metres.
    double at(const glm::dvec2& p) const {
        const glm::dvec2 q =
            glm::clamp((p / double(water_.size) + 0.5) * double(water_.cells), 0.0, double(water_.cells) - 1e-6);
        const auto x = uint32_t(q.x), z = uint32_t(q.y);
        const double fx = q.x - x, fz = q.y - z;
        return (at(x, z) * (1 - fx) + at(x + 1, z) * fx) * (1 - fz) +
               (at(x, z + 1) * (1 - fx) + at(x + 1, z + 1) * fx) * fz;
    }
    glm::vec3 normal(uint32_t x, uint32_t z) const {
        const uint32_t x0 = x > 0 ? x - 1 : x, x1 = std::min(x + 1, water_.cells), z0 = z > 0 ? z - 1 : z,
                       z1 = std::min(z + 1, water_.cells);
        const double dx = water_.spacing();
        return glm::normalize(
            glm::dvec3((at(x0, z) - at(x1, z)) / ((x1 - x0) * dx), 1, (at(x, z0) - at(x, z1)) / ((z1 - z0) * dx)));
    }

  private:
    const Water& water_;
    double rest_;
    uint32_t row_;
};

/// As shaders/water_floats.comp.
glm::mat4 float_transform(const Surface& surface, const Water::Float& f, double time) {
    const glm::vec3 drift = drift_of(f, time);
    const glm::dvec2 at(drift.x, drift.y);
    double mean = surface.at(at);
    glm::dvec2 slope(0);
    for (int i = 0; i < 8; i++) {
        const double angle = i * std::numbers::pi / 4;
        const glm::dvec2 arm = 0.7 * double(f.radius) * glm::dvec2(std::cos(angle), std::sin(angle));
        const double height = surface.at(at + arm);
        mean += height;
        slope += height * arm;
    }
    mean /= 9;
    slope /= 4 * 0.49 * double(f.radius) * f.radius;
    const glm::dvec3 up = glm::normalize(glm::dvec3(-slope.x, 1, -slope.y));
    const glm::dvec3 ahead(std::cos(double(drift.z)), 0, std::sin(double(drift.z)));
    const glm::dvec3 x = glm::normalize(ahead - up * glm::dot(ahead, up));
    glm::dmat4 out(1);
    out[0] = glm::dvec4(x, 0);
    out[1] = glm::dvec4(up, 0);
    out[2] = glm::dvec4(glm::cross(x, up), 0);
    out[3] = glm::dvec4(at.x, mean, at.y, 1);
    return glm::mat4(out);
}

void simulate(Scene& scene, Water& water, double time) {
    const WaterMoment moment = moment_of(water, time);
    advance(water, moment.steps);
    const Surface surface(water, moment.rest);
    Primitive& primitive = scene.meshes[size_t(scene.nodes[size_t(water.node)].mesh)].primitives[0];
    const uint32_t row = water.cells + 1;
    for (uint32_t z = 0; z < row; z++)
        for (uint32_t x = 0; x < row; x++) {
            primitive.positions[size_t(z) * row + x].y = float(surface.at(x, z));
            primitive.normals[size_t(z) * row + x] = surface.normal(x, z);
        }
    for (const Water::Float& f : water.floats) scene.nodes[size_t(f.node)].local = float_transform(surface, f, time);
}

}  // namespace

WaterDrop drop_at(const Water& water, uint64_t step) {
    // The number of the drop that the time of this step has passed, if the last one's has not.
    const auto number = [&](uint64_t s) { return uint64_t(double(s) / water.steps_per_second / kDropEvery); };
    if (step == 0 || number(step) == number(step - 1)) return {};
    const uint64_t i = number(step);
    const float reach = 0.42f * water.size;
    return {{reach * (2 * random_of(i, 0) - 1), reach * (2 * random_of(i, 1) - 1)},
            -0.9f - 0.9f * random_of(i, 2),
            0.06f + 0.05f * random_of(i, 3)};
}

WaterMoment moment_of(const Water& water, double time) {
    const double steps = std::floor(time * water.steps_per_second + 1e-6);
    return {uint64_t(steps), std::max(time - steps / water.steps_per_second, 0.0)};
}

glm::vec3 drift_of(const Water::Float& f, double time) {
    const double turns = time / double(f.period) + f.phase, angle = 2 * std::numbers::pi * (turns - std::floor(turns));
    return {f.around.x + f.drift * float(std::cos(angle)), f.around.y + f.drift * float(std::sin(angle)), float(angle)};
}

void simulate(Scene& scene) {
    for (Water& water : scene.generated.waters) simulate(scene, water, scene.generated.time);
    for (const Swarm& swarm : scene.generated.swarms) {
        const double turns = scene.generated.time / double(swarm.period);
        for (uint32_t i = 0; i < swarm.nodes.size(); i++) {
            const SwarmPlace place = swarmPlace(i, float(turns - std::floor(turns)));
            glm::mat4 local(place.linear);
            local[3] = glm::vec4(place.position, 1);
            scene.nodes[size_t(swarm.nodes[i])].local = local;
        }
    }
}

}  // namespace peelray
