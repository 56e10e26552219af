// A sheet of cloth on a ball: its control points move as particles with distance constraints, by many small steps
// (Macklin, Storey, Lu, Terdiman, Chentanez, Jeschke, Müller, "Small Steps in Physics Simulation", 2019), that neither
// enter the ball nor come nearer to each other than the sheet is thick.
#pragma once

#include "scene/generated.h"

namespace peelray {

class ClothSimulation {
  public:
    /// At time 0, as Cloth::start has it; where that is empty, spread out flat just above the ball.
    explicit ClothSimulation(const Cloth& cloth);

    /// Whole steps from time 0; starts again where that is earlier than now.
    void advance(uint64_t steps);
    /// Lets it fall onto a ball that stands, without wind, until it hangs; then that is time 0.
    void settle();

    /// The net at a moment, seconds from 0: the same to the last bit, whichever moments were asked for before.
    std::vector<glm::dvec3> net_at(double time);

    static constexpr uint32_t steps_per_second = 480;

  private:
    struct Link {
        uint32_t a, b;
        double length, compliance;
    };
    void link();
    void take_step(double time, double damping);
    void add_wind(double time, double dt);
    void find_contacts();
    void keep_apart();
    void keep_outside(double turn);

    Cloth cloth_;
    uint64_t step_ = 0;
    double wind_ = 1;  ///< 0: none, and the ball stands
    std::vector<glm::dvec3> positions_, before_, velocities_;
    std::vector<Link> links_;
    std::vector<std::pair<uint32_t, uint32_t>> contacts_;  ///< points that may touch in the next steps
};

/// A point of the sheet and its normal; u, v in [0, 1].
struct ClothPoint {
    glm::dvec3 position, normal;
};
ClothPoint cloth_point(const Cloth& cloth, const std::vector<glm::dvec3>& net, double u, double v);

}  // namespace peelray
