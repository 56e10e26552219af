// Sorts the long lists by id: one workgroup per list, a stable radix sort with 8-bit digits, linear in the list's length.
// Four rounds go unsorted_ids -> sample_ids -> ... and end in unsorted_ids; then the samples are written.
#version 460
#extension GL_EXT_control_flow_attributes : require
#include "ldc_common.glsl"
layout(local_size_x = 256) in;
PARAMS(LdcParams)
BUFFER(readonly, 0, LdcCounters, counters)
BUFFER(readonly, 1, uint, voxel_table)
BUFFER(readonly, 2, uint, voxel_counts)
BUFFER(readonly, 3, uint, long_lists)
BUFFER(readonly, 4, uvec2, node_cells)
BUFFER(readonly, 5, vec3, positions)
BUFFER(readonly, 6, uvec3, triangles)
BUFFER(, 7, uint, unsorted_ids)
BUFFER(, 8, uint, sample_ids)
BUFFER(writeonly, 9, uvec2, samples)
BUFFER(readonly, 10, LdcBody, bodies)
#include "ldc_place.glsl"

shared uint heads[256];     // where the next element of a digit goes
shared uint digits[256];    // the digits of the batch at hand
shared uint histogram[256];

/// One round: elements [start, start + length) from one buffer to the other, by the digit at `shift`.
void sortRound(uint start, uint length, uint shift, bool forward) {
    const uint lane = gl_LocalInvocationIndex;
    histogram[lane] = 0u;
    barrier();
    for (uint i = lane; i < length; i += 256u) {
        const uint id = forward ? unsorted_ids[start + i] : sample_ids[params.first_sample + start + i];
        atomicAdd(histogram[id >> shift & 255u], 1u);
    }
    barrier();
    heads[lane] = histogram[lane];
    barrier();
    for (uint step = 1u; step < 256u; step <<= 1u) {
        const uint other = lane >= step ? heads[lane - step] : 0u;
        barrier();
        heads[lane] += other;
        barrier();
    }
    heads[lane] -= histogram[lane];
    barrier();
    for (uint base = 0u; base < length; base += 256u) {
        const uint batch = min(256u, length - base);
        uint id = 0u, digit = 0u;
        if (lane < batch) {
            id = forward ? unsorted_ids[start + base + lane] : sample_ids[params.first_sample + start + base + lane];
            digit = id >> shift & 255u;
            digits[lane] = digit;
        }
        barrier();
        uint before = 0u, all = 0u;
        if (lane < batch)
            // Sixteen at a time: a software device may bound the loop iterations of an invocation (docs/performance.md).
            for (uint j = 0u; j < batch; j += 16u) {
                [[unroll]] for (uint k = 0u; k < 16u; k++) {
                    const bool same = j + k < batch && digits[j + k] == digit;
                    before += same && j + k < lane ? 1u : 0u;
                    all += same ? 1u : 0u;
                }
            }
        if (lane < batch) {
            const uint to = start + heads[digit] + before;
            if (forward)
                sample_ids[params.first_sample + to] = id;
            else
                unsorted_ids[to] = id;
        }
        barrier();
        if (lane < batch && before == 0u) heads[digit] += all;
        barrier();
    }
    memoryBarrierBuffer();
    barrier();
}

void main() {
    if (!LDC_FITS(counters[0])) return;
    // Fragments that found no room are missing from the lists: everything is redone.
    if (counters[0].fragments > params.fragment_capacity) return;
    const uint count = min(counters[0].long_lists, params.long_capacity);
    if (GROUP_INDEX >= count) return;
    const uint voxel = long_lists[GROUP_INDEX], length = voxel_counts[voxel];
    const uint start = ldcListStart(voxel_table[params.first_node * 64u + voxel]);
    for (uint digit = 0u; digit < 4u; digit++) sortRound(start, length, digit * 8u, (digit & 1u) == 0u);
    for (uint j = gl_LocalInvocationIndex; j < length; j += 256u)
        placeSample(start + j, unsorted_ids[start + j], voxel, j + 1u == length);
}
