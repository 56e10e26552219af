// A stable radix sort of one list by one workgroup of 256, with 8-bit digits, linear in the list's length. An even number of rounds
// goes unsorted_ids -> sample_ids -> ... and ends in unsorted_ids. The includer defines radixDigit(value, round).
#extension GL_EXT_control_flow_attributes : require

shared uint heads[256];     // where the next element of a digit goes
shared uint digits[256];    // the digits of the current batch
shared uint histogram[256];

/// One round: elements [start, start + length) from one buffer to the other.
void radixRound(uint start, uint length, uint round, bool forward) {
    const uint lane = gl_LocalInvocationIndex;
    histogram[lane] = 0u;
    barrier();
    for (uint i = lane; i < length; i += 256u) {
        const uint value = forward ? unsorted_ids[start + i] : sample_ids[params.first_sample + start + i];
        atomicAdd(histogram[radixDigit(value, round)], 1u);
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
        uint value = 0u, digit = 0u;
        if (lane < batch) {
            value = forward ? unsorted_ids[start + base + lane] : sample_ids[params.first_sample + start + base + lane];
            digit = radixDigit(value, round);
            digits[lane] = digit;
        }
        barrier();
        uint before = 0u, all = 0u;
        if (lane < batch)
            // Sixteen at a time: a software device may bound the loop iterations of an invocation (docs/lab_notes.md).
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
                sample_ids[params.first_sample + to] = value;
            else
                unsorted_ids[to] = value;
        }
        barrier();
        if (lane < batch && before == 0u) heads[digit] += all;
        barrier();
    }
    memoryBarrierBuffer();
    barrier();
}
