// Directions drawn in proportion to an environment's light, so that few samples find what is bright.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace peelray {

struct Environment;

/// Probabilities of the cells of an equirectangular map, in two quadtrees side by side, one for each half of the map
/// (Clarberg et al., Wavelet Importance Sampling, 2005, warp samples through such trees). Samples that are spread
/// evenly stay so. Of depth n the map has 2^(n+1) × 2^n cells; inside of a cell all directions are alike.
struct EnvironmentDistribution {
    /// quads[0]: the halves' probabilities in x and y. Then level after level, the k-th (1 to `depth`) from
    /// `first(k)` on with two trees' worth of quads in Morton order: the probabilities of four cells, column + 2 · row.
    /// The children of cell j of quad q are quad 4q + j of the next level. Empty: there is none.
    std::vector<glm::vec4> quads;
    uint32_t depth = 0;

    EnvironmentDistribution() = default;
    /// By the mean of the three colours. A map without any light gets the same density everywhere. As many cells as
    /// the map has texels where its sides are powers of two; at most 2048 × 1024.
    explicit EnvironmentDistribution(const Environment& environment);

    /// x in the even bits, y in the odd ones.
    static uint32_t morton(uint32_t x, uint32_t y) {
        const auto spread = [](uint32_t v) {
            v = (v | v << 8) & 0x00ff00ffu;
            v = (v | v << 4) & 0x0f0f0f0fu;
            v = (v | v << 2) & 0x33333333u;
            return (v | v << 1) & 0x55555555u;
        };
        return spread(x) | spread(y) << 1;
    }
    static uint32_t first(uint32_t level) { return 1 + 2 * ((1u << 2 * (level - 1)) - 1) / 3; }
};

}  // namespace peelray
