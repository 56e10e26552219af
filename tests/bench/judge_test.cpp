// Wrong answers are found, and few of them are too many: the time of a contender that errs is withheld.
#include "bench/judge.h"

#include <gtest/gtest.h>

#include "bench/embree_contender.h"
#include "loaders/load.h"
#include "motion/bounds.h"
#include "reference/ray_sets.h"

namespace peelray {
namespace {

/// Says what it is told.
class Fake : public RayContender {
  public:
    Fake(Claim claim, double voxel) : claim_(claim), voxel_(voxel) {}
    Claim claim() const override { return claim_; }
    double voxel() const override { return voxel_; }
    Timing time_build(uint32_t) override { return {}; }
    void take(std::vector<Ray>) override {}
    Timing time_trace(bool, uint32_t) override { return {}; }
    std::vector<FileHit> answers() override { return {}; }
    MemoryUse memory() const override { return {}; }

  private:
    Claim claim_;
    double voxel_;
};

class JudgeTest : public testing::Test {
  protected:
    JudgeTest() : scene_(load_scene("builtin:blob:2000")), geometry_(flatten(scene_)), oracle_(geometry_) {
        RaySetView view{scene_.cameras.front(), 120, 96, bounds(scene_, at_rest(scene_)), {}};
        view.light.direction = {0, -1, 0};
        const RaySets sets = make_ray_sets(scene_, geometry_, oracle_, view, {RayKind::mirror, RayKind::shadow});
        mirror_ = rays_of(sets[size_t(RayKind::mirror)]);
        shadow_ = rays_of(sets[size_t(RayKind::shadow)]);
    }

    static std::vector<Ray> rays_of(const std::vector<SurfaceRay>& set) {
        std::vector<Ray> rays;
        for (const SurfaceRay& ray : set) {
            const StartedRay s = leaving_ray(ray, 0);
            rays.push_back({s.origin, s.tmin, s.direction, s.tmax});
        }
        return rays;
    }
    std::vector<FileHit> right(const std::vector<Ray>& rays) const {
        std::vector<FileHit> hits;
        for (const Ray& ray : rays) {
            const OracleHit hit =
                oracle_.closest({glm::dvec3(ray.origin), ray.tmin, glm::dvec3(ray.direction), ray.tmax});
            hits.push_back({float(hit.t), hit.triangle, float(hit.u), float(hit.v)});
        }
        return hits;
    }
    Judgement judged(Claim claim, const std::vector<FileHit>& hits, double voxel = 0, uint32_t resolution = 1024,
                     size_t most = 20'000) const {
        return judge(oracle_, geometry_, Fake(claim, voxel), resolution, mirror_, hits, false, most);
    }

