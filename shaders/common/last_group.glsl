// Who finishes last: what a dispatch has counted can then be turned into the workgroups of the next one, without a pass for it.
// Include after the buffer queue.
#ifndef PEELRAY_LAST_GROUP_GLSL
#define PEELRAY_LAST_GROUP_GLSL

#include "path/path_params.h"

/// Is this the last workgroup of the dispatch to come here? To be called by one thread of each, once its counters are
/// written.
bool isLastGroup() {
    memoryBarrierBuffer();
    if (atomicAdd(queue[QUEUE_FINISHED], 1u) + 1u < gl_NumWorkGroups.x * gl_NumWorkGroups.y) return false;
    queue[QUEUE_FINISHED] = 0u;  // for the next pass
    return true;
}

/// Stores the workgroup counts number `index` of the queue for `count` workgroups.
void storeGroups(uint index, uint count) {
    const uint at = QUEUE_GROUPS + 3u * index;
    queue[at] = min(count, DISPATCH_ROW);
    queue[at + 1u] = (count + DISPATCH_ROW - 1u) / DISPATCH_ROW;
    queue[at + 2u] = 1u;
}

/// The same for `rays` of them, 64 to a workgroup, or launched each.
void storeRays(uint index, uint rays) {
    storeGroups(index, (rays + 63u) / 64u);
    const uint at = QUEUE_LAUNCHES + 3u * index;
    queue[at] = rays;
    queue[at + 1u] = queue[at + 2u] = 1u;
}

#endif
