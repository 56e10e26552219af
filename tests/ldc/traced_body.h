// A body with its cube on the device, ready to trace.
#pragma once

#include "common/ray.h"
#include "scene/scene.h"
#include "single_cube.h"

namespace peelray::test {

class TracedBody {
  public:
    TracedBody(Device& device, const Geometry& geometry, uint32_t resolution, HitTest test,
               const CubeLayout& layout = {}, float tolerance = 0.001f, const Refinement& refinement = {})
        : device_(device),
          commands_(device),
          cube_(device, commands_, geometry.positions, geometry.triangles, geometry.lower, geometry.upper, resolution,
                sampling_for(test), layout, tolerance, nullptr, refinement),
          test_(test),
          tolerance_(tolerance) {}

    std::vector<Hit> trace(const std::vector<Ray>& rays, bool any_hit = false, const std::vector<uint32_t>& skip = {}) {
        Buffer ray_buffer(device_, "rays", rays.size() * sizeof(Ray)),
            hit_buffer(device_, "hits", rays.size() * sizeof(Hit));
        commands_.upload(ray_buffer, std::span<const Ray>(rays));
        Buffer skip_buffer;
        if (!skip.empty()) {
            std::vector<SurfaceId> own;
            for (uint32_t triangle : skip) own.push_back({0, triangle});
            skip_buffer = Buffer(device_, "skip", own.size() * sizeof(SurfaceId));
            commands_.upload(skip_buffer, std::span<const SurfaceId>(own));
        }
        record_trace(commands_, device_, cube_.traced(),
                     {ray_buffer, skip.empty() ? nullptr : &skip_buffer, uint32_t(rays.size())}, hit_buffer,
                     {test_, tolerance_, any_hit});
        commands_.submit();
        return commands_.download<Hit>(hit_buffer, rays.size());
    }
    const CubeGrid& grid() const { return cube_.grid; }
    const SingleCube& cube() const { return cube_; }
    Commands& commands() { return commands_; }

  private:
    Device& device_;
    Commands commands_;
    SingleCube cube_;
    HitTest test_;
    float tolerance_;
};

}  // namespace peelray::test
