// The random numbers of a picture: Sobol's points, scrambled as Owen has it, so that a pixel's samples and those of its
// neighbours spread evenly together (Ahmed and Wonka, Screen-Space Blue-Noise Diffusion of Monte Carlo Sampling Error
// via Hierarchical Ordering of Pixels, 2020). Bit for bit the GPU's. Private to src/reference.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include "reference/real.h"

namespace peelray::inline PRECISION {

/// pcg3d (Jarzynski, Olano, JCGT 2020).
glm::uvec3 hash3(glm::uvec3 v);

/// The seed of a pixel's paths: its place in Morton order, above the bits that tell the branches taken.
uint32_t path_seed(uint32_t x, uint32_t y);
/// That of a path's branch; `which`: of those of its hit, `level`: the path's.
uint32_t branch_seed(uint32_t seed, uint32_t which, uint32_t level);

/// One of the samples that each pixel of a picture has.
struct PixelSample {
    uint32_t number = 0;
    uint32_t bits = 0;     ///< that tell the samples of a pixel apart
    uint32_t picture = 0;  ///< seed of the picture
    static uint32_t bits_for(uint32_t spp);
};

/// What a path of this seed and level draws for a purpose (RANDOM_*), [0, 1)².
Vec2 random_pair(uint32_t seed, uint32_t level, uint32_t purpose, const PixelSample& sample);

}  // namespace peelray::inline PRECISION
