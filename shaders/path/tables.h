// Tables that shading looks numbers up in. They stand before the environment's texels in one buffer (passes that shade bind
// as many buffers as any device allows), four numbers an entry, and are made when the program is built
// (src/render/tables/tabulate.cpp).
#ifndef PEELRAY_TABLES_H
#define PEELRAY_TABLES_H

// Means over the microfacets that the view of a GGX surface meets, for the split sum (Karis: Real Shading in Unreal Engine
// 4, 2013): what a rough surface reflects of white light. Entry (r, c) is for the roughness (r / (SPLIT_SUM_SIDE - 1))² and
// the cosine (c / (SPLIT_SUM_SIDE - 1))² between view and normal; its four values are the means of (1 - v·h)^k, k = 0 and
// then these exponents, times the masking of the reflected direction. Fresnel's formulas are sums of such powers: Schlick's
// is one (the second), and the exact one is fitted by all four (src/render/fresnel_fit.h).
#define SPLIT_SUM_SIDE 64
#define SPLIT_SUM_FLAT_EXPONENT 2
#define SPLIT_SUM_SCHLICK_EXPONENT 5
#define SPLIT_SUM_STEEP_EXPONENT 12

// What a white sheen reflects of white light (Estevez, Kulla: Production Friendly Microfacet Sheen BRDF, 2017), in the
// first value, by roughness and cosine alike.
#define SHEEN_SIDE 64

// The light that a thin film's two faces reflect interferes: entry i is the mean of cos(2π D / λ) over the wavelengths that
// red, green and blue see, for the difference D = i · FILM_STEP of the two ways. It fades as D grows. A step of a fiftieth
// of a wavelength bends a cosine by 0.002 at most.
#define FILM_ENTRIES 2048
#define FILM_STEP 8.0 // nm

#define TABLE_SPLIT_SUM 0u
#define TABLE_SHEEN (TABLE_SPLIT_SUM + SPLIT_SUM_SIDE * SPLIT_SUM_SIDE)
#define TABLE_FILM (TABLE_SHEEN + SHEEN_SIDE * SHEEN_SIDE)
#define TABLES_END (TABLE_FILM + FILM_ENTRIES)

#endif
