// Smooth boundaries between dielectrics, in double.
#pragma once

#include <cmath>

namespace opal {

// Fresnel's reflectance for unpolarised light at that cosine of incidence, of a boundary to a medium of relative index
// eta, and the cosine of the refracted direction, which is 0 where all is reflected.
struct Fresnel {
    double reflectance = 1, refracted = 0;
    Fresnel(double cosine, double eta) {
        const auto square = [](double x) { return x * x; };
        const double sine2 = (1 - square(cosine)) / square(eta);
        if (sine2 >= 1)
            return;
        refracted = std::sqrt(1 - sine2);
        reflectance = (square((cosine - eta * refracted) / (cosine + eta * refracted)) +
                       square((eta * cosine - refracted) / (eta * cosine + refracted))) /
                      2;
    }
};

} // namespace opal
