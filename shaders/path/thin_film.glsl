// Interference in a thin film (KHR_materials_iridescence): what is reflected to and fro between its faces, summed with its phases
// (Airy), for each polarisation, and the mean over what red, green and blue see. The table of tables.h has the mean of
// each order. As Belcour, Barla: A Practical Extension to Microfacet Theory for the Modeling of Varying Iridescence (2017) have it,
// but with the colours' own curves and with Fresnel's exact formulas. Include after the buffer lookups.
#ifndef PEELRAY_THIN_FILM_GLSL
#define PEELRAY_THIN_FILM_GLSL

#extension GL_EXT_control_flow_attributes : require

#include "path/shading_numbers.h"
#include "path/tables.h"

/// Index of refraction of what reflects this much at normal incidence.
vec3 metalIndex(vec3 f0) {
    const vec3 root = sqrt(clamp(f0, vec3(0), vec3(FILM_MOST_REFLECTANCE)));
    return (1.0 + root) / (1.0 - root);
}

/// Mean of cos(2π way / λ); `way`: nm.
vec3 filmMean(float way) {
    const float at = min(way / FILM_STEP, float(FILM_ENTRIES - 1)), part = fract(at);
    const uint i = TABLE_FILM + uint(at);
    return mix(lookups[i].rgb, lookups[min(i + 1u, TABLES_END - 1u)].rgb, part);
}

/// Reflectance at `cosine` ≥ 0 of a film of this thickness (nm) and index, between air and what has the index `base`.
vec3 thinFilm(float thickness, float index, vec3 base, float cosine) {
    cosine = max(cosine, GRAZING_COSINE);  // along the surface a film like air would be 0 over 0
    const float within = sqrt(index * index - 1.0 + cosine * cosine) / index;
    const vec3 below = sqrt(base * base - 1.0 + cosine * cosine) / base;
    // Amplitudes of the upper and the lower face, across the plane of incidence and in it.
    const float across1 = (cosine - index * within) / (cosine + index * within), along1 = (index * cosine - within) / (index * cosine + within);
    const vec3 across2 = (index * within - base * below) / (index * within + base * below);
    const vec3 along2 = (base * within - index * below) / (base * within + index * below);
    const vec3 across = across1 * across2, along = along1 * along2;
    // 1 - R = T (1 + 2 Σ (-q)^k cos(k φ)), q: the product of the amplitudes, T: what passes without interference.
    vec3 across_sum = vec3(1), along_sum = vec3(1), across_power = vec3(2), along_power = vec3(2);
    // Written out, this would be most of what a compiler has to do for a pass that shades.
    [[dont_unroll]] for (int k = 1; k <= FILM_ORDERS; k++) {
        const vec3 mean = filmMean(2.0 * float(k) * index * thickness * within);
        across_power *= -across;
        along_power *= -along;
        across_sum += across_power * mean;
        along_sum += along_power * mean;
    }
    const vec3 across_passed = (1.0 - across1 * across1) * (1.0 - across2 * across2) / (1.0 - across * across);
    const vec3 along_passed = (1.0 - along1 * along1) * (1.0 - along2 * along2) / (1.0 - along * along);
    return clamp(1.0 - 0.5 * (across_passed * across_sum + along_passed * along_sum), vec3(0), vec3(1));
}

#endif
