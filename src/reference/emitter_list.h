// The emissive triangles of a scene, for drawing one and for looking one up. Private to src/reference.
#pragma once

#include <span>
#include <vector>

#include "reference/real.h"
#include "scene/emitters.h"

namespace peelray::inline PRECISION {

class EmitterList {
  public:
    /// `triangles`: as many as the scene has.
    EmitterList(std::span<const Emitter> emitters, size_t triangles);

    bool empty() const { return emitters_.empty(); }
    /// Each as often as its probability says; `random` in [0, 1). Of none there is nothing to choose.
    const Emitter& choose(real random) const;
    /// Of a triangle being chosen; 0: it is none of them.
    real probability(uint32_t triangle) const { return empty() ? 0 : real(probabilities_[triangle]); }

  private:
    static constexpr size_t buckets = 1024;

    Emitters emitters_;
    std::vector<float> cumulative_;
    std::vector<uint32_t> first_;       ///< of each bucket of random numbers: whom its least one chooses
    std::vector<float> probabilities_;  ///< by triangle; empty where nothing emits
};

}  // namespace peelray::inline PRECISION
