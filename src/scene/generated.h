// Geometry that is not animated by keys but computed for every moment: a water surface, a sheet of cloth, thousands of
// bodies in flight. On the GPU passes of its own make it (src/render/generators; the net of a cloth comes from the
// host), and nobody reads it back; Simulation is their twin on the CPU.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace peelray {

/// A square of water in still air: heights h over a grid, after the wave equation h'' = c² ∆h - k h' with walls that
/// reflect, by explicit steps of equal length (semi-implicit Euler: velocities first). Drops fall into it.
struct Water {
    int node = -1;       ///< its mesh has one primitive: (cells + 1)² vertices, row by row along x
    uint32_t cells = 0;  ///< along each side
    float size = 0;      ///< of the square around the node's origin, metres
    float speed = 0;     ///< of waves, c, metres per second
    float damping = 0;   ///< k, per second
    uint32_t steps_per_second = 0;
    std::vector<float> start;  ///< heights at time 0, when all is at rest

    /// Something that floats: it rests on the mean height and slope of the surface under it.
    struct Float {
        int node = -1;
        glm::vec2 around{0};  ///< x, z of the circle that it drifts along
        float drift = 0;      ///< radius of the circle
        float period = 1;     ///< seconds per round
        float phase = 0;      ///< share of a round at time 0
        float radius = 0;     ///< of what it displaces
    };
    std::vector<Float> floats;

    float spacing() const { return size / float(cells); }
};

/// A drop: what it adds to the velocities at the distance r is strength (1 - r²/2w²) exp(-r²/2w²), which adds no water.
struct WaterDrop {
    glm::vec2 at{0};
    float strength = 0;  ///< metres per second; 0: none falls
    float width = 1;     ///< w, metres
};

/// The drop that falls at the beginning of a step.
WaterDrop drop_at(const Water& water, uint64_t step);

/// Whole steps up to a moment, and what is left of it, seconds.
struct WaterSteps {
    uint64_t steps;
    double rest;
};
WaterSteps steps_until(const Water& water, double time);

/// Where a float is at a moment: x, z, and how far it has turned about the vertical, radians.
glm::vec3 drift_of(const Water::Float& f, double time);

/// Bodies that fly out of a fountain, bounce and vanish, over and over (shaders/motion/swarm_motion.h).
struct Swarm {
    std::vector<int> nodes;  ///< one per body
    float period = 1;        ///< seconds, after which everything repeats
};

/// A square sheet of cloth on a ball that turns, in wind, over a floor. What is simulated is a net of control points
/// (ClothSimulation); the sheet is the uniform cubic B-spline surface over it, whose edges are the net's.
struct Cloth {
    int node = -1;  ///< its mesh has one primitive: (across + 1)·(along + 1) vertices, row by row along u
    uint32_t across = 0, along = 0;  ///< cells of the mesh in u and v
    uint32_t points = 0;             ///< of the net, in u and in v; at least 4
    float size = 0;                  ///< of the sheet's sides, metres
    glm::vec3 ball{0};               ///< the ball's centre, metres above the floor y = 0
    float radius = 0;                ///< of the ball
    std::vector<glm::vec3> start;    ///< the net at time 0, at rest, row by row along u

    float spacing() const { return size / float(points - 1); }
};

/// What is generated in a scene, and which of its animations drives it.
struct Generated {
    std::vector<Water> waters;
    std::vector<Swarm> swarms;
    std::vector<Cloth> cloths;
    int animation = -1;
    /// Everything that is generated stays inside this box at all times.
    struct Reach {
        glm::vec3 lower{0}, upper{0};
    } reach;

    bool empty() const { return waters.empty() && swarms.empty() && cloths.empty(); }
};

}  // namespace peelray
