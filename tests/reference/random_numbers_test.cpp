// The reference's random numbers: spread evenly within pixels and across them, and else independent.
#include "reference/random_numbers.h"

#include <gtest/gtest.h>

#include <set>

#include "path/shading_numbers.h"
#include "statistics/lobes.h"

namespace peelray {
namespace {

using test::fit_uniform, test::sidak;

/// Does each of the 2^bits elementary intervals of each shape hold just one of as many points?
bool is_net(const std::vector<glm::dvec2>& points, uint32_t bits) {
    for (uint32_t across = 0; across <= bits; across++) {
        std::set<std::pair<uint32_t, uint32_t>> taken;
        for (const glm::dvec2& p : points)
            taken.emplace(uint32_t(p.x * (1u << across)), uint32_t(p.y * (1u << (bits - across))));
        if (taken.size() != points.size()) return false;
    }
    return points.size() == 1u << bits;
}

TEST(RandomNumbers, SamplesOfAPixelAreANet) {
    for (const uint32_t bits : {0u, 1u, 4u, 6u})
        for (const uint32_t seed : {path_seed(0, 0), path_seed(13, 7), branch_seed(path_seed(4000, 1), 1, 0)})
            for (const uint32_t purpose : {RANDOM_MICROFACET, RANDOM_ENVIRONMENT, RANDOM_LAMP + 3}) {
                std::vector<glm::dvec2> points;
                for (uint32_t i = 0; i < 1u << bits; i++) points.push_back(random_pair(seed, 2, purpose, {i, bits, 5}));
                EXPECT_TRUE(is_net(points, bits)) << bits << " bits, seed " << seed << ", purpose " << purpose;
            }
}

TEST(RandomNumbers, NeighboursTogetherAreANet) {
    // Blocks of pixels in Morton order, wherever they are; of several samples each, or of one.
    for (const uint32_t left : {0u, 4u, 1020u})
        for (const uint32_t sample_bits : {0u, 2u}) {
            std::vector<glm::dvec2> points;
            for (uint32_t y = 8; y < 12; y++)
                for (uint32_t x = left; x < left + 4; x++)
                    for (uint32_t i = 0; i < 1u << sample_bits; i++)
                        points.push_back(random_pair(path_seed(x, y), 0, RANDOM_SKY, {i, sample_bits, 0}));
            EXPECT_TRUE(is_net(points, 4 + sample_bits)) << left << ", " << sample_bits;
        }
}

TEST(RandomNumbers, BitsTellTheSamplesApart) {
    for (const auto& [spp, bits] : {std::pair(1u, 0u), {2u, 1u}, {3u, 2u}, {4u, 2u}, {5u, 3u}, {64u, 6u}, {65u, 7u}})
        EXPECT_EQ(PixelSample::bits_for(spp), bits) << spp;
}

TEST(RandomNumbers, BranchesKeepThePixel) {
    const uint32_t pixel = path_seed(0xabc, 0x123);
    std::set<uint32_t> branches;
    for (const uint32_t which : {0u, 1u, 2u})
        for (const uint32_t level : {0u, 1u, 2u}) {
            branches.insert(branch_seed(pixel, which, level));
            EXPECT_EQ(branch_seed(pixel, which, level) >> RANDOM_BRANCH_BITS, pixel >> RANDOM_BRANCH_BITS);
        }
    EXPECT_EQ(branches.size(), 9u);
    EXPECT_EQ(path_seed(3, 0) >> RANDOM_BRANCH_BITS, 5u);
    EXPECT_EQ(path_seed(0, 3) >> RANDOM_BRANCH_BITS, 10u);
    EXPECT_EQ(path_seed(0x1001, 0), path_seed(1, 0));
}

/// Of one pixel in many pictures; together with those of another purpose, of the path's first branch, of the next
/// level, of the next picture and of a neighbour. (Within one picture what is more even than chance is less
/// independent, also with a perfect scramble.)
TEST(RandomNumbers, PurposesBranchesLevelsAndPicturesAreIndependent) {
    const uint32_t seed = path_seed(37, 190), neighbour = path_seed(37, 194);
    std::vector<glm::vec2> pairs, purposes, branches, levels, pictures, pixels;
    for (uint32_t picture = 0; picture < 100000; picture++) {
        const PixelSample first{3, 4, picture}, other{3, 4, picture + 1};
        const glm::dvec2 pair = random_pair(seed, 0, RANDOM_MICROFACET, first);
        pairs.push_back(pair);
        purposes.emplace_back(pair.x, random_pair(seed, 0, RANDOM_ENVIRONMENT, first).x);
        branches.emplace_back(pair.x, random_pair(branch_seed(seed, 0, 0), 1, RANDOM_MICROFACET, first).x);
        levels.emplace_back(pair.y, random_pair(seed, 1, RANDOM_MICROFACET, first).y);
        pictures.emplace_back(pair.x, random_pair(seed, 0, RANDOM_MICROFACET, other).x);
        pixels.emplace_back(pair.x, random_pair(neighbour, 0, RANDOM_MICROFACET, first).y);
    }
    for (const auto* both : {&pairs, &purposes, &branches, &levels, &pictures, &pixels})
        EXPECT_GT(fit_uniform(*both).p, sidak(0.01, 6)) << fit_uniform(*both);
}

/// Of all pixels of a picture.
TEST(RandomNumbers, PicturesAreMoreEvenThanChance) {
    std::vector<glm::vec2> pairs;
    for (uint32_t y = 0; y < 320; y++)
        for (uint32_t x = 0; x < 320; x++) pairs.push_back(random_pair(path_seed(x, y), 0, RANDOM_SKY, {}));
    EXPECT_GT(fit_uniform(pairs).p, 0.999);
}

}  // namespace
}  // namespace peelray
