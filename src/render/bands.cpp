#include "render/bands.h"

#include <algorithm>

namespace peelray {
namespace {

constexpr uint32_t kTile = 8;

uint32_t in_tiles(uint32_t pixels) {
    return (pixels + kTile - 1) / kTile * kTile;
}

}  // namespace

Bands::Bands(uint32_t width, uint32_t height, uint64_t most) : height_(height), row_pixels_(in_tiles(width)) {
    rows_ = uint32_t(std::clamp<uint64_t>(most / row_pixels_ / kTile * kTile, kTile, in_tiles(height)));
}

uint32_t Bands::pixels(uint32_t first_row) const {
    return row_pixels_ * std::min(rows_, in_tiles(height_ - first_row));
}

bool Bands::halve() {
    if (rows_ == kTile) return false;
    rows_ = std::max(kTile, rows_ / (2 * kTile) * kTile);
    return true;
}

}  // namespace peelray
