// What rays cost, counted; and device memory, accounted for.
#include <numeric>
#include <set>

#include "pictures.h"

namespace peelray {
namespace {

class Counters : public PictureTest {
  protected:
    /// A mirror and a glass ball over a floor, under a sun.
    Counters() {
        stage.add(ground(4, -1), lambert(glm::vec3(0.5f)));
        stage.add(sphere({-1, 0, 0}, 0.9f, 12), plane_mirror());
        stage.add(sphere({1, 0, 0}, 0.9f, 12), clear_glass());
        stage.sun({-1, -2, -1});
    }
    RenderSettings settings() const {
        Camera camera;
        camera.eye = glm::vec3(0, 1, 6);
        camera.look = glm::vec3(0);
        RenderSettings s = settings_for(camera, 48);
        s.counters = s.ambient = true;
        return s;
    }
    static uint64_t sum(const std::vector<RayCosts>& costs, const RayCostField& field) {
        return std::accumulate(costs.begin(), costs.end(), uint64_t(0),
                               [&](uint64_t all, const RayCosts& cost) { return all + cost.*field.value; });
    }
    Stage stage;
};

TEST_F(Counters, EveryRayCountsOnceAndOfEachPixelAll) {
    for (const Traversal traversal : {Traversal::voxel, Traversal::two_level}) {
        SCOPED_TRACE(name_of(traversal));
        RenderSettings s = settings();
        s.cubes.layout.traversal = traversal;
        s.spp = 2;
        const RenderResult picture = render(stage, white, s);
        ASSERT_TRUE(picture.stats.counted);
        const AllKindCosts& kinds = picture.stats.costs;
        EXPECT_EQ(kinds[COUNT_TRACED].rays, picture.rays.reflection + picture.rays.refraction);
        EXPECT_EQ(kinds[COUNT_SHADOW].rays, picture.rays.shadow + picture.rays.ambient);
        ASSERT_EQ(picture.aovs.costs.size(), 48u * 48u);
        for (size_t i = 0; i < kRayCostFields.size(); i++) {
            SCOPED_TRACE(kRayCostFields[i].name);
            uint64_t all = 0;
            for (const KindCosts& kind : kinds) {
                all += kind.sums[i];
                EXPECT_LE(kind.mean(i), kind.largest.*kRayCostFields[i].value);
                const uint64_t* bucket = &kind.buckets.at(i * COUNT_BUCKETS);
                EXPECT_EQ(std::accumulate(bucket, bucket + COUNT_BUCKETS, uint64_t(0)), kind.rays);
                EXPECT_LE(kind.percentile(i, 0.5), kind.percentile(i, 0.99));
                EXPECT_EQ(kind.percentile(i, 1), kind.largest.*kRayCostFields[i].value);
            }
            EXPECT_EQ(sum(picture.aovs.costs, kRayCostFields[i]), all);
            const bool nothing = traversal == Traversal::voxel && kRayCostFields[i].value == &RayCosts::pixels;
            EXPECT_EQ(all == 0, nothing);
        }
        // The sky costs nothing: camera rays are drawn, not traced.
        EXPECT_EQ(picture.aovs.costs[0].steps, 0u);
    }
}

TEST_F(Counters, ThePictureIsTheSameAndNothingIsCountedUnasked) {
    RenderSettings s = settings();
    const RenderResult counted = render(stage, white, s);
    s.counters = false;
    const RenderResult plain = render(stage, white, s);
    EXPECT_EQ(counted.encoded, plain.encoded);
    EXPECT_FALSE(plain.stats.counted);
    EXPECT_TRUE(plain.aovs.costs.empty());
}

TEST_F(Counters, FromRunToRunTheSame) {
    const auto renderer = renderer_for(stage, white);
    const RenderResult a = renderer->render(settings()), b = renderer->render(settings());
    for (const RayCostField& field : kRayCostFields)
        for (size_t i = 0; i < a.aovs.costs.size(); i++)
            ASSERT_EQ(a.aovs.costs[i].*field.value, b.aovs.costs[i].*field.value) << field.name << " of pixel " << i;
}

TEST_F(Counters, AllMemoryIsAccountedFor) {
    const auto total = [](const std::vector<Allocation>& list) {
        return std::accumulate(list.begin(), list.end(), uint64_t(0),
                               [](uint64_t sum, const Allocation& a) { return sum + a.bytes; });
    };
    const auto renderer = renderer_for(stage, white);
    const RenderStats stats = renderer->render(settings()).stats;
    EXPECT_EQ(total(device().allocations()), device().allocated());
    EXPECT_EQ(total(stats.memory), device().allocated());
    EXPECT_EQ(total(stats.peak_memory), stats.peak_bytes);
    std::set<std::string> parts;
    for (const Allocation& allocation : stats.memory) {
        EXPECT_FALSE(allocation.name.empty());
        parts.insert(allocation.part);
    }
    for (const char* part : {"triangles", "cubes", "scene", "frame", "images"})
        EXPECT_TRUE(parts.contains(part)) << part;
    EXPECT_FALSE(parts.contains("build scratch"));  // of what is built once it is given back
    EXPECT_FALSE(parts.contains("other"));
}

TEST_F(Counters, TablesOfWhatIsBuiltOnceHoldJustWhatTheyMust) {
    const auto renderer = renderer_for(stage, white);
    const RenderStats stats = renderer->render(settings()).stats;
    const auto bytes = [&](const std::string& name) {
        uint64_t sum = 0;
        for (const Allocation& a : stats.memory) sum += a.name == name ? a.bytes : 0;
        return sum;
    };
    // To what the device aligns to.
    EXPECT_NEAR(double(bytes("the cubes' patches")), double(stats.cubes.counts.fragments) * 16, 65536);
    EXPECT_NEAR(double(bytes("the cubes' voxels")), double(stats.cubes.counts.nodes) * 256, 65536);
}

}  // namespace
}  // namespace peelray
