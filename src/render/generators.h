// What is generated (Scene::generated), made on the GPU for every moment; nothing of it is ever read back.
#pragma once

#include "assembly/assembly.h"
#include "ldc/instances.h"
#include "ldc/triangle_buffers.h"
#include "motion/cloth.h"
#include "motion/motion_params.h"

namespace peelray {

class Generators {
  public:
    /// Makes room for what of the scene is generated and moves in this assembly.
    Generators(Device& device, const Scene& scene, const Assembly& assembly);

    bool empty() const { return waters_.empty() && cloths_.empty() && swarms_.empty(); }

    /// Takes on the moment `time` of the scene, seconds. Throws Error for one that is too far from the beginning to be
    /// simulated.
    void pose(Commands& commands, const Scene& scene, double time);

    /// Records the passes into the group "animate": vertices and bounds of bodies (whose bounds have been emptied), and
    /// transforms of instances. Submits in between if there are very many steps to take.
    void record(Commands& commands, const BodyTable& bodies, const TriangleBuffers& triangles, const Buffer& normals,
                const Instances& instances);

    /// Is this node's instance placed here?
    bool places(int node) const;

    uint64_t bytes() const;

  private:
    struct WaterState {
        Water water;
        WaterParams params{};
        Buffer heights[2], velocities, floats;
        uint32_t current = 0;  ///< which heights
        uint64_t step = 0, wanted = 0;
        std::vector<uint32_t> instances;  ///< of the floats
    };
    struct ClothState {
        ClothSimulation simulation;
        ClothParams params{};
        Buffer net;
    };
    struct SwarmState {
        float period = 1;
        SwarmParams params{};
        Buffer instances;
    };
    void start(Commands& commands, WaterState& state);
    void take_steps(Commands& commands, WaterState& state);

    Device& device_;
    std::vector<WaterState> waters_;
    std::vector<ClothState> cloths_;
    std::vector<SwarmState> swarms_;
    std::vector<bool> placed_;  ///< by node
};

}  // namespace peelray
