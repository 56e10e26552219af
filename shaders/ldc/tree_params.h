// The hierarchy of instances: instances.comp and tree_*.comp (src/ldc/instances).
#ifndef PEELRAY_TREE_PARAMS_H
#define PEELRAY_TREE_PARAMS_H

#include "common/shared.h"

#ifdef __cplusplus
namespace peelray {
#endif

struct InstanceParams {
    uint count;
    uint boxes;   ///< that have one in the hierarchy: all of them, but where some are merged
    uint padded;  ///< rounded up to a multiple of 8
    uint slots;   ///< of up to 8 boxes where they go, four bits each: those of bare bodies first
};
SHARED_SIZE(InstanceParams, 16);

/// What becomes of an instance where some are merged.
struct InstanceRole {
    uint box;     ///< its number among those that have one; INSTANCE_MERGED: it has none
    uint copies;  ///< of a merged one: added to the number of a triangle, that of its copy
};
SHARED_SIZE(InstanceRole, 8);
#define INSTANCE_MERGED 0xffffffffu

/// Parameters of all tree_* passes.
struct TreeParams {
    PeelrayTree tree;
    uint bits;    ///< of each axis of a Morton code
    uint level;   ///< tree_level: which
    uint boxes;   ///< of the level
    uint filled;  ///< the same, filled up to a multiple of 8
};
SHARED_SIZE(TreeParams, 56);
#define TREE_SMALL 1024

/// An instance's place in the order of the hierarchy, before it is sorted.
struct TreeKey {
    uint bucket;
    uint slot;  ///< in its bucket, in the order in which the atomics happened to run
};
SHARED_SIZE(TreeKey, 8);

#ifdef __cplusplus
}  // namespace peelray
#endif
#endif
