#include "reference/emitter_list.h"

#include <algorithm>

namespace peelray::inline PRECISION {

EmitterList::EmitterList(std::span<const Emitter> emitters, size_t triangles)
    : emitters_(emitters.begin(), emitters.end()), probabilities_(emitters.empty() ? 0 : triangles) {
    for (const Emitter& emitter : emitters_) probabilities_[emitter.id] = emitter.probability;
}

const Emitter& EmitterList::choose(real random) const {
    const auto found =
        std::ranges::upper_bound(emitters_, random, {}, [](const Emitter& e) { return real(e.cumulative); });
    return found == emitters_.end() ? emitters_.back() : *found;
}

}  // namespace peelray::inline PRECISION
