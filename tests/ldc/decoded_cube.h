// A cube's tables, downloaded, checked for their form and taken apart.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>

#include "../gpu/sample_plane.h"
#include "cpu_raster.h"
#include "gpu/commands.h"

namespace peelray::test {

/// What the tables hold. Nodes, lists and the samples of a list lie in the order in which the GPU happened to make
/// them.
struct Tables {
    std::vector<glm::uvec2> top, samples;
    std::vector<uint32_t> node, voxel, ids;
    std::vector<glm::uvec4> patches;                 ///< instead of samples and ids
    bool operator==(const Tables&) const = default;  ///< byte for byte

    size_t sample_count() const { return patches.empty() ? ids.size() : patches.size(); }
};

/// All that builds of `size` in all left in the tables.
inline Tables download(Commands& commands, const Cubes& cubes, const TableSize& size) {
    Tables tables{commands.download<glm::uvec2>(cubes.top_table, size.cells),
                  {},
                  commands.download<uint32_t>(cubes.node_table, size.occupied * 64),
                  commands.download<uint32_t>(cubes.voxel_table, size.nodes * 64),
                  {},
                  {}};
    if (cubes.has_patches()) {
        tables.patches = commands.download<glm::uvec4>(cubes.patches, size.samples);
    } else {
        tables.samples = commands.download<glm::uvec2>(cubes.samples, size.samples);
        tables.ids = commands.download<uint32_t>(cubes.sample_ids, size.samples);
    }
    return tables;
}

/// Walks the tables of one body; every fault becomes a test failure.
class DecodedCube {
  public:
    struct Sample {
        glm::uvec3 voxel;
        uint32_t id;
        glm::uvec4 data;  ///< without the bit that ends its list, and without the id
        bool operator==(const Sample&) const = default;
    };
    std::vector<Sample> samples;  ///< those of a voxel by id
    std::vector<uint64_t> pairs;  ///< sorted
    uint32_t occupied = 0, nodes = 0, voxels = 0, longest = 0;

    DecodedCube(const LdcBody& body, const Tables& tables)
        : body_(body),
          tables_(tables),
          used_(tables.sample_count()),
          top_seen_(tables.node.size() / 64),
          tops_(body.grid.dims / 16u) {
        decode();
    }

    /// The body is all that there is in the tables.
    void expect_whole(const LdcCounters& counts) const {
        EXPECT_EQ(occupied, counts.occupied);
        EXPECT_EQ(nodes, counts.nodes);
        EXPECT_EQ(voxels, counts.voxels);
        EXPECT_EQ(longest, counts.longest);
        EXPECT_EQ(samples.size(), counts.fragments) << "every fragment is in one list";
    }

  private:
    void decode() {
        for (uint32_t i = 0; i < tops_.x * tops_.y * tops_.z; i++) {
            const glm::uvec3 cell(i % tops_.x, i / tops_.x % tops_.y, i / (tops_.x * tops_.y));
            ASSERT_LT(body_.first_cell + i, tables_.top.size());
            const glm::uvec2 entry = tables_.top[body_.first_cell + i];
            if (!(entry.x >> 31)) {
                check_top_box(cell, entry);
                continue;
            }
            ASSERT_LT(entry.y, top_seen_.size());
            ASSERT_FALSE(top_seen_[entry.y]) << "two cells of one number";
            top_seen_[entry.y] = true;
            occupied++;
            decode_nodes(cell * 16u, entry.y);
        }
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
                    ASSERT_FALSE(tables_.top[body_.first_cell + (z * tops_.y + y) * tops_.x + x].x >> 31)
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
        bool any = false;
        for (uint32_t k = 0; k < 64; k++) {
            const uint32_t entry = tables_.node[number * 64 + k];
            if (!(entry >> 31)) {
                check_box(tables_.node, number * 64, k);
                continue;
            }
            any = true;
            nodes++;
            ASSERT_LT(entry & 0x7fffffff, tables_.voxel.size() / 64);
            decode_voxels(corner + glm::uvec3(k % 4, k / 4 % 4, k / 16) * 4u, entry & 0x7fffffff);
        }
        ASSERT_TRUE(any) << "an occupied cell without a node";
    }
    void decode_voxels(const glm::uvec3& corner, uint32_t number) {
        bool any = false;
        for (uint32_t k = 0; k < 64; k++) {
            const uint32_t entry = tables_.voxel[size_t(number) * 64 + k];
            if (!(entry >> 31)) {
                check_box(tables_.voxel, size_t(number) * 64, k);
                continue;
            }
            any = true;
            voxels++;
            const glm::uvec3 cell = corner + glm::uvec3(k % 4, k / 4 % 4, k / 16);
            ASSERT_EQ(entry >> 30, 2u) << "a refined voxel in a cube that was not to be refined";
            decode_list(cell, entry & 0x3fffffff);
        }
        ASSERT_TRUE(any) << "an occupied node without a voxel";
    }
    void decode_list(const glm::uvec3& voxel, uint32_t first) {
        std::vector<Sample> list;
        for (uint32_t j = first;; j++) {
            ASSERT_LT(j, tables_.sample_count()) << "a list without a last sample";
            ASSERT_FALSE(used_[j]) << "two lists share a sample";
            used_[j] = true;
            if (!tables_.patches.empty()) {
                const glm::uvec4 data = tables_.patches[j];
                list.push_back({voxel, data.w, {data.x, data.y, data.z & ~1u, 0}});
                if (data.z & 1) break;
                continue;
            }
            const glm::uvec2 data = tables_.samples[j];
            list.push_back({voxel, tables_.ids[j], {data.x, data.y & 0x7fffffff, 0, 0}});
            if (data.y >> 31) break;
        }
        longest = std::max(longest, uint32_t(list.size()));
        std::sort(list.begin(), list.end(), [](const Sample& a, const Sample& b) { return a.id < b.id; });
        for (const Sample& sample : list) {
            ASSERT_TRUE(&sample == &list.front() || (&sample)[-1].id < sample.id) << "a sample stands there twice";
            samples.push_back(sample);
            pairs.push_back(pair_of(body_.grid, voxel, sample.id));
        }
    }

    const LdcBody body_;
    const Tables& tables_;
    std::vector<bool> used_, top_seen_;
    glm::uvec3 tops_;
};

}  // namespace peelray::test
