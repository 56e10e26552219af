// How a picture is cut into bands of rows.
#include "render/bands.h"

#include <gtest/gtest.h>

namespace peelray {
namespace {

TEST(Bands, OneBandWhereThePictureFits) {
    const Bands bands(100, 50, 1u << 20);
    EXPECT_EQ(bands.row_pixels(), 104u);
    EXPECT_EQ(bands.rows(), 56u);
    EXPECT_EQ(bands.pixels(0), 104u * 56u);
    EXPECT_EQ(bands.most_pixels(), 104u * 56u);
}

TEST(Bands, RowsAreWholeTilesWithinTheLimit) {
    const Bands bands(64, 100, 64 * 30);
    EXPECT_EQ(bands.rows(), 24u);
    EXPECT_EQ(bands.pixels(0), 64u * 24u);
    EXPECT_EQ(bands.pixels(96), 64u * 8u) << "the last band is lower";
    EXPECT_EQ(Bands(64, 100, 10).rows(), 8u) << "never less than a tile";
}

TEST(Bands, TogetherHoldEveryRowOnce) {
    for (const uint32_t height : {1u, 8u, 9u, 100u, 1024u})
        for (const uint64_t most : {1ull, 64 * 8ull, 64 * 40ull, 1ull << 22}) {
            const Bands bands(61, height, most);
            uint32_t rows = 0;
            for (uint32_t row = 0; row < height; row += bands.rows()) rows += bands.pixels(row) / bands.row_pixels();
            EXPECT_EQ(rows, (height + 7) / 8 * 8) << height << " rows, at most " << most << " pixels";
        }
}

TEST(Bands, HalveDownToOneTile) {
    Bands bands(64, 1000, 64 * 40);
    ASSERT_EQ(bands.rows(), 40u);
    EXPECT_TRUE(bands.halve());
    EXPECT_EQ(bands.rows(), 16u) << "whole tiles: not 20";
    EXPECT_TRUE(bands.halve());
    EXPECT_EQ(bands.rows(), 8u);
    EXPECT_FALSE(bands.halve());
    EXPECT_EQ(bands.rows(), 8u);
}

}  // namespace
}  // namespace peelray
