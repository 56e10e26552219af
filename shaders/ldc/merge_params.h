// Copies of small bodies that share a cube: merge_*.comp (src/render/merged_instances).
#ifndef PEELRAY_MERGE_PARAMS_H
#define PEELRAY_MERGE_PARAMS_H

#include "common/shared.h"

#ifdef __cplusplus
namespace peelray {
#endif

/// An instance and where its copy begins.
struct MergedInstance {
    uint instance;
    uint body_triangle;  ///< first of its body
    uint body_vertex;
    uint triangle;  ///< first of the copy
    uint triangles;
    uint vertex;
    uint vertices;
};
SHARED_SIZE(MergedInstance, 28);

struct MergeParams {
    uint groups;  ///< of 64 triangles or vertices of one instance
    uint first_copy;  ///< triangle
    uint body;
};
SHARED_SIZE(MergeParams, 12);

#ifdef __cplusplus
}  // namespace peelray
#endif
#endif
