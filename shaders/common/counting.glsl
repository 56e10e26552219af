// Counting what rays cost (`--counters`); include before peelray/peelray.glsl. The including shader has the specialisation
// constant `counting`: without it nothing of this is left, and the buffers are not touched.
// Bindings COUNT_FIRST_BINDING and + 1.
#include "ldc/trace_params.h"
#ifndef COUNT_RAYS
#define COUNT_RAYS 1  // that a thread traces side by side
#endif
BUFFER(, COUNT_FIRST_BINDING + 0, PeelrayCounts, costs)        // of each entry of the queue, added to
BUFFER(, COUNT_FIRST_BINDING + 1, CountTotals, count_totals)  // by kind of ray (COUNT_TRACED, ...)

PeelrayCounts counts[COUNT_RAYS];
uint counted_ray = 0u;
#define PEELRAY_COUNTED counting
#define PEELRAY_COUNTERS counts[counted_ray]
#define PEELRAY_COUNT_RAY(k) counted_ray = uint(k);

#define COUNT_EACH(statement) \
    statement(steps) statement(cells) statement(pixels) statement(samples) statement(triangles)

uint countBucket(uint count) {
    if (count < COUNT_EQUAL) return count;
    const uint power = uint(findMSB(count));
    return COUNT_EQUAL + (power - 8u) * 32u + (count >> (power - 5u) & 31u);
}

/// Before a ray is traced.
void countNothing() {
    if (!counting) return;
    for (uint k = 0u; k < COUNT_RAYS; k++) counts[k] = PeelrayCounts(0u, 0u, 0u, 0u, 0u);
}

/// After a ray of this kind, the thread's k-th, was traced for entry i of the queue.
void countRay(uint kind, uint k, uint i) {
    if (!counting) return;
    atomicAdd(count_totals[kind].rays, 1u);
#define COUNT_ADD(what)                                                                                  \
    atomicAdd(costs[i].what, counts[k].what);                                                            \
    if (atomicAdd(count_totals[kind].low.what, counts[k].what) > ~counts[k].what)                        \
        atomicAdd(count_totals[kind].high.what, 1u);                                                     \
    atomicMax(count_totals[kind].largest.what, counts[k].what);
    COUNT_EACH(COUNT_ADD)
#undef COUNT_ADD
    uint field = 0u;
#define COUNT_INTO_BUCKET(what) atomicAdd(count_totals[kind].buckets[COUNT_BUCKETS * field++ + countBucket(counts[k].what)], 1u);
    COUNT_EACH(COUNT_INTO_BUCKET)
#undef COUNT_INTO_BUCKET
}
