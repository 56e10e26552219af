#include "bench/timing.h"

#include <gtest/gtest.h>

#include "cli/bench_output.h"

namespace peelray {
namespace {

TEST(Timing, MedianEndsAndDrift) {
    const Timing timing = timing_of({4, 1, 9, 2, 6});
    EXPECT_EQ(timing.runs, 5u);
    EXPECT_EQ(timing.median, 4);
    EXPECT_EQ(timing.least, 1);
    EXPECT_EQ(timing.most, 9);
    EXPECT_EQ(timing.drift, 1.5);
    EXPECT_EQ(timing_json(timing)["median"], 4);
    EXPECT_EQ(timing_of({}).runs, 0u);
    EXPECT_TRUE(timing_json(timing_of({})).is_null());
}

TEST(Timing, WhatWarmsUpDoesNotCount) {
    int calls = 0;
    const Timing timing = time_repeatedly(3, [&] { return ++calls <= 2 ? 1000.0 : 10.0 + calls % 2; });
    EXPECT_EQ(timing.runs, 3u);
    EXPECT_GE(calls, 5);
    EXPECT_LE(timing.most, 11);
}

}  // namespace
}  // namespace peelray
