#include "scene/probabilities.h"

#include <algorithm>
#include <numeric>

namespace peelray {

std::vector<float> cumulative_shares(const std::vector<double>& weights) {
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    std::vector<float> shares;
    double so_far = 0;
    for (const double weight : weights) {
        so_far += weight;
        shares.push_back(sum > 0 ? std::min(1.0f, float(so_far / sum)) : 1.0f);
    }
    if (!shares.empty()) shares.back() = 1;
    return shares;
}

}  // namespace peelray
