// What the table and the JSON say of a row; above all, that wrong answers cost their time.
#include "cli/bench_rays.h"

#include <gtest/gtest.h>

namespace peelray {
namespace {

TracedSet traced(RayKind kind, double ms) {
    TracedSet set{kind, 3'000'000, timing_of({ms}), {}, {}, {}};
    set.judged.checked = set.judged.counted = 20'000;
    set.judged.beside = 1;
    return set;
}

RayRow row_of(const std::string& contender, double build_ms, double mirror_ms, double shadow_ms) {
    RayRow row;
    row.scene = "blob:8000";
    row.triangles = 8002;
    row.size = {1280, 1024};
    row.contender = contender;
    row.hit = value_named<HitTest>(contender);
    row.build = timing_of({build_ms});
    row.sets = {traced(RayKind::mirror, mirror_ms), traced(RayKind::shadow, shadow_ms)};
    return row;
}

const std::vector<RayKind> kinds = {RayKind::mirror, RayKind::shadow};

TEST(Rows, RatesAndWhatAMovingSceneCosts) {
    const RayRow row = row_of("exact", 2, 1.5, 0.5);
    const auto json = ray_row_json(row);
    EXPECT_EQ(json["contender"], "ldc");
    EXPECT_EQ(json["hit"], "exact");
    EXPECT_EQ(json["ldc"], "auto");
    EXPECT_EQ(json["dynamic_ms"], 4);
    EXPECT_EQ(json["rays"]["mirror"]["mrays_per_second"], 2000);
    EXPECT_EQ(json["rays"]["mirror"]["trace_ms"]["median"], 1.5);
    EXPECT_NE(ray_table_row(row, kinds).find("| 1.500 (2000.0) | 0.500 (6000.0) | 4.000 |"), std::string::npos);
}

TEST(Rows, TheTimeOfWrongAnswersIsWithheld) {
    RayRow row = row_of("exact", 2, 1.5, 0.5);
    row.sets[0].judged.wrong = 1;
    const auto json = ray_row_json(row);
    EXPECT_TRUE(json["rays"]["mirror"]["trace_ms"].is_null());
    EXPECT_TRUE(json["rays"]["mirror"]["mrays_per_second"].is_null());
    EXPECT_FALSE(json["rays"]["mirror"]["withheld"].is_null());
    EXPECT_EQ(json["rays"]["mirror"]["wrong"], 1);
    EXPECT_FALSE(json["rays"]["shadow"]["trace_ms"].is_null());
    EXPECT_TRUE(json["dynamic_ms"].is_null());
    const std::string line = ray_table_row(row, kinds);
    EXPECT_NE(line.find("| wrong: 1 of 20000 | 0.500 (6000.0) | – |"), std::string::npos) << line;
    EXPECT_EQ(line.find("1.500"), std::string::npos) << line;
    // As many as may be wrong are no reason.
    row.sets[0].judged.allowed = 1e-4;
    EXPECT_EQ(ray_row_json(row)["dynamic_ms"], 4);
}

TEST(Rows, WhatRaysCostIsToldByItsPercentiles) {
    RayRow row = row_of("exact", 2, 1.5, 0.5);
    EXPECT_EQ(costs_table({row}), "");
    // 98 rays with 7 steps, one with 300 and one with 1000.
    KindCosts costs;
    costs.rays = 100;
    costs.sums[0] = 98 * 7 + 300 + 1000;
    costs.largest.steps = 1000;
    costs.buckets.resize(COUNT_FIELDS * COUNT_BUCKETS);
    costs.buckets[7] = 98;
    costs.buckets[COUNT_EQUAL + (300 - 256) / 8] = 1;
    costs.buckets[COUNT_EQUAL + 32 + (1000 - 512) / 16] = 1;
    for (size_t field = 1; field < COUNT_FIELDS; field++) costs.buckets[field * COUNT_BUCKETS] = 100;
    row.sets[0].costs = costs;
    EXPECT_EQ(costs.percentile(0, 0.5), 7u);
    EXPECT_EQ(costs.percentile(0, 0.98), 7u);
    EXPECT_EQ(costs.percentile(0, 0.99), 303u) << "the most that its bucket holds";
    EXPECT_EQ(costs.percentile(0, 1), 1000u) << "never more than the largest";
    EXPECT_EQ(costs.percentile(1, 0.99), 0u);
    const auto json = ray_row_json(row)["rays"]["mirror"]["costs"];
    EXPECT_EQ(json["p50"]["steps"], 7);
    EXPECT_EQ(json["p99"]["steps"], 303);
    EXPECT_EQ(json["largest"]["steps"], 1000);
    EXPECT_FALSE(ray_row_json(row)["rays"]["shadow"].contains("costs"));
    EXPECT_NE(costs_table({row}).find("| blob:8000 | 1280x1024 | exact auto | mirror | 7 / 303 / 1000 | 0 / 0 / 0 |"),
              std::string::npos)
        << costs_table({row});
}

TEST(Rows, RatiosOfTheSameRaysOnly) {
    RayRow ours = row_of("exact", 2, 1.5, 0.5), khr = row_of("khr", 1, 3, 2), other = row_of("khr", 1, 3, 2);
    other.scene = "blob:500";
    EXPECT_NE(ratio_table({ours, other, khr}, kinds).find("| exact auto | khr | 0.50 | 0.25 | 2.00 | 0.67 |"),
              std::string::npos);
    EXPECT_EQ(ratio_table({ours, other, khr}, kinds).find("blob:500"), std::string::npos);
    khr.sets[0].judged.wrong = 100;
    EXPECT_NE(ratio_table({ours, khr}, kinds).find("| exact auto | khr | – | 0.25 | 2.00 | – |"), std::string::npos);
    EXPECT_EQ(ratio_table({ours}, kinds), "");
}

TEST(Rows, WhatIsBuiltOnceHasNoDynamicFrame) {
    RayRow row = row_of("khr static", 9, 3, 2);
    row.build = {};
    EXPECT_EQ(row.dynamic_ms(), std::nullopt);
}

TEST(Rows, WhatIsLeftOutSaysWhyInOneCell) {
    RayRow row;
    row.scene = row.shown = "a|b.obj";
    row.contender = "all";
    row.left_out = "no room\nfor a|b";
    const std::string line = ray_table_row(row, kinds);
    EXPECT_NE(line.find("left out: no room"), std::string::npos);
    EXPECT_EQ(std::count(line.begin(), line.end(), '\n'), 1);
    EXPECT_NE(line.find("a\\|b"), std::string::npos);
    EXPECT_EQ(ray_row_json(row)["left_out"], row.left_out);
}

}  // namespace
}  // namespace peelray
