// Tabulated means over the microfacets that the view of a GGX surface meets, for the split sum (Karis: Real Shading in
// Unreal Engine 4, 2013): what a rough surface reflects of white light. Entry (r, c) is for the roughness
// (r / (SPLIT_SUM_SIDE - 1))² and the cosine (c / (SPLIT_SUM_SIDE - 1))² between view and normal; its four values are
// the means of (1 - v·h)^k, k = 0 and then these exponents, times the masking of the reflected direction. Fresnel's
// formulas are sums of such powers: Schlick's is one (the second), and the exact one is fitted by all four
// (src/render/fresnel_fit.h).
#ifndef PEELRAY_SPLIT_SUM_H
#define PEELRAY_SPLIT_SUM_H

#define SPLIT_SUM_SIDE 64
#define SPLIT_SUM_FLAT_EXPONENT 2
#define SPLIT_SUM_SCHLICK_EXPONENT 5
#define SPLIT_SUM_STEEP_EXPONENT 12

#endif
