// The by-pixel order, downloaded, checked for its form and taken apart.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <vector>

#include "gpu/commands.h"
#include "ldc/cubes.h"

namespace peelray::test {

/// What the tables hold, as bytes: equal inputs must give equal tables.
struct PixelTables {
    std::vector<uint32_t> offsets, ids;
    std::vector<glm::uvec2> samples;
    bool operator==(const PixelTables&) const = default;
};

/// All that builds of `size` in all left in the tables.
inline PixelTables download_pixels(Commands& commands, const Cubes& cubes, const TableSize& size) {
    return {commands.download<uint32_t>(cubes.pixel_offsets, size.cells),
            commands.download<uint32_t>(cubes.sample_ids, size.samples),
            commands.download<glm::uvec2>(cubes.samples, size.samples)};
}

/// Walks the pixels of one body; every fault becomes a test failure.
class DecodedPixels {
  public:
    struct Sample {
        uint32_t axis;
        glm::uvec2 pixel;
        uint32_t id;  ///< triangle · 4 + axis
        float w;
        glm::vec2 slope;
    };
    std::vector<Sample> samples;   ///< by axis, then row, then column, then as in the pixel's list
    std::vector<uint32_t> places;  ///< of the samples in the table
    uint32_t occupied = 0, longest = 0;

    DecodedPixels(const LdcBody& body, const PixelTables& tables) : body_(body), tables_(tables) {
        for (uint32_t axis = 0; axis < 3; axis++) {
            const glm::uvec2 size(body.grid.dims[(axis + 1) % 3], body.grid.dims[(axis + 2) % 3]);
            for (uint32_t v = 0; v < size.y; v++)
                for (uint32_t u = 0; u < size.x; u++) {
                    decode(axis, {u, v}, first_ + place({u, v}, size.x));
                    if (testing::Test::HasFatalFailure()) return;
                }
            first_ += size.x * size.y;
        }
    }

    /// The body is all that there is in the tables.
    void expect_whole(const LdcCounters& counts) const {
        EXPECT_EQ(occupied, counts.voxels);
        EXPECT_EQ(longest, counts.longest);
        EXPECT_EQ(samples.size(), counts.fragments) << "every fragment is in one list";
        EXPECT_EQ(tables_.offsets.front(), 0u);
        EXPECT_EQ(tables_.offsets.back(), counts.fragments);
    }

  private:
    /// Rows of tiles of 8×8 pixels, and rows inside a tile.
    static uint32_t place(const glm::uvec2& p, uint32_t width) {
        return ((p.y / 8) * (width / 8) + p.x / 8) * 64 + p.y % 8 * 8 + p.x % 8;
    }
    void decode(uint32_t axis, const glm::uvec2& pixel, uint32_t at) {
        ASSERT_LT(body_.first_cell + at + 1, tables_.offsets.size());
        const uint32_t from = tables_.offsets[body_.first_cell + at], to = tables_.offsets[body_.first_cell + at + 1];
        ASSERT_LE(from, to);
        ASSERT_LE(to, tables_.ids.size());
        occupied += from < to;
        longest = std::max(longest, to - from);
        for (uint32_t j = from; j < to; j++) {
            const glm::uvec2 data = tables_.samples[j];
            const auto slope = [&](uint32_t bits) { return float(int16_t(bits)) * 1.25f / 32767; };
            const Sample s{
                axis, pixel, tables_.ids[j], std::bit_cast<float>(data.x), {slope(data.y), slope(data.y >> 16)}};
            ASSERT_EQ(s.id & 3, axis);
            ASSERT_GE(s.id >> 2, body_.first_triangle);
            ASSERT_LT(s.id >> 2, body_.first_triangle + body_.triangles);
            if (j > from) {
                const Sample& before = samples.back();
                ASSERT_TRUE(before.w < s.w || (before.w == s.w && before.id < s.id)) << "not sorted by depth, then id";
            }
            samples.push_back(s);
            places.push_back(j);
        }
    }

    const LdcBody body_;
    const PixelTables& tables_;
    uint32_t first_ = 0;  ///< pixel of the LDI, counted from the body's first
};

}  // namespace peelray::test
