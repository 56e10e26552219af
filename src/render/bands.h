// A picture in bands of rows, so that the queues of rays below a band stay within what the device binds.
#pragma once

#include <cstdint>

namespace peelray {

class Bands {
  public:
    Bands() = default;
    /// Pictures of width x height pixels, at most `most` of them in a band, but at least eight rows.
    Bands(uint32_t width, uint32_t height, uint64_t most);

    uint32_t rows() const { return rows_; }              ///< of a band, a multiple of 8
    uint32_t row_pixels() const { return row_pixels_; }  ///< the width rounded up to tiles of 8
    uint32_t most_pixels() const { return row_pixels_ * rows_; }
    /// Pixels of the band that starts at a row, in whole tiles; the last band may be lower.
    uint32_t pixels(uint32_t first_row) const;
    /// Bands have half as many rows from now on, at least 8; false: they had no more than that.
    bool halve();

  private:
    uint32_t height_ = 0, row_pixels_ = 0, rows_ = 8;
};

}  // namespace peelray
