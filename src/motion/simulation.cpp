#include "motion/simulation.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

#include "base/parallel.h"
#include "motion/swarm_motion.h"

namespace peelray {
namespace {

/// One step of the heights, see Water.
void take_step(const Water& water, Simulation::Heights& state) {
    const uint32_t row = water.cells + 1;
    const double dt = 1.0 / water.steps_per_second, dx = water.spacing();
    const double stiffness = double(water.speed) * water.speed / (dx * dx);
    const WaterDrop drop = drop_at(water, state.step);
    std::vector<double> next(state.heights.size());
    for (uint32_t z = 0; z < row; z++)
        for (uint32_t x = 0; x < row; x++) {
            const size_t i = size_t(z) * row + x;
            const auto height = [&](uint32_t xi, uint32_t zi) { return state.heights[size_t(zi) * row + xi]; };
            const double around = height(x > 0 ? x - 1 : x, z) + height(std::min(x + 1, row - 1), z) +
                                  height(x, z > 0 ? z - 1 : z) + height(x, std::min(z + 1, row - 1));
            double velocity = state.velocities[i];
            if (drop.strength != 0) {
                const glm::dvec2 p(x * dx - 0.5 * water.size - drop.at.x, z * dx - 0.5 * water.size - drop.at.y);
                const double q = glm::dot(p, p) / (2.0 * drop.width * drop.width);
                velocity += drop.strength * (1 - q) * std::exp(-q);
            }
            velocity += dt * (stiffness * (around - 4 * state.heights[i]) - water.damping * velocity);
            state.velocities[i] = velocity;
            next[i] = state.heights[i] + dt * velocity;
        }
    state.heights = std::move(next);
    state.step++;
}

void advance(const Water& water, Simulation::Heights& state, uint64_t steps) {
    if (state.heights.empty() || state.step > steps) {
        state.heights.assign(water.start.begin(), water.start.end());
        state.velocities.assign(water.start.size(), 0);
        state.step = 0;
    }
    while (state.step < steps) take_step(water, state);
}

/// Heights at a moment between two steps.
class Surface {
  public:
    Surface(const Water& water, const Simulation::Heights& state, double rest)
        : water_(water), state_(state), rest_(rest), row_(water.cells + 1) {}

    double at(uint32_t x, uint32_t z) const {
        const size_t i = size_t(z) * row_ + x;
        return state_.heights[i] + rest_ * state_.velocities[i];
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
    const Simulation::Heights& state_;
    double rest_;
    uint32_t row_;
};

/// As shaders/motion/water_floats.comp.
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

void place_water(const Scene& scene, const Water& water, Simulation::Heights& state, Moment& moment) {
    const WaterSteps time = steps_until(water, moment.generated_time);
    advance(water, state, time.steps);
    const Surface surface(water, state, time.rest);
    const Primitive& primitive = scene.meshes[size_t(scene.nodes[size_t(water.node)].mesh)].primitives[0];
    Moment::Surface moved{water.node, primitive.positions, primitive.normals};
    const uint32_t row = water.cells + 1;
    for (uint32_t z = 0; z < row; z++)
        for (uint32_t x = 0; x < row; x++) {
            moved.positions[size_t(z) * row + x].y = float(surface.at(x, z));
            moved.normals[size_t(z) * row + x] = surface.normal(x, z);
        }
    moment.surfaces.push_back(std::move(moved));
    for (const Water::Float& f : water.floats)
        moment.locals[size_t(f.node)] = float_transform(surface, f, moment.generated_time);
}

void place_cloth(const Scene& scene, const Cloth& cloth, ClothSimulation& simulation, Moment& moment) {
    const std::vector<glm::dvec3> net = simulation.net_at(moment.generated_time);
    const Primitive& primitive = scene.meshes[size_t(scene.nodes[size_t(cloth.node)].mesh)].primitives[0];
    Moment::Surface moved{cloth.node, primitive.positions, primitive.normals};
    const size_t row = cloth.across + 1;
    parallel_for(moved.positions.size(), 1024, [&](size_t i) {
        const ClothPoint p = cloth_point(cloth, net, double(i % row) / cloth.across, double(i / row) / cloth.along);
        moved.positions[i] = p.position;
        moved.normals[i] = p.normal;
    });
    moment.surfaces.push_back(std::move(moved));
}

}  // namespace

void Simulation::place(const Scene& scene, Moment& moment) {
    const Generated& generated = scene.generated;
    if (generated.empty()) return;
    moment.surfaces.clear();
    waters_.resize(generated.waters.size());
    for (size_t i = 0; i < waters_.size(); i++) place_water(scene, generated.waters[i], waters_[i], moment);
    for (size_t i = cloths_.size(); i < generated.cloths.size(); i++) cloths_.emplace_back(generated.cloths[i]);
    for (size_t i = 0; i < cloths_.size(); i++) place_cloth(scene, generated.cloths[i], cloths_[i], moment);
    for (const Swarm& swarm : generated.swarms) {
        const double turns = moment.generated_time / double(swarm.period);
        for (uint32_t i = 0; i < swarm.nodes.size(); i++) {
            const SwarmPlace place = swarmPlace(i, float(turns - std::floor(turns)));
            glm::dmat4& local = moment.locals[size_t(swarm.nodes[i])];
            local = glm::dmat4(glm::mat4(place.linear));
            local[3] = glm::dvec4(place.position, 1);
        }
    }
    moment.worlds = world_matrices(scene, moment.locals);
}

void settle(Scene& scene) {
    Moment moment = at_rest(scene);
    Simulation().place(scene, moment);
    for (size_t i = 0; i < scene.nodes.size(); i++) scene.nodes[i].local = moment.locals[i];
    for (Moment::Surface& surface : moment.surfaces) {
        Primitive& primitive = scene.meshes[size_t(scene.nodes[size_t(surface.node)].mesh)].primitives[0];
        primitive.positions = std::move(surface.positions);
        primitive.normals = std::move(surface.normals);
    }
}

}  // namespace peelray
