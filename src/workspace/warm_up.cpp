#include "workspace/warm_up.h"

namespace peelray {

/// Without what shapes nothing that is kept.
KeptPictures::Kept KeptPictures::described(const RenderSettings& settings, const Shot& shot) {
    Kept kept{settings, shot};
    RenderSettings& s = kept.settings;
    s.aovs = s.ray_setup = s.motion = s.moments = s.counters = false;
    s.time_passes = s.bodies = true;
    s.repeat = 1;
    s.exposure = 0;
    s.tonemap = Tonemap::none;
    return kept;
}

size_t KeptPictures::place_of(const Shot& shot) {
    const int64_t count = DENOISE_WARM_UP + 1;
    return size_t((*shot.number % count + count) % count);
}

bool KeptPictures::has(const RenderSettings& settings, const Shot& shot) const {
    const std::optional<Kept>& kept = kept_[place_of(shot)];
    return kept && *kept == described(settings, shot);
}

void KeptPictures::add(const RenderSettings& settings, const Shot& shot) {
    kept_[place_of(shot)] = described(settings, shot);
}

}  // namespace peelray
