#include "render/generators.h"

#include <cmath>

#include "base/error.h"
#include "base/interrupt.h"

namespace peelray {
namespace {

/// Steps in one submission: longer ones could not be interrupted.
constexpr uint64_t kStepsAtOnce = 512;
constexpr double kLongest = 3600;  // seconds

}  // namespace

Generators::Generators(Device& device, const Scene& scene, const Assembly& assembly)
    : device_(device), placed_(scene.nodes.size(), false) {
    if (!assembly.generates) return;
    std::vector<uint32_t> instance_of(scene.nodes.size(), 0);
    for (uint32_t i = 0; i < assembly.instances.size(); i++)
        if (assembly.instances[i].node >= 0) instance_of[size_t(assembly.instances[i].node)] = i;
    const auto place = [&](int node) {
        placed_[size_t(node)] = true;
        return instance_of[size_t(node)];
    };
    Commands commands(device);
    for (size_t i = 0; i < scene.generated.waters.size(); i++) {
        const Water& water = scene.generated.waters[i];
        WaterState state;
        state.water = water;
        const uint64_t vertices = water.start.size();
        for (Buffer& heights : state.heights) heights = Buffer(device, "heights of water", vertices * 4);
        state.velocities = Buffer(device, "velocities of water", vertices * 4);
        state.floats = Buffer(device, "things that swim", water.floats.size() * sizeof(GpuFloat));
        for (const Water::Float& f : water.floats) state.instances.push_back(place(f.node));
        WaterParams& p = state.params;
        p.cells = water.cells;
        p.size = water.size;
        p.step = float(1.0 / water.steps_per_second);
        p.stiffness = float(std::pow(double(water.speed) / double(water.spacing()), 2));
        p.damping = water.damping;
        p.first_vertex = assembly.surfaces[i].first_vertex;
        p.body = assembly.surfaces[i].body;
        p.floats = uint32_t(water.floats.size());
        start(commands, state);
        waters_.push_back(std::move(state));
    }
    for (size_t i = 0; i < scene.generated.cloths.size(); i++) {
        const Cloth& cloth = scene.generated.cloths[i];
        const Assembly::Piece& piece = assembly.surfaces[waters_.size() + i];
        ClothState state{ClothSimulation(cloth), {cloth.across, cloth.along, cloth.points, 0, piece.body}, {}};
        state.params.first_vertex = piece.first_vertex;
        state.net = Buffer(device, "net of cloth", cloth.start.size() * sizeof(glm::vec3));
        cloths_.push_back(std::move(state));
    }
    for (const Swarm& swarm : scene.generated.swarms) {
        std::vector<uint32_t> instances;
        for (const int node : swarm.nodes) instances.push_back(place(node));
        SwarmState state;
        state.period = swarm.period;
        state.params.bodies = uint32_t(instances.size());
        state.instances = Buffer(device, "instances of a swarm", instances.size() * 4);
        commands.upload(state.instances, std::span<const uint32_t>(instances));
        swarms_.push_back(std::move(state));
    }
}

bool Generators::places(int node) const {
    return node >= 0 && placed_[size_t(node)];
}

void Generators::start(Commands& commands, WaterState& state) {
    state.current = 0;
    state.step = 0;
    commands.upload(state.heights[0], std::span<const float>(state.water.start));
    commands.fill(state.velocities, 0);
    commands.submit();
}

void Generators::pose(Commands& commands, const Scene& scene, double time) {
    if (time > kLongest && !(waters_.empty() && cloths_.empty()))
        fail("{}: {} simulated from its beginning, for at most {} seconds: choose an earlier moment than {}",
             scene.name, waters_.empty() ? "cloth is" : "water is", kLongest, time);
    for (WaterState& state : waters_) {
        const WaterSteps moment = steps_until(state.water, time);
        if (moment.steps < state.step) start(commands, state);
        state.wanted = moment.steps;
        state.params.rest = float(moment.rest);
        std::vector<GpuFloat> floats;
        for (size_t i = 0; i < state.instances.size(); i++) {
            const glm::vec3 drift = drift_of(state.water.floats[i], time);
            floats.push_back({state.instances[i], {drift.x, drift.y}, drift.z, state.water.floats[i].radius});
        }
        if (!floats.empty()) commands.upload(state.floats, std::span<const GpuFloat>(floats));
    }
    for (ClothState& state : cloths_) {
        std::vector<glm::vec3> net;
        for (const glm::dvec3& p : state.simulation.net_at(time)) net.emplace_back(p);
        commands.upload(state.net, std::span<const glm::vec3>(net));
    }
    for (SwarmState& state : swarms_) {
        const double turns = time / double(state.period);
        state.params.phase = float(turns - std::floor(turns));
    }
}

void Generators::take_steps(Commands& commands, WaterState& state) {
    const Pass& pass = device_.pass("water_step");
    for (; state.step < state.wanted; state.step++, state.current ^= 1) {
        const WaterDrop drop = drop_at(state.water, state.step);
        WaterParams p = state.params;
        p.drop_at = drop.at;
        p.drop_strength = drop.strength;
        p.drop_width = drop.width;
        commands.run(pass,
                     {{"heights", state.heights[state.current]},
                      {"velocities", state.velocities},
                      {"next_heights", state.heights[state.current ^ 1]}},
                     p, groups_for(state.water.start.size(), 64));
        if (state.step % kStepsAtOnce != 0 || state.wanted - state.step < kStepsAtOnce) continue;
        commands.submit();
        check_interrupt();
    }
}

void Generators::record(Commands& commands, const BodyTable& bodies, const TriangleBuffers& triangles,
                        const Buffer& normals, const Instances& instances) {
    if (empty()) return;
    commands.begin_group("animate");
    for (WaterState& state : waters_) {
        take_steps(commands, state);
        const Buffer& heights = state.heights[state.current];
        commands.run(device_.pass("water_surface"),
                     {{"heights", heights},
                      {"velocities", state.velocities},
                      {"positions", triangles.positions},
                      {"normals", normals},
                      {"body_lower", bodies.lower},
                      {"body_upper", bodies.upper}},
                     state.params, groups_for(state.water.start.size(), 64));
        if (state.params.floats > 0)
            commands.run(device_.pass("water_floats"),
                         {{"heights", heights},
                          {"velocities", state.velocities},
                          {"floats", state.floats},
                          {"transforms", instances.transforms()}},
                         state.params, groups_for(state.params.floats, 64));
    }
    for (const ClothState& state : cloths_)
        commands.run(device_.pass("cloth_surface"),
                     {{"net", state.net},
                      {"positions", triangles.positions},
                      {"normals", normals},
                      {"body_lower", bodies.lower},
                      {"body_upper", bodies.upper}},
                     state.params, groups_for(uint64_t(state.params.across + 1) * (state.params.along + 1), 64));
    for (const SwarmState& state : swarms_)
        commands.run(device_.pass("swarm"),
                     {{"swarm_instances", state.instances}, {"transforms", instances.transforms()}}, state.params,
                     groups_for(state.params.bodies, 64));
    commands.end_group();
}

uint64_t Generators::bytes() const {
    uint64_t bytes = 0;
    for (const WaterState& state : waters_)
        bytes += state.heights[0].bytes() + state.heights[1].bytes() + state.velocities.bytes() + state.floats.bytes();
    for (const ClothState& state : cloths_) bytes += state.net.bytes();
    for (const SwarmState& state : swarms_) bytes += state.instances.bytes();
    return bytes;
}

}  // namespace peelray