    Scene scene_;
    Geometry geometry_;
    Oracle oracle_;
    std::vector<Ray> mirror_, shadow_;
};

TEST_F(JudgeTest, RightAnswersPassAndOneWrongExactAnswerDoesNot) {
    std::vector<FileHit> hits = right(mirror_);
    for (const Claim claim : {Claim::exact, Claim::single, Claim::voxel}) {
        const Judgement judgement = judged(claim, hits, 1e-3);
        EXPECT_EQ(judgement.wrong, 0u);
        EXPECT_EQ(judgement.checked, mirror_.size());
        EXPECT_TRUE(judgement.passes());
    }
    const auto some =
        std::find_if(hits.begin(), hits.end(), [](const FileHit& hit) { return hit.triangle != ~0u && hit.t > 0.3f; });
    ASSERT_NE(some, hits.end());
    const float right_t = some->t;
    some->t = 20;
    EXPECT_EQ(judged(Claim::exact, hits).wrong, 1u);
    EXPECT_FALSE(judged(Claim::exact, hits).passes());
    some->t = right_t + 0.01f;
    EXPECT_TRUE(judged(Claim::voxel, hits, 0.1).passes());
}

TEST_F(JudgeTest, SinglePrecisionMayErrAtOneRayInTenThousand) {
    std::vector<FileHit> hits = right(mirror_);
    ASSERT_LT(mirror_.size(), 20'000u);
    for (size_t i = 0; i < 3; i++) hits[i * 100] = {123, 0, 0, 0};
    EXPECT_EQ(judged(Claim::single, hits).wrong, 3u);
    EXPECT_FALSE(judged(Claim::single, hits).passes());
    EXPECT_EQ(allowed_share(Claim::single, 0), 1e-4);
}

TEST_F(JudgeTest, PlanarMayBeOffMoreWhereVoxelsAreLarger) {
    EXPECT_DOUBLE_EQ(allowed_share(Claim::voxel, 1024), 0.003);
    EXPECT_DOUBLE_EQ(allowed_share(Claim::voxel, 256), 0.012);
    std::vector<FileHit> hits = right(mirror_);
    size_t found = 0, lost = 0;
    for (const FileHit& hit : hits) found += hit.triangle != ~0u;
    for (FileHit& hit : hits)
        if (hit.triangle != ~0u && lost < found / 100)
            hit = {std::numeric_limits<float>::infinity(), ~0u, 0, 0}, lost++;
    ASSERT_GT(lost, 3u);
    const Judgement fine = judged(Claim::voxel, hits, 1e-5, 1024), coarse = judged(Claim::voxel, hits, 1e-5, 256);
    EXPECT_NEAR(double(fine.wrong), double(lost), 0.1 * double(lost));
    EXPECT_EQ(fine.counted, found);
    EXPECT_FALSE(fine.passes());
    EXPECT_TRUE(coarse.passes());
}

TEST_F(JudgeTest, AShareIsCheckedEvenly) {
    std::vector<FileHit> hits = right(mirror_);
    for (FileHit& hit : hits) hit = {-1, 5, 0, 0};
    const Judgement judgement = judged(Claim::exact, hits, 0, 1024, 500);
    EXPECT_EQ(judgement.checked, 500u);
    EXPECT_EQ(judgement.wrong, 500u);
}

TEST_F(JudgeTest, ShadowRaysAskOnlyWhetherSomethingIsInTheWay) {
    std::vector<FileHit> hits = right(shadow_);
    for (FileHit& hit : hits)
        if (hit.triangle != ~0u) hit = {hit.t * 3, 0, 0, 0};
    const Fake exact(Claim::exact, 0), voxel(Claim::voxel, 1e-5);
    EXPECT_EQ(judge(oracle_, geometry_, exact, 0, shadow_, hits, true).wrong, 0u);
    EXPECT_EQ(judge(oracle_, geometry_, voxel, 1024, shadow_, hits, true).wrong, 0u);
    size_t blocked = 0;
    for (FileHit& hit : hits) {
        blocked += hit.triangle != ~0u;
        hit.triangle = hit.triangle == ~0u ? 0 : ~0u;
    }
    EXPECT_GT(blocked, 0u);
    // A ray that starts a little lower meets its own surface: many of the others need a second look, which is too many
    // as well.
    EXPECT_GT(judge(oracle_, geometry_, exact, 0, shadow_, hits, true).wrong, blocked / 2);
    EXPECT_FALSE(judge(oracle_, geometry_, exact, 0, shadow_, hits, true).passes());
    EXPECT_FALSE(judge(oracle_, geometry_, voxel, 1024, shadow_, hits, true).passes());
}

TEST_F(JudgeTest, EmbreeAnswersRightBySingleRaysAndPackets) {
    EmbreeContender embree(geometry_);
    EXPECT_EQ(embree.time_build(2).runs, 2u);
    for (const bool any_hit : {false, true}) {
        const std::vector<Ray>& rays = any_hit ? shadow_ : mirror_;
        embree.take(rays);
        EXPECT_EQ(embree.time_trace(any_hit, 2).runs, 2u);
        const std::vector<FileHit> hits = embree.answers();
        ASSERT_EQ(hits.size(), rays.size());
        const Judgement judgement = judge(oracle_, geometry_, embree, 0, rays, hits, any_hit);
        EXPECT_TRUE(judgement.passes()) << judgement.wrong;
    }
    const MemoryUse memory = embree.memory();
    ASSERT_EQ(memory.size(), 1u);
    EXPECT_EQ(memory[0].first, "bvh_and_vertices");
    EXPECT_GT(memory[0].second, geometry_.triangles.size() * 12);
}

}  // namespace
}  // namespace peelray
