// The stack of media that a ray is in, and which of them counts: the one of the lowest rank. Include after the buffers
// materials and media_ranks (MediaRanks: the number of materials, rank by material, material by rank).
#ifndef PEELRAY_MEDIA_GLSL
#define PEELRAY_MEDIA_GLSL

#include "common/material.h"
#include "path/interface.glsl"
#include "path/media_params.h"
#include "path/path_params.h"

const MediaStack MEDIA_AIR = MediaStack(0u, 0u);
const uint MEDIA_NO_RANK = 0xffffffffu;

uvec4 mediaEntries(MediaStack s) { return uvec4(s.low & 0xffffu, s.low >> 16u, s.high & 0xffffu, s.high >> 16u); }
MediaStack mediaPack(uvec4 e) { return MediaStack(e.x | e.y << 16u, e.z | e.w << 16u); }

/// Is the ray in the medium?
bool mediaHold(MediaStack stack, uint rank) { return any(equal(mediaEntries(stack) >> 4u, uvec4(rank + 1u))); }

/// A ray of this thread has been in more media than its stack holds.
bool media_crowded = false;

/// The ray enters a medium. A fifth one makes the stack forget that of the last rank.
MediaStack mediaEnter(MediaStack stack, uint rank) {
    uvec4 e = mediaEntries(stack);
    uint moving = (rank + 1u) << 4u | 1u;
    for (int i = 0; i < 4; i++) {
        if (e[i] >> 4u == rank + 1u) {
            e[i] += (e[i] & 15u) < 15u ? 1u : 0u;
            return mediaPack(e);
        }
        if (e[i] == 0u || e[i] > moving) {
            const uint next = e[i];
            e[i] = moving;
            moving = next;
            if (moving == 0u) return mediaPack(e);
        }
    }
    media_crowded = true;
    return mediaPack(e);
}

/// The ray leaves a medium, if it is in it.
MediaStack mediaLeave(MediaStack stack, uint rank) {
    uvec4 e = mediaEntries(stack);
    for (int i = 0; i < 4; i++) {
        if (e[i] >> 4u != rank + 1u) continue;
        e[i]--;
        if ((e[i] & 15u) != 0u) break;
        for (int k = i; k < 3; k++) e[k] = e[k + 1];
        e[3] = 0u;
        break;
    }
    return mediaPack(e);
}

/// How often the ray has entered the medium.
uint mediaDepth(MediaStack stack, uint rank) {
    const uvec4 e = mediaEntries(stack);
    uint depth = 0u;
    for (int i = 0; i < 4; i++) depth += e[i] >> 4u == rank + 1u ? e[i] & 15u : 0u;
    return depth;
}

/// Material of the medium that counts; MEDIUM_NONE: air.
uint mediaMaterial(MediaStack stack) {
    const uint first = stack.low & 0xffffu;
    return first == 0u ? MEDIUM_NONE : media_ranks[media_ranks[0] + (first >> 4u)];
}

/// Rank of a material's medium; MEDIA_NO_RANK: it fills no volume.
uint mediaRank(uint material) { return media_ranks[1u + material]; }

/// Index of refraction of a medium for a ray of this RAY_CHANNEL.
float mediaIndex(uint material, uint channel) { return material == MEDIUM_NONE ? 1.0 : materialIndex(material, channel); }

/// A wall of media as a ray of this channel meets it.
Interface mediaInterface(MediaWall wall, uint channel) {
    vec3 etas = vec3(mediaIndex(wall.to, channel) / mediaIndex(wall.from, channel));
    if (dispersive && channel == 0u) {
        etas.r = mediaIndex(wall.to, 1u) / mediaIndex(wall.from, 1u);
        etas.b = mediaIndex(wall.to, 3u) / mediaIndex(wall.from, 3u);
    }
    return interfaceOf(etas, wall.to == MEDIUM_NONE, wall.from != MEDIUM_NONE && wall.to != MEDIUM_NONE);
}

#endif
