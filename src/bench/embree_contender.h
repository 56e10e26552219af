// Embree 3 in a benchmark: its own BVH and triangle test, in single precision, on all cores.
#pragma once

#include "bench/contender.h"
#include "scene/scene.h"

struct RTCDeviceTy;
struct RTCSceneTy;

namespace peelray {

class EmbreeContender : public RayContender {
  public:
    /// Builds its BVH. Throws Error where there is no room.
    explicit EmbreeContender(const Geometry& geometry);
    ~EmbreeContender() override;
    EmbreeContender(const EmbreeContender&) = delete;
    EmbreeContender& operator=(const EmbreeContender&) = delete;

    Claim claim() const override { return Claim::single; }
    /// At most three times, since it is slow and steady.
    Timing time_build(uint32_t runs) override;
    void take(std::vector<Ray> rays) override;
    /// By single rays and by packets of eight in turn; the faster way counts. At most five times.
    Timing time_trace(bool any_hit, uint32_t runs) override;
    std::vector<FileHit> answers() override { return hits_; }
    std::string way() const override { return packets_ ? "packets of 8" : "single rays"; }
    MemoryUse memory() const override;

    /// "Embree 3.13.5"
    static std::string version();

  private:
    double build();
    double trace(bool any_hit, bool packets);
    void trace_single(size_t ray, bool any_hit);
    void trace_eight(size_t first, bool any_hit);

    const Geometry& geometry_;
    RTCDeviceTy* device_;
    RTCSceneTy* scene_ = nullptr;
    std::vector<Ray> rays_;
    std::vector<FileHit> hits_;
    bool packets_ = false;
    int64_t bytes_ = 0;  ///< that Embree holds now
};

}  // namespace peelray
