// A cube's tables, downloaded, checked for their form and taken apart.
#pragma once

#include <gtest/gtest.h>

#include "cpu_raster.h"
#include "gpu/commands.h"

namespace peelray::test {

/// What the tables hold, as bytes: equal inputs must give equal tables.
struct Tables {
    std::vector<glm::uvec2> top, samples;
    std::vector<uint32_t> node, voxel, ids;
    bool operator==(const Tables&) const = default;
};

inline Tables download(Commands& commands, const Cube& cube) {
    const glm::uvec3 tops = cube.grid.dims / 16u;
    return {commands.download<glm::uvec2>(cube.top_table, uint64_t(tops.x) * tops.y * tops.z),
            commands.download<glm::uvec2>(cube.samples, cube.counts.fragments),
            commands.download<uint32_t>(cube.node_table, uint64_t(cube.counts.tops) * 64),
            commands.download<uint32_t>(cube.voxel_table, uint64_t(cube.counts.nodes) * 64),
            commands.download<uint32_t>(cube.sample_ids, cube.counts.fragments)};
}

/// Walks all tables; every fault becomes a test failure.
class DecodedCube {
  public:
    struct Sample {
        glm::uvec3 voxel;
        uint32_t id;
        glm::uvec2 data;
    };
    std::vector<Sample> samples;
    std::vector<uint64_t> pairs;  ///< sorted

    DecodedCube(const Cube& cube, const Tables& tables)
        : cube_(cube), tables_(tables), used_(tables.ids.size()), tops_(cube.grid.dims / 16u) {
        decode();
    }

  private:
    void decode() {
        std::vector<bool> top_seen(cube_.counts.tops);
        for (uint32_t i = 0; i < tables_.top.size(); i++) {
            const glm::uvec3 cell(i % tops_.x, i / tops_.x % tops_.y, i / (tops_.x * tops_.y));
            const glm::uvec2 entry = tables_.top[i];
            if (!(entry.x >> 31)) {
                check_top_box(cell, entry);
                continue;
            }
            ASSERT_LT(entry.y, top_seen.size());
            ASSERT_FALSE(top_seen[entry.y]) << "two cells of one number";
            top_seen[entry.y] = true;
            decode_nodes(cell * 16u, entry.y);
        }
        EXPECT_EQ(std::count(top_seen.begin(), top_seen.end(), true), ptrdiff_t(cube_.counts.tops));
        EXPECT_EQ(nodes_, cube_.counts.nodes);
        EXPECT_EQ(voxels_, cube_.counts.voxels);
        EXPECT_EQ(longest_, cube_.counts.longest);
        EXPECT_EQ(samples.size(), cube_.counts.fragments) << "every fragment is in one list";
        std::sort(pairs.begin(), pairs.end());
        EXPECT_EQ(std::adjacent_find(pairs.begin(), pairs.end()), pairs.end());
    }
    void check_top_box(const glm::uvec3& cell, const glm::uvec2& e) {
        const glm::uvec3 lo(e.x & 1023, e.x >> 10 & 1023, e.x >> 20 & 1023),
            hi(e.y & 1023, e.y >> 10 & 1023, e.y >> 20 & 1023);
        ASSERT_TRUE(glm::all(glm::lessThanEqual(lo, cell)) && glm::all(glm::lessThanEqual(cell, hi)) &&
                    glm::all(glm::lessThan(hi, tops_)));
        for (uint32_t z = lo.z; z <= hi.z; z++)
            for (uint32_t y = lo.y; y <= hi.y; y++)
                for (uint32_t x = lo.x; x <= hi.x; x++)
                    ASSERT_FALSE(tables_.top[(z * tops_.y + y) * tops_.x + x].x >> 31)
                        << "an occupied cell in an empty cell's box";
    }
    /// An empty entry's box among the 64 entries from `first` of `table`.
    void check_box(const std::vector<uint32_t>& table, size_t first, uint32_t k) {
        const uint32_t box = table[first + k];
        ASSERT_LT(box, 1u << 12);
        const glm::uvec3 cell(k % 4, k / 4 % 4, k / 16), lo(box & 3, box >> 2 & 3, box >> 4 & 3),
            hi(box >> 6 & 3, box >> 8 & 3, box >> 10 & 3);
        ASSERT_TRUE(glm::all(glm::lessThanEqual(lo, cell)) && glm::all(glm::lessThanEqual(cell, hi)));
        for (uint32_t z = lo.z; z <= hi.z; z++)
            for (uint32_t y = lo.y; y <= hi.y; y++)
                for (uint32_t x = lo.x; x <= hi.x; x++)
                    ASSERT_FALSE(table[first + z * 16 + y * 4 + x] >> 31) << "an occupied cell in an empty one's box";
    }
    void decode_nodes(const glm::uvec3& corner, uint32_t number) {
        bool occupied = false;
        for (uint32_t k = 0; k < 64; k++) {
            const uint32_t entry = tables_.node[number * 64 + k];
            if (!(entry >> 31)) {
                check_box(tables_.node, number * 64, k);
                continue;
            }
            occupied = true;
            nodes_++;
            ASSERT_LT(entry & 0x7fffffff, cube_.counts.nodes);
            decode_voxels(corner + glm::uvec3(k % 4, k / 4 % 4, k / 16) * 4u, entry & 0x7fffffff);
        }
        ASSERT_TRUE(occupied) << "an occupied cell without a node";
    }
    void decode_voxels(const glm::uvec3& corner, uint32_t number) {
        bool occupied = false;
        for (uint32_t k = 0; k < 64; k++) {
            const uint32_t entry = tables_.voxel[size_t(number) * 64 + k];
            if (!(entry >> 31)) {
                check_box(tables_.voxel, size_t(number) * 64, k);
                continue;
            }
            occupied = true;
            voxels_++;
            decode_list(corner + glm::uvec3(k % 4, k / 4 % 4, k / 16), entry & 0x7fffffff);
        }
        ASSERT_TRUE(occupied) << "an occupied node without a voxel";
    }
    void decode_list(const glm::uvec3& voxel, uint32_t first) {
        for (uint32_t j = first;; j++) {
            ASSERT_LT(j, tables_.ids.size()) << "a list without a last sample";
            ASSERT_FALSE(used_[j]) << "two lists share a sample";
            used_[j] = true;
            const uint32_t id = tables_.ids[j];
            ASSERT_TRUE(j == first || tables_.ids[j - 1] < id) << "not sorted by id";
            samples.push_back({voxel, id, tables_.samples[j]});
            pairs.push_back(pair_of(cube_.grid, voxel, id));
            if (tables_.samples[j].y >> 30 & 1) {
                longest_ = std::max(longest_, j - first + 1);
                return;
            }
        }
    }

    const Cube& cube_;
    const Tables& tables_;
    std::vector<bool> used_;
    glm::uvec3 tops_;
    uint32_t nodes_ = 0, voxels_ = 0, longest_ = 0;
};

}  // namespace peelray::test
