// The auxiliary pictures, a line each: AOV(name, type, channels, nothing). Names, files, help and the records that
// shaders write follow from here; what is left to do is to set the value in the one place that is named.
//   type      of a pixel's value, in shaders and on the host: float, vec4, ...
//   channels  of the file: distance, index, scalar, vector, color, motion, directions, cost (src/cli/picture_files.cpp)
//   nothing   the value where the camera sees nothing
#ifndef PEELRAY_AOV_TABLE_H
#define PEELRAY_AOV_TABLE_H

// What the camera sees at the pixel centres, in the world: set in aov.comp and in src/reference/path_tracer.cpp.
//   depth     distance along the camera ray
//   position  w: 1 where there is a surface
//   triangle, instance, material: numbers; of an instance the one of its Geometry::Object
#define SEEN_AOVS(AOV)                        \
    AOV(depth, float, distance, AOV_INFINITY) \
    AOV(normal, vec4, vector, 0)              \
    AOV(albedo, vec4, color, 0)               \
    AOV(position, vec4, vector, 0)            \
    AOV(triangle, float, index, -1)           \
    AOV(instance, float, index, -1)           \
    AOV(material, float, index, -1)

// And how it moves, made only where it is asked for: set in aov_motion.comp and in src/reference/path_tracer.cpp.
//   motion    from where the point is in the picture to where it was at the moment before, pixels, right and up
#define MOTION_AOVS(AOV) AOV(motion, vec2, motion, 0)

// All of what is seen.
#define SURFACE_AOVS(AOV) \
    SEEN_AOVS(AOV)        \
    MOTION_AOVS(AOV)

// What the paper sets up for every mirror ray (its Figure 7): set in ray_setup_store.comp and in
// src/reference/path_tracer.cpp.
//   reflection  direction of the ray
//   box         where it leaves the scene's box
//   directions  its direction in the x-LDI (y, z), in the y-LDI (z, x), in the z-LDI (x, y), two zeros
#define RAY_SETUP_AOVS(AOV)          \
    AOV(reflection, vec4, vector, 0) \
    AOV(box, vec4, vector, 0)        \
    AOV(directions, mat2x4, directions, 0)

// What a pixel's samples are like, made only where it is asked for: set in src/render/picture_output.cpp from what
// accumulate.comp adds up, and in src/reference/sample_sums.cpp.
//   variance      of the mean of the samples' luminances: how far the picture may be from what it converges to, squared
//   sample_count  how many samples there are
#define SAMPLE_AOVS(AOV)       \
    AOV(variance, float, scalar, 0) \
    AOV(sample_count, float, scalar, 0)

// What all rays of a pixel cost, of all samples: the fields of RayCosts, counted by counting.glsl. These are last.
#define COST_AOVS(AOV)               \
    AOV(cost_steps, uint, cost, 0)   \
    AOV(cost_cells, uint, cost, 0)   \
    AOV(cost_pixels, uint, cost, 0)  \
    AOV(cost_samples, uint, cost, 0) \
    AOV(cost_triangles, uint, cost, 0)

#endif
