#include "reference/emitter_list.h"

#include <algorithm>

namespace peelray::inline PRECISION {

EmitterList::EmitterList(std::span<const Emitter> emitters, size_t triangles)
    : emitters_(emitters.begin(), emitters.end()), probabilities_(emitters.empty() ? 0 : triangles) {
    for (const Emitter& emitter : emitters_) {
        probabilities_[emitter.id] = emitter.probability;
        cumulative_.push_back(emitter.cumulative);
    }
    for (size_t i = 0; i < buckets; i++)
        first_.push_back(uint32_t(std::ranges::upper_bound(cumulative_, float(i) / buckets) - cumulative_.begin()));
}

const Emitter& EmitterList::choose(real random) const {
    size_t i = first_[std::min(size_t(random * buckets), buckets - 1)];
    while (i + 1 < emitters_.size() && real(cumulative_[i]) <= random) i++;
    return emitters_[std::min(i, emitters_.size() - 1)];
}

}  // namespace peelray::inline PRECISION
