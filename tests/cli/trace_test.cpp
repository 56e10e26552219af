// `peelray trace` against answers worked out by hand.
#include <cstring>
#include <limits>

#include "cli/hits.h"
#include "cli/program_fixture.h"

namespace peelray {
namespace {

class TraceCommand : public ProgramTest {
  protected:
    void SetUp() override {
        ProgramTest::SetUp();
        put("cube.obj", kCube);
    }
    std::vector<HitRecord> trace(const std::vector<float>& rays, std::vector<std::string> more = {}) const {
        put("rays.npy", rays_npy(rays));
        std::vector<std::string> arguments = {"trace",        in("cube.obj"), "--rays",
                                              in("rays.npy"), "--out",        out("hits.npy")};
        arguments.insert(arguments.end(), more.begin(), more.end());
        expect_done(run(arguments), {"hits.npy"});
        return hits_of(get(out("hits.npy")), rays.size() / 8);
    }
};

struct Known {
    RayRecord ray;
    HitRecord hit;
};

const HitRecord kNothing = {std::numeric_limits<float>::infinity(), kMiss, 0, 0};

const std::vector<Known> kKnown = {
    {{0.5f, 0.25f, 3, 0, 0, 0, -1, 100}, {2, 0, 0.25f, 0.25f}},        // +z, its first triangle
    {{0.25f, 0.75f, 3, 0, 0, 0, -1, 100}, {2, 1, 0.25f, 0.5f}},        // +z, its second
    {{0.5f, 0.25f, 3, 0, 0, 0, -4, 100}, {0.5f, 0, 0.25f, 0.25f}},     // t counts in lengths of the direction
    {{0.5f, 0.25f, 3, 0, 0.5f, 0, -4, 100}, {0.5f, 0, 0.5f, 0.25f}},   // oblique
    {{0.5f, 0.25f, 3, 2.5f, 0, 0, -1, 100}, {3, 2, 0.25f, 0.25f}},     // tmin lies behind the near face
    {{0.5f, 0.25f, 3, 0, 0, 0, -1, 1.5f}, kNothing},                   // tmax lies before it
    {{0.5f, 0.25f, 3, 2.5f, 0, 0, -1, 2.75f}, kNothing},               // both lie inside
    {{0.5f, 0.25f, 3, 0, 0, 0, 1, 100}, kNothing},                     // away
    {{2, 2, 3, 0, 0, 0, -1, 100}, kNothing},                           // past it
    {{0.5f, 0.25f, 0.5f, 0, 0, 0, -1, 100}, {0.5f, 2, 0.25f, 0.25f}},  // from within
    {{3, 0.25f, 0.5f, 0, -1, 0, 0, 100}, {2, 4, 0.25f, 0.25f}},        // +x
    {{0.5f, 5, 0.25f, 0, 0, -4, 0, 100}, {1, 9, 0.5f, 0.25f}},         // +y
    {{0.5f, 0.25f, 3, 0, 0, 0, -1, std::numeric_limits<float>::infinity()}, {2, 0, 0.25f, 0.25f}},
};

std::vector<float> known_rays() {
    std::vector<float> rays;
    for (const Known& known : kKnown)
        rays.insert(rays.end(), {known.ray.ox, known.ray.oy, known.ray.oz, known.ray.tmin, known.ray.dx, known.ray.dy,
                                 known.ray.dz, known.ray.tmax});
    return rays;
}

void expect_known(const std::vector<HitRecord>& hits) {
    ASSERT_EQ(hits.size(), kKnown.size());
    for (size_t i = 0; i < hits.size(); i++) {
        SCOPED_TRACE(i);
        const HitRecord& want = kKnown[i].hit;
        EXPECT_EQ(hits[i].triangle, want.triangle);
        if (want.triangle == kMiss) {
            EXPECT_EQ(hits[i].t, std::numeric_limits<float>::infinity());
            EXPECT_EQ(hits[i].u, 0);
            EXPECT_EQ(hits[i].v, 0);
        } else {
            EXPECT_NEAR(hits[i].t, want.t, 1e-5);
            EXPECT_NEAR(hits[i].u, want.u, 1e-5);
            EXPECT_NEAR(hits[i].v, want.v, 1e-5);
        }
    }
}

TEST_F(TraceCommand, KnownHits) {
    expect_known(trace(known_rays(), {"--hit", "exact"}));
}

TEST_F(TraceCommand, KnownHitsAtEveryResolutionAndUnderValidation) {
    for (const std::string n : {"16", "100"})
        expect_known(trace(known_rays(), {"--ldc", n, "--validate", "--builder", "compute", "--tracer", "ldc"}));
}

TEST_F(TraceCommand, CountersOfEveryRay) {
    put("rays.npy", rays_npy(known_rays()));
    for (const std::vector<std::string>& more :
         {std::vector<std::string>{}, {"--traversal", "two-level"}, {"--traversal", "mipmap", "--batch", "rays"}}) {
        SCOPED_TRACE(more.empty() ? "voxel" : more[1]);
        std::vector<std::string> arguments = {"trace",   in("cube.obj"),  "--rays",     in("rays.npy"),
                                              "--out",   out("hits.npy"), "--counters", out("c.npy"),
                                              "--stats", out("s.json")};
        arguments.insert(arguments.end(), more.begin(), more.end());
        expect_done(run(arguments), {"c.npy", "hits.npy", "s.json"});
        const std::string file = get(out("c.npy"));
        const size_t body = file.find('\n') + 1;
        EXPECT_NE(file.find("[('steps', '<u4'), ('cells', '<u4'), ('pixels', '<u4'), ('samples', '<u4'), "
                            "('triangles', '<u4')]"),
                  std::string::npos);
        ASSERT_EQ(file.size() - body, kKnown.size() * sizeof(RayCosts));
        std::vector<RayCosts> costs(kKnown.size());
        std::memcpy(costs.data(), file.data() + body, file.size() - body);
        double steps = 0;
        for (size_t i = 0; i < costs.size(); i++) {
            SCOPED_TRACE(i);
            steps += costs[i].steps;
            // What hits has met a cell, a sample and a triangle; what never enters the cube has cost nothing.
            if (kKnown[i].hit.triangle != kMiss) {
                EXPECT_GT(costs[i].cells, 0u);
                EXPECT_GT(costs[i].samples, 0u);
                EXPECT_GT(costs[i].triangles, 0u);
            }
            if (more.empty())
                EXPECT_EQ(costs[i].pixels, 0u);
            else
                EXPECT_LE(costs[i].cells, costs[i].pixels);
        }
        EXPECT_EQ(costs[8].steps, 0u);  // past it
        const auto stats = nlohmann::json::parse(get(out("s.json")));
        EXPECT_EQ(stats["counters"]["rays"]["rays"], kKnown.size());
        EXPECT_NEAR(stats["counters"]["rays"]["mean"]["steps"].get<double>(), steps / double(kKnown.size()), 1e-6);
        EXPECT_TRUE(stats["memory"]["parts"].contains("cubes"));
    }
}

TEST_F(TraceCommand, AnyHitAgreesOnWhatIsHit) {
    const auto hits = trace(known_rays(), {"--any-hit"});
    for (size_t i = 0; i < hits.size(); i++) {
        SCOPED_TRACE(i);
        EXPECT_EQ(hits[i].triangle == kMiss, kKnown[i].hit.triangle == kMiss);
        if (hits[i].triangle == kMiss) continue;
        EXPECT_GE(hits[i].t, kKnown[i].hit.t - 1e-5);
        EXPECT_LE(hits[i].t, kKnown[i].ray.tmax);
    }
}

TEST_F(TraceCommand, PlanarFindsTheSameFaces) {
    const auto hits = trace(known_rays(), {"--hit", "planar", "--ldc", "128"});
    for (size_t i = 0; i < hits.size(); i++) {
        SCOPED_TRACE(i);
        EXPECT_EQ(hits[i].triangle / 2, kKnown[i].hit.triangle / 2);
        if (hits[i].triangle != kMiss) {
            EXPECT_NEAR(hits[i].t, kKnown[i].hit.t, 1e-4);
        }
    }
}

TEST_F(TraceCommand, ByPixelTheHitsAreTheSame) {
    for (const std::vector<std::string>& options :
         {std::vector<std::string>{"--traversal", "two-level"},
          {"--traversal", "mipmap"},
          {"--traversal", "two-level", "--block", "2x32", "--batch", "layers"},
          {"--traversal", "mipmap", "--batch", "rays"}}) {
        SCOPED_TRACE(options.back());
        expect_known(trace(known_rays(), options));
    }
}

TEST_F(TraceCommand, TolerancesFindTheSameFaces) {
    for (const std::string traversal : {"voxel", "two-level", "mipmap"}) {
        SCOPED_TRACE(traversal);
        const auto hits = trace(
            known_rays(), {"--hit", "tolerance", "--ldc", "128", "--tolerance", "0.01", "--traversal", traversal});
        for (size_t i = 0; i < hits.size(); i++) {
            EXPECT_EQ(hits[i].triangle / 2, kKnown[i].hit.triangle / 2) << i;
            if (hits[i].triangle != kMiss) {
                EXPECT_NEAR(hits[i].t, kKnown[i].hit.t, 0.011) << i;
            }
        }
    }
}

TEST_F(TraceCommand, RaysWithoutMeaningMiss) {
    const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
    for (const HitRecord& hit : trace({0.5f, 0.25f, 3, 0,   0,   0, 0,  100,  //
                                       nan,  0.25f, 3, 0,   0,   0, -1, 100,  //
                                       0.5f, 0.25f, 3, 0,   nan, 0, -1, 100,  //
                                       0.5f, 0.25f, 3, nan, 0,   0, -1, 100,  //
                                       0.5f, 0.25f, 3, 0,   0,   0, -1, nan,  //
                                       inf,  0.25f, 3, 0,   -1,  0, 0,  100,  //
                                       0.5f, 0.25f, 3, 5,   0,   0, -1, 1})) {
        EXPECT_EQ(hit.triangle, kMiss);
        EXPECT_EQ(hit.t, inf);
    }
}

TEST_F(TraceCommand, NoRays) {
    EXPECT_TRUE(trace({}).empty());
}

TEST_F(TraceCommand, Stats) {
    put("rays.npy", rays_npy(known_rays()));
    expect_done(run({"trace", in("cube.obj"), "--rays", in("rays.npy"), "--out", out("hits.npy"), "--stats",
                     out("s.json"), "--repeat", "3"}),
                {"hits.npy", "s.json"});
    const auto stats = nlohmann::json::parse(get(out("s.json")));
    EXPECT_EQ(stats["rays"], kKnown.size());
    EXPECT_EQ(stats["triangles"], 12);
    EXPECT_EQ(stats["hits"], 9);
    for (const char* key :
         {"device", "driver", "api_version", "commit", "build_ms", "trace_ms", "passes", "mrays_per_second", "ldc"})
        EXPECT_TRUE(stats.contains(key)) << key;
}

}  // namespace
}  // namespace peelray
