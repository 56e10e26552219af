// Which pictures a renderer has kept for those that come after them (Denoise::temporal).
#pragma once

#include <array>
#include <optional>

#include "denoise/denoise_params.h"
#include "render/render_settings.h"
#include "workspace/shot.h"

namespace peelray {

/// Pictures of one scene, each of a shot that Shot::at() has completed. What a kept picture shows is told by that and
/// by its settings, before these were completed for the shot.
class KeptPictures {
  public:
    /// Is the very picture kept?
    bool has(const RenderSettings& settings, const Shot& shot) const;
    /// It is going to be made: what was kept in its place is lost.
    void begin(const Shot& shot) { kept_[place_of(shot)].reset(); }
    /// It has been made.
    void add(const RenderSettings& settings, const Shot& shot);
    void clear() { kept_ = {}; }

  private:
    struct Kept {
        RenderSettings settings;
        Shot shot;
        bool operator==(const Kept&) const = default;
    };
    static Kept described(const RenderSettings& settings, const Shot& shot);
    static size_t place_of(const Shot& shot);

    std::array<std::optional<Kept>, DENOISE_WARM_UP + 1> kept_;
};

/// What the CPU tracer keeps of pictures for later ones.
struct CpuPast {
    virtual ~CpuPast() = default;
};

/// The seed of a picture's random numbers: any DENOISE_WARM_UP + 1 in a row have others.
inline uint32_t seed_of(uint32_t seed, int64_t number) {
    const int64_t count = DENOISE_SEEDS;
    return seed + DENOISE_SEED_STEP * uint32_t((number % count + count) % count);
}

}  // namespace peelray
