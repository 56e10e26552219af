// The seam between a frame and who traces its rays: ldc, khr or nobody. A new tracer implements RayTracer and gets its
// line in make_tracer().
#pragma once

#include <functional>
#include <memory>

#include "ldc/tracer.h"
#include "render/measuring.h"
#include "render/merged_instances.h"
#include "render/tracers/structure_bodies.h"
#include "render/tracers/tracer_choice.h"

namespace peelray {

/// What a tracer is made for. All but the assembly and the matrices must outlive it.
struct TracedWorld {
    Device& device;
    const TriangleBuffers& triangles;
    Instances& instances;
    const Assembly& assembly;              ///< bodies and instances; its geometry may have been dropped
    const std::vector<glm::mat4>& worlds;  ///< of all nodes, at some moment
    /// Of each body, for the device's own ray tracing; empty where the device has none.
    const std::vector<StructureBody>& structures;
    /// Of many small bodies copies that share a cube, which `ldc` may use; null: there are none.
    const MergedInstances* merged = nullptr;
};

/// The shadow rays of all levels of a band.
struct ShadowRays {
    RayQueue rays;
    const Buffer& light;  ///< vec3 each: what may arrive along the ray; once it is traced, what does
    bool glass;           ///< surfaces in the way may tint the light
    const Buffer* media;  ///< MediaStack each, where the rays start; null: media do not overlap
    Constant materials;   ///< of shaders that evaluate these surfaces' materials
    /// What shading reads beside triangles and instances, all of it only if used: glass tints by its base colour.
    std::vector<Binding> surfaces;
};

/// A level's rays where media may overlap: followed to the next surface that is one to them.
struct LayeredRays {
    RayQueue rays;
    const Buffer& hits;             ///< Hit each
    const Buffer& media;            ///< MediaStack each: where the ray starts
    const Buffer& walls;            ///< MediaWall each: what is met there
    bool camera;                    ///< `hits` holds what the rays hit first, and they start in Frame::camera_media
    Constant materials;             ///< as in ShadowRays
    std::vector<Binding> surfaces;  ///< as in ShadowRays
};

struct TraceQuery {
    bool any_hit = false;  ///< some hit in (tmin, tmax), else the nearest
    Edges edges = Edges::single;
};

class RayTracer {
  public:
    virtual ~RayTracer() = default;

    /// False: there is nothing that rays could hit, so that none need be made.
    virtual bool traces() const = 0;
    /// Can it count what rays cost (RayQueue::counting)?
    virtual bool counts() const { return false; }
    /// The bodies that the instances show, whose bounds the passes of an animation write.
    virtual const BodyTable& bodies() const = 0;

    /// The scene takes on another moment; `moved`: some instance stands elsewhere.
    virtual void pose(bool moved) = 0;

    /// Everything that this moment's rays are traced in. `animate` records what writes vertices and bounds, as often as
    /// it is called. May submit, until everything fits; `meter` gets the times of what was submitted.
    virtual void build(Commands& commands, const std::function<void()>& animate, FrameMeter& meter) = 0;

    /// What of it is built for every frame, alone, for measuring. After the submission finish_rebuild() tells whether
    /// everything fitted; if not, it is to be recorded again.
    virtual void record_rebuild(Commands& commands) = 0;
    virtual bool finish_rebuild(Commands&) { return true; }

    /// Records the tracing of a queue: hits[i] (Hit each) for rays[i].
    virtual void trace(Commands& commands, const RayQueue& queue, const Buffer& hits, const TraceQuery& query) = 0;

    /// The same where media may overlap (path/media_walk.glsl).
    virtual void trace_layered(Commands& commands, const LayeredRays& rays) = 0;

    /// Records what is left of the light along shadow rays.
    virtual void shadow(Commands& commands, const ShadowRays& shadows) = 0;

    /// What shaders are told about hits, in a picture's constants.
    virtual void describe(Frame&) const {}
    /// `bodies`: of each body, too. Submits then.
    virtual void describe(Commands&, TracerStats&, bool /*bodies*/) const {}
};

/// The tracer that the choice asks for, not yet built; with `cubemap`, which traces no rays, the one that has none.
/// `choice.cubes.hit` is what it says, `auto` being resolved. Throws Error where the device cannot do it.
std::unique_ptr<RayTracer> make_tracer(const TracerChoice& choice, const TracedWorld& world);

/// Do cube maps and shadow maps stand in for rays?
bool shades_by_maps(const TracerChoice& choice);

}  // namespace peelray
