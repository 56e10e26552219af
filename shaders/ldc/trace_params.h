// Tracing queues in the cubes: trace*.comp and path/trace_shadow*.comp (src/ldc/tracer).
#ifndef PEELRAY_TRACE_PARAMS_H
#define PEELRAY_TRACE_PARAMS_H

#include "common/shared.h"

#ifdef __cplusplus
namespace peelray {
#endif

/// A hit as HITS.npy has it: the triangle counts over the whole scene, in file order.
struct FileHit {
    float t;
    uint triangle;
    float u;
    float v;
};
SHARED_SIZE(FileHit, 16);

struct TraceParams {
    PeelrayTree tree;
    uint count;    ///< rays in the queue; with `counted`: room in the queue
    uint counted;  ///< 1: the count is queue[counter]
    uint counter;
    uint skips;       ///< 1: ray i must not hit skip[i]
    float tolerance;  ///< of `tolerance` hits, world units
    uvec2 block;      ///< pixels of a block of two_level
    // With the constant `merging` (MergedInstances):
    uint merged_instance;  ///< that which shows the copies
    uint first_copy;       ///< triangle: from here on they are copies
};
SHARED_SIZE(TraceParams, 76);

/// Rays that cost equally much, or above COUNT_EQUAL nearly so, are counted together: 32 buckets for each power of two.
#define COUNT_EQUAL 256u
#define COUNT_BUCKETS 1024u
#define COUNT_FIELDS 5u

/// What the rays of one kind cost in all (shaders/common/counting.glsl).
struct CountTotals {
    uint rays;
    PeelrayCounts low;  ///< of sums in 64 bits
    PeelrayCounts high;
    PeelrayCounts largest;                      ///< of a single ray
    uint buckets[COUNT_FIELDS * COUNT_BUCKETS];  ///< rays in each, field by field in the order of PeelrayCounts
};
SHARED_SIZE(CountTotals, 20544);
#define COUNT_TRACED 0u  // what `trace` traces: reflection and refraction, the rays of a file
#define COUNT_SHADOW 1u  // to the lamps and to the sky
#define COUNT_KINDS 2u

#ifdef __cplusplus
}  // namespace peelray
#endif
#endif
