// Items that a workgroup's first LDC_OWNERS threads have, so many each, numbered through so that all its threads can share them. Define
// LDC_OWNERS, a power of two and at most the workgroup's size.
#ifndef LDC_SHARED_ITEMS_GLSL
#define LDC_SHARED_ITEMS_GLSL

shared uint items_up_to[LDC_OWNERS];  // those of an owner and of the owners before

/// Numbers the items through, of which this thread has `count` (0 where it is no owner). Returns how many there are. All threads must call.
uint ldcNumberItems(uint count) {
    const uint lane = gl_LocalInvocationIndex;
    const bool owns = lane < LDC_OWNERS;
    if (owns) items_up_to[lane] = count;
    barrier();
    for (uint step = 1u; step < LDC_OWNERS; step *= 2u) {
        if (owns && lane >= step) count += items_up_to[lane - step];
        barrier();
        if (owns) items_up_to[lane] = count;
        barrier();
    }
    return items_up_to[LDC_OWNERS - 1u];
}

/// Whose item number `i` is; `rank`: how many of its owner's come before.
uint ldcOwnerOf(uint i, out uint rank) {
    uint owner = 0u;
    for (uint step = LDC_OWNERS / 2u; step > 0u; step /= 2u) owner += items_up_to[owner + step - 1u] <= i ? step : 0u;
    rank = i - (owner == 0u ? 0u : items_up_to[owner - 1u]);
    return owner;
}

#endif
