// What of the light a rough surface reflects, for the tests of pictures. Here because it is optimised here.
#pragma once

#include <functional>

namespace peelray {

/// Mean of value(v·h) over what the view of a GGX surface reflects: D·G1(v)·G1(l)·(v·h)/(n·v) over the microfacets h,
/// by quadrature in rings tan² = alpha² u / (1 - u) of the same share of D·(n·h), which crowd at u = 1, where steep
/// microfacets reflect what grazes. With a reflectance as the value: the share of white light that is reflected.
double ggx_mean(double cosine, double roughness, const std::function<double(double)>& value);

}  // namespace peelray
