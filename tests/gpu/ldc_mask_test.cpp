// Keys and masks of the cube's tables against plain loops.
#include <bit>

#include "probe_fixture.h"

namespace peelray {
namespace {

using glm::ivec3;
using glm::uvec2;
using glm::uvec3;

struct Input {
    uvec3 voxel, dims;
    uint32_t axis;
    uvec2 mask;
    uint32_t bit;
};
struct Output {
    uvec3 to, back;
    uint32_t top, node, inner;
    uvec3 top_cell, node_cell, inner_cell;
    uint32_t set, count, rank, box;
};

class LdcMaskProbe : public ProbeTest {
  protected:
    std::vector<Input> inputs() {
        std::vector<Input> list;
        for (int i = 0; i < 40000; i++) {
            Input x{};
            for (int k = 0; k < 3; k++) {
                x.dims[k] = 16 * (1 + bits() % 128);
                x.voxel[k] = i % 5 == 0 ? x.dims[k] - 1 : bits() % x.dims[k];
            }
            x.axis = uint32_t(i % 3);
            // From empty to full; sparse ones leave room for boxes.
            uint64_t mask = 0;
            const uint32_t set = i % 8 == 7 ? 64 : bits() % (i % 2 ? 8 : 66);
            for (uint32_t k = 0; k < set; k++) mask |= 1ull << bits() % 64;
            if (i % 8 == 7) mask = ~0ull;
            x.mask = {uint32_t(mask), uint32_t(mask >> 32)};
            x.bit = i % 7 == 0 ? (i % 2 ? 0 : 63) : i % 7 == 1 ? 31 + i % 2 : bits() % 64;
            list.push_back(x);
        }
        return list;
    }
};

uint64_t word(const uvec2& mask) {
    return uint64_t(mask.y) << 32 | mask.x;
}
ivec3 cell_of(uint32_t index) {
    return {index % 4, index / 4 % 4, index / 16};
}

/// Are all cells of the box free?
bool box_free(uint64_t mask, ivec3 lo, ivec3 hi) {
    for (int z = lo.z; z <= hi.z; z++)
        for (int y = lo.y; y <= hi.y; y++)
            for (int x = lo.x; x <= hi.x; x++)
                if (mask >> (z * 16 + y * 4 + x) & 1) return false;
    return true;
}

TEST_F(LdcMaskProbe, PermutationsAndKeysGoBackToWhereTheyCameFrom) {
    const auto in = inputs();
    const auto out = probe<Output>("probe_ldc_keys", in);
    for (size_t i = 0; i < in.size(); i++) {
        const uvec3 v = in[i].voxel, tops = in[i].dims / 16u;
        const uvec3 seen = in[i].axis == 0 ? uvec3(v.y, v.z, v.x) : in[i].axis == 1 ? uvec3(v.z, v.x, v.y) : v;
        ASSERT_EQ(out[i].to, seen);
        ASSERT_EQ(out[i].back, v);
        ASSERT_EQ(out[i].top, v.x / 16 + tops.x * (v.y / 16 + tops.y * (v.z / 16)));
        ASSERT_EQ(out[i].top_cell, v / 16u);
        ASSERT_EQ(out[i].node, v.x / 4 % 4 + 4 * (v.y / 4 % 4) + 16 * (v.z / 4 % 4));
        ASSERT_EQ(out[i].inner, v.x % 4 + 4 * (v.y % 4) + 16 * (v.z % 4));
        ASSERT_EQ(out[i].top_cell * 16u + out[i].node_cell * 4u + out[i].inner_cell, v);
    }
}

TEST_F(LdcMaskProbe, BitsAreCountedAndRanked) {
    const auto in = inputs();
    const auto out = probe<Output>("probe_ldc_keys", in);
    for (size_t i = 0; i < in.size(); i++) {
        const uint64_t mask = word(in[i].mask);
        ASSERT_EQ(out[i].set, mask >> in[i].bit & 1);
        ASSERT_EQ(out[i].count, uint32_t(std::popcount(mask)));
        ASSERT_EQ(out[i].rank, uint32_t(std::popcount(mask & ((1ull << in[i].bit) - 1)))) << in[i].bit;
    }
}

TEST_F(LdcMaskProbe, BoxesAreEmptyHoldTheirCellAndCannotGrow) {
    const auto in = inputs();
    const auto out = probe<Output>("probe_ldc_keys", in);
    int boxes = 0, grown = 0;
    for (size_t i = 0; i < in.size(); i++) {
        const uint64_t mask = word(in[i].mask);
        if (mask >> in[i].bit & 1) continue;
        boxes++;
        const uint32_t box = out[i].box;
        ASSERT_LT(box, 1u << 12);
        const ivec3 lo(box & 3, box >> 2 & 3, box >> 4 & 3), hi(box >> 6 & 3, box >> 8 & 3, box >> 10 & 3),
            cell = cell_of(in[i].bit);
        ASSERT_TRUE(glm::all(glm::lessThanEqual(lo, cell)) && glm::all(glm::lessThanEqual(cell, hi)));
        ASSERT_TRUE(box_free(mask, lo, hi));
        grown += lo != hi;
        for (int axis = 0; axis < 3; axis++) {
            ivec3 below = lo, above = hi;
            if (lo[axis] > 0) {
                below[axis]--;
                ASSERT_FALSE(box_free(mask, below, hi)) << "could grow down along " << axis;
            }
            if (hi[axis] < 3) {
                above[axis]++;
                ASSERT_FALSE(box_free(mask, lo, above)) << "could grow up along " << axis;
            }
        }
    }
    EXPECT_GT(boxes, 15000);
    EXPECT_GT(grown, 8000);
}

}  // namespace
}  // namespace peelray
