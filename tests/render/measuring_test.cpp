// Medians over repeated frames, of times that are made up.
#include "render/measuring.h"

#include <gtest/gtest.h>

namespace peelray {
namespace {

FrameMeter frame(double ms, const std::vector<PassTime>& passes, uint32_t redone = 0) {
    FrameMeter meter;
    meter.passes.add(passes);
    meter.ms = ms;
    meter.redone = redone;
    return meter;
}

TEST(Median, IsTheMiddleOrTheUpperOfTwo) {
    EXPECT_EQ(median({}), 0);
    EXPECT_EQ(median({3}), 3);
    EXPECT_EQ(median({9, 1, 5}), 5);
    EXPECT_EQ(median({4, 1, 3, 2}), 3);
}

TEST(TimeTable, AddsUpByNameInOrderOfAppearance) {
    TimeTable table;
    table.add({{"scatter", 1}, {"trace", 2}});
    table.add({{"trace", 3}, {"gather", 4}, {"scatter", 0.5}});
    ASSERT_EQ(table.rows().size(), 3u);
    EXPECT_EQ(table.rows()[0].name, "scatter");
    EXPECT_EQ(table.rows()[0].ms, 1.5);
    EXPECT_EQ(table.rows()[1].ms, 5);
    EXPECT_EQ(table.rows()[2].name, "gather");
}

TEST(Measurement, OneFrameIsItsOwnMedian) {
    for (const uint32_t repeat : {0u, 1u}) {
        Measurement measurement(repeat);
        ASSERT_EQ(measurement.frames(), 1u);
        measurement.add(
            frame(7, {{"build/ldc_fill", 2}, {"build/ldc_sort", 1}, {"probe/primary", 3}, {"trace", 1}}, 2));
        RenderStats stats;
        measurement.describe(stats);
        EXPECT_EQ(stats.frame_ms, 7);
        EXPECT_EQ(stats.build_ms, 3);
        EXPECT_EQ(stats.maps_ms, 3);
        EXPECT_EQ(stats.redone, 2u);
        ASSERT_EQ(stats.frames.size(), 1u);
        EXPECT_EQ(stats.frames[0].build_ms, 3);
        ASSERT_EQ(stats.passes.size(), 4u);
    }
}

TEST(Measurement, TheFirstOfSeveralFramesOnlyWarmsUp) {
    Measurement measurement(4);
    // What is built once is built in the first frame and timed in no other.
    measurement.add(frame(100, {{"build/once", 50}, {"trace", 40}}, 3));
    measurement.add(frame(9, {{"trace", 3}}));
    measurement.add(frame(7, {{"trace", 8}}, 1));
    measurement.add(frame(8, {{"trace", 5}}));
    RenderStats stats;
    measurement.describe(stats);
    EXPECT_EQ(stats.frame_ms, 8);
    EXPECT_EQ(stats.redone, 4u) << "of all frames";
    ASSERT_EQ(stats.frames.size(), 3u);
    EXPECT_EQ(stats.frames[0].frame_ms, 9);
    ASSERT_EQ(stats.passes.size(), 1u);
    EXPECT_EQ(stats.passes[0].name, "trace");
    EXPECT_EQ(stats.passes[0].ms, 5);
    EXPECT_EQ(stats.build_ms, 0);
}

}  // namespace
}  // namespace peelray
