// Colours of Mitsuba's files as linear RGB: <rgb>, constant spectra, curves over the wavelength, black bodies.
#pragma once

#include "base/color.h"

#include <string_view>
#include <vector>

namespace opal::mitsuba {

// What a spectrum is for, which decides how it becomes linear RGB.
enum class SpectrumUse {
    reflectance, // and opacities, weights: unbounded textures
    radiance,    // and intensity, irradiance
    index        // eta and k of conductors
};

// One value at all wavelengths, or a curve: linear between its points, 0 outside.
struct Spectrum {
    std::vector<double> wavelengths; // nm, rising; empty: one value at all
    std::vector<double> values;
};

// "0.5", or at least two pairs "400:0.1, 500:0.3", separated by commas or blanks. Throws Error.
Spectrum parse_spectrum(std::string_view text);

// The colour of an <rgb>: one number or three, linear as they stand; or "#rrggbb", which is sRGB-encoded. encoded: the
// numbers are, too. Throws Error.
Color parse_rgb(std::string_view text, bool encoded);

// The colour, which may be negative or above 1. A constant reflectance or index is grey. A radiance is seen as it is,
// so that a constant one has the colour of equal energy; curves of the others are seen in the light of D65.
Color to_rgb(const Spectrum &spectrum, SpectrumUse use);

// The radiance of a black body (Planck's law), in W / (m^2 sr nm) weighed by the CIE's functions. kelvin: above 0.
Color blackbody(double kelvin);

} // namespace opal::mitsuba
