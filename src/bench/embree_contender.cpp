#include "bench/embree_contender.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstring>

#include "base/error.h"
#include "base/parallel.h"

namespace peelray {
namespace {

double now_ms() {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Embree reports its memory as differences, from any thread.
bool count_bytes(void* counter, ssize_t bytes, bool) {
    std::atomic_ref<int64_t>(*static_cast<int64_t*>(counter)) += bytes;
    return true;
}

constexpr FileHit kMiss{std::numeric_limits<float>::infinity(), ~0u, 0, 0};

}  // namespace

EmbreeContender::EmbreeContender(const Geometry& geometry) : geometry_(geometry), device_(rtcNewDevice(nullptr)) {
    if (!device_)
        fail("cannot start Embree (error {}); check the installed libembree3", int(rtcGetDeviceError(nullptr)));
    rtcSetDeviceMemoryMonitorFunction(device_, count_bytes, &bytes_);
    build();
}

EmbreeContender::~EmbreeContender() {
    if (scene_) rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
}

std::string EmbreeContender::version() {
    return fmt::format("Embree {}.{}.{}", RTC_VERSION_MAJOR, RTC_VERSION_MINOR, RTC_VERSION_PATCH);
}

/// The vertices lie in Embree's buffers before the clock starts.
double EmbreeContender::build() {
    if (scene_) rtcReleaseScene(scene_);
    scene_ = rtcNewScene(device_);
    RTCGeometry mesh = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    void* positions =
        rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, geometry_.positions.size());
    void* triangles =
        rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, geometry_.triangles.size());
    if (!positions || !triangles) {
        rtcReleaseGeometry(mesh);
        fail("Embree has no room for {} triangles", geometry_.triangles.size());
    }
    std::memcpy(positions, geometry_.positions.data(), geometry_.positions.size() * 12);
    std::memcpy(triangles, geometry_.triangles.data(), geometry_.triangles.size() * 12);
    const double start = now_ms();
    rtcCommitGeometry(mesh);
    rtcAttachGeometry(scene_, mesh);
    rtcReleaseGeometry(mesh);
    rtcCommitScene(scene_);
    const double ms = now_ms() - start;
    if (const RTCError error = rtcGetDeviceError(device_); error != RTC_ERROR_NONE)
        fail("Embree cannot build a BVH of {} triangles (error {}); is there enough memory?",
             geometry_.triangles.size(), int(error));
    return ms;
}

Timing EmbreeContender::time_build(uint32_t runs) {
    std::vector<double> ms;
    while (ms.size() < std::min(runs, 3u)) ms.push_back(build());
    return timing_of(std::move(ms));
}

void EmbreeContender::take(std::vector<Ray> rays) {
    rays_ = std::move(rays);
    hits_.assign(rays_.size(), kMiss);
}

void EmbreeContender::trace_single(size_t i, bool any_hit) {
    const Ray& ray = rays_[i];
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit query{};
    query.ray = {ray.origin.x,
                 ray.origin.y,
                 ray.origin.z,
                 ray.tmin,
                 ray.direction.x,
                 ray.direction.y,
                 ray.direction.z,
                 0,
                 ray.tmax,
                 ~0u,
                 0,
                 0};
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    FileHit& hit = hits_[i];
    if (any_hit) {
        rtcOccluded1(scene_, &context, &query.ray);
        hit = query.ray.tfar < 0 ? FileHit{ray.tmin, 0, 0, 0} : kMiss;
        return;
    }
    rtcIntersect1(scene_, &context, &query);
    hit = query.hit.geomID == RTC_INVALID_GEOMETRY_ID
              ? kMiss
              : FileHit{query.ray.tfar, query.hit.primID, query.hit.u, query.hit.v};
}

void EmbreeContender::trace_eight(size_t first, bool any_hit) {
    const size_t count = std::min<size_t>(8, rays_.size() - first);
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    alignas(32) int valid[8];
    RTCRayHit8 query;
    for (size_t i = 0; i < 8; i++) {
        valid[i] = i < count ? -1 : 0;
        const Ray& ray = rays_[first + std::min(i, count - 1)];
        RTCRay8& out = query.ray;
        out.org_x[i] = ray.origin.x, out.org_y[i] = ray.origin.y, out.org_z[i] = ray.origin.z;
        out.dir_x[i] = ray.direction.x, out.dir_y[i] = ray.direction.y, out.dir_z[i] = ray.direction.z;
        out.tnear[i] = ray.tmin, out.tfar[i] = ray.tmax;
        out.time[i] = 0, out.mask[i] = ~0u, out.id[i] = 0, out.flags[i] = 0;
        query.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    }
    if (any_hit)
        rtcOccluded8(valid, scene_, &context, &query.ray);
    else
        rtcIntersect8(valid, scene_, &context, &query);
    for (size_t i = 0; i < count; i++) {
        const bool found = any_hit ? query.ray.tfar[i] < 0 : query.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID;
        hits_[first + i] = !found    ? kMiss
                           : any_hit ? FileHit{query.ray.tnear[i], 0, 0, 0}
                                     : FileHit{query.ray.tfar[i], query.hit.primID[i], query.hit.u[i], query.hit.v[i]};
    }
}

double EmbreeContender::trace(bool any_hit, bool packets) {
    const double start = now_ms();
    if (packets)
        parallel_for((rays_.size() + 7) / 8, 512, [&](size_t i) { trace_eight(8 * i, any_hit); });
    else
        parallel_for(rays_.size(), 4096, [&](size_t i) { trace_single(i, any_hit); });
    return now_ms() - start;
}

Timing EmbreeContender::time_trace(bool any_hit, uint32_t runs) {
    const double single = trace(any_hit, false);
    packets_ = rtcGetDeviceProperty(device_, RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED) &&
               trace(any_hit, true) < std::min(single, trace(any_hit, false));
    return time_repeatedly(std::min(runs, 5u), [&] { return trace(any_hit, packets_); });
}

MemoryUse EmbreeContender::memory() const {
    return {{"bvh_and_vertices", uint64_t(bytes_)}};
}

}  // namespace peelray
