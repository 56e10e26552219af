// What shaders and the reference must agree on: the definitions behind a picture, where they are numbers. How to
// compute with them each says for itself. Macros, so that they are double precision in the reference.
#ifndef PEELRAY_SHADING_NUMBERS_H
#define PEELRAY_SHADING_NUMBERS_H

// Luminance of linear Rec. 709, by channel.
#define LUMINANCE_RED 0.2126
#define LUMINANCE_GREEN 0.7152
#define LUMINANCE_BLUE 0.0722

// Perceptual roughness below which a surface is a mirror: punctual lights leave no highlight, rays see the sun's disc.
#define MIRROR_ROUGHNESS 0.05
// With several samples per pixel the reflection of an opaque surface is traced below this roughness, or where it is
// metal for the most part.
#define TRACED_ROUGHNESS 0.6
#define MOSTLY_METAL 0.5
// With one sample tracing fades out between these.
#define FADE_FIRST_ROUGHNESS 0.2
#define FADE_LAST_ROUGHNESS 0.5
// Branches that carry less than this share of the pixel are not traced: they see the environment. Shadow rays that let
// less through count as blocked.
#define LEAST_WEIGHT (1.0 / 512.0)
// Layers of glass that a shadow ray passes before it counts as blocked.
#define SHADOW_LAYERS 16

// Cosine to a triangle's normal below which a shading normal counts as lying in the triangle's plane.
#define NORMAL_IN_PLANE 1e-4
// Cosine to a triangle's normal below which a corner's normal says nothing about the surface that the triangle stands
// for.
#define STRAY_NORMAL 0.1
// A shadow ray that passes its own triangle's plane this close beside the triangle, in weights of the corners, still
// passes through it.
#define OWN_TRIANGLE_RIM 1e-4
// Cosine to which shading normals are bent towards the viewer, and reflected directions lifted above the surface.
#define LEAST_COSINE 1e-3
// Cosine that shading takes for the viewer's at least.
#define GRAZING_COSINE 1e-4

// Rounding of a hit's position, of the largest coordinate of its triangle, in single precision.
#define POSITION_ROUNDING 1e-6
// Rounding of the distance along a ray at which it hits, of the distance, in single precision.
#define DISTANCE_ROUNDING 2.5e-7
// Walls of media that are parallel and at most this far apart, of the largest coordinate of the triangle, are one wall,
// whose media light enters and leaves at once: as far as single precision may move either.
#define WALLS_APART 2e-6
// Cosine between the normals of two triangles from which on they count as parallel.
#define WALLS_PARALLEL 0.9
// Rays start this many times as far from such a wall, to be beyond all of it.
#define WALLS_LIFT 1.5
// Media that a ray may be in at once.
#define MEDIA_TOGETHER 4
// Walls that count as one at most, and walls in a row at which the medium stays the same that a ray passes without a
// bounce.
#define WALLS_TOGETHER 4
#define WALLS_PASSED 32

// Planar hits: a ray of unit direction starts at most this many times the height that it has to gain from its surface.
#define FLATTEST_START 4.0
// Slopes below this count as this.
#define LEAST_SLOPE 1e-6
// An alpha this little below the cutoff counts as reaching it: rounding makes no holes where both are equal.
#define ALPHA_ROUNDING 1e-6

// An alpha from here on is all: interpolation rounds.
#define ALPHA_WHOLE 0.99999

// Blended surfaces that a path goes straight through before they count as bounces.
#define BLENDED_PASSED 8

// Reflectance of a clear coat at normal incidence (KHR_materials_clearcoat).
#define COAT_REFLECTANCE 0.04
// Roughness of a sheen at least: its lobe's exponent is the inverse of the fourth power.
#define SHEEN_LEAST_ROUGHNESS 0.07
// Reflectance of what is below a thin film at most: all of it would take an infinite index of refraction.
#define FILM_MOST_REFLECTANCE 0.9999
// How often the light that interferes has gone to and fro in a film at most. Above a dielectric each time leaves less than
// a third; above the best mirrors, seen at 6 degrees, 0.7, so that 0.02 is missing there.
#define FILM_ORDERS 10
// Of (index - 1) per unit of KHR_materials_dispersion: how far the indices of red and blue are from the middle.
#define DISPERSION_SPREAD 0.025

// The picture of the environment that the camera sees with --env-visible blurred: its size, and the deviation of the normal
// distribution that blurs it. Its texels are less than half of that.
#define BLURRED_WIDTH 128
#define BLURRED_HEIGHT 64
#define BLURRED_RADIANS 0.12

// What random numbers are for.
#define RANDOM_MICROFACET 1
#define RANDOM_SKY 2
#define RANDOM_COAT 3
#define RANDOM_ENVIRONMENT 4
#define RANDOM_DIFFUSE 5
#define RANDOM_EMITTER 6
#define RANDOM_EMITTER_POINT 7
#define RANDOM_LAMP_CHOICE 8
#define RANDOM_EMITTER_ROULETTE 11
#define RANDOM_ROULETTE 12  // and which branch; all kinds of roulette are of the CPU tracer
#define RANDOM_ENVIRONMENT_ROULETTE 15
#define RANDOM_LAMP 16  // and the lamp's index

// Of more lamps with a place in the scene than this, sampled hits draw one: of so many that are tried, chosen by their
// intensity, one by what it would bring (resampled importance sampling).
#define LAMPS_EACH 8
#define LAMPS_TRIED 8

// Of the way to a point of an emissive triangle, what a shadow ray leaves out so that it does not meet the triangle.
#define EMITTER_GAP 1e-4

// The seed of a path's random numbers: a code of the pixel above RANDOM_BRANCH_BITS that tell the branches taken.
#define RANDOM_BRANCH_BITS 8

#endif
