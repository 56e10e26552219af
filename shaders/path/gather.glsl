// The light of the tree of rays, from the leaves back to the root. Include after the buffers next_nodes, branches and shadow_light.
#ifndef PEELRAY_GATHER_GLSL
#define PEELRAY_GATHER_GLSL

#include "path/path_params.h"
#include "path/shading.glsl"

/// A node's radiance and what arrives along its shadow rays, always added in the same order.
vec3 litRadiance(PathNode node) {
    vec3 sum = node.radiance;
    const uint end = min(node.first_light + (node.flags & NODE_LIGHTS), params.light_capacity);
    for (uint k = node.first_light; k < end; k++) sum += shadow_light[k];
    return sum;
}

/// What the children of node `i` send it.
vec3 childrenRadiance(uint i, PathNode node) {
    vec3 sum = vec3(0);
    if ((node.flags & NODE_BRANCHES) == 0u) return sum;
    const PathBranches children = branches[i];
    if (children.child0 < params.next_capacity) sum += children.weight0 * litRadiance(next_nodes[children.child0]);
    if (children.child2 < params.next_capacity) sum += children.weight2 * litRadiance(next_nodes[children.child2]);
    if (children.child1 >= params.next_capacity) return sum;
    vec3 second = litRadiance(next_nodes[children.child1]);
    if ((node.flags & NODE_DISPERSED) != 0u && children.child1 + 2u < params.next_capacity) {
        second.g = litRadiance(next_nodes[children.child1 + 1u]).g;
        second.b = litRadiance(next_nodes[children.child1 + 2u]).b;
    }
    sum += children.weight1 * second;
    return sum;
}

/// A NODE_CATCHER as another node: with all of its light, and nothing more to be added.
PathNode caughtNode(uint i, PathNode node) {
    vec3 mirrored = vec3(0), left = litRadiance(node);
    if ((node.flags & NODE_BRANCHES) != 0u) {
        const PathBranches children = branches[i];
        if (children.child0 < params.next_capacity) {
            const PathNode next = next_nodes[children.child0];
            // A mirror image covers what is behind; where there is none, nothing is mirrored.
            if ((next.flags & NODE_SURFACE) != 0u) {
                mirrored = children.weight0 * litRadiance(next);
                left *= 1.0 - children.weight0;
            }
        }
    }
    if ((node.flags & NODE_SHARE) != 0u) return PathNode(mirrored, floatBitsToUint(luminance(left)), NODE_BACKDROP);
    return PathNode(mirrored + left, 0u, 0u);
}

/// Share of the backdrop's light that comes to node `i` straight through blended surfaces, where the picture is transparent.
float backdropShare(uint i, PathNode node) {
    if ((node.flags & NODE_BACKDROP) != 0u) return uintBitsToFloat(node.first_light);
    if ((node.flags & NODE_BRANCHES) == 0u) return 0.0;
    const PathBranches children = branches[i];
    if (children.child1 == BACKDROP_CHILD) return luminance(children.weight1);
    if (children.child1 >= params.next_capacity) return 0.0;
    const PathNode next = next_nodes[children.child1];
    return (next.flags & NODE_BACKDROP) != 0u ? luminance(children.weight1) * uintBitsToFloat(next.first_light) : 0.0;
}

#endif
