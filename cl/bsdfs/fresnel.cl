// fresnel: reflectance of smooth boundaries between dielectrics, and of metals, for unpolarised light.
#include "core/lanes.cl"
#include "core/math.cl"

typedef struct {
    real eta, inverse_eta; // index of refraction of the far side over that of the near side, and its inverse
    real step;             // eta^2 - 1, computed from differences of the indices
} Boundary;

static Boundary boundary_of(real near, real far) {
    real inverse = 1 / near;
    Boundary b = {far * inverse, near / far, (far - near) * inverse * ((far + near) * inverse)};
    return b;
}

// The cosine of the refracted direction, given sin^2 of the incident one; 0 beyond the critical angle.
static real refracted_cosine(real sin2, Boundary b) { return safe_sqrt(1 - sin2 * square(b.inverse_eta)); }

// Fresnel reflectance, given cosine (0 to 1) and sin^2 of the incident direction. The amplitudes
//   r_s = (c - eta c') / (c + eta c'),  r_p = (eta c - c') / (eta c + c')
// are multiplied out by Snell's law, which leaves no difference of nearly equal products:
//   r_s = (1 - eta^2) / (c + eta c')^2,  r_p = (eta^2 - 1)(c^2 - sin^2/eta^2) / (eta c + c')^2.
static real fresnel_dielectric(real cosine, real sin2, Boundary b) {
    real sin2_far = sin2 * square(b.inverse_eta);
    real far_cosine = refracted_cosine(sin2, b);
    real s = mul_add(b.eta, far_cosine, cosine), p = mul_add(b.eta, cosine, far_cosine), inverse = 1 / (s * p);
    real r_s = -b.step * square(p * inverse);
    real r_p = b.step * (square(cosine) - sin2_far) * square(s * inverse);
    real reflectance = R(0.5) * (r_s * r_s + r_p * r_p);
    return (sin2_far >= 1) ? (real)(1) : real_min(reflectance, (real)(1));
}

// Reflectance of a metal of index eta - i k (Born and Wolf, "Principles of Optics", 14.4.1, as in Lazanyi and
// Szirmay-Kalos 2005, appendix), given cosine and sin^2 as above. With
//   (a - i b)^2 = eta^2 - k^2 - sin^2 - 2 i eta k,
// of a and b the larger one is found by a root and the other as eta k over it, so that neither cancels.
static real fresnel_metal(real cosine, real sin2, real eta, real k) {
    real cos2 = square(cosine);
    real difference = (eta - k) * (eta + k) - sin2, product = eta * k;
    real length = sqrt(square(difference) + 4 * square(product)); // a^2 + b^2
    real larger = sqrt(R(0.5) * (length + fabs(difference)));
    real smaller = product / (larger > 0 ? larger : (real)(1));
    real twice_a_cosine = 2 * cosine * (difference >= 0 ? larger : smaller);
    real s = length + cos2, p = mul_add(length, cos2, square(sin2));
    real r_s = (s - twice_a_cosine) / (s + twice_a_cosine);
    real p_difference = p - twice_a_cosine * sin2, p_sum = p + twice_a_cosine * sin2;
    real r_p = p_sum > 0 ? r_s * p_difference / p_sum : r_s; // an index of 0, seen from above
    return real_max(R(0.5) * (r_s + r_p), (real)(0)); // an index of 1 leaves the rounding
}

static v3 fresnel_conductor(real cosine, real sin2, v3 eta, v3 k) {
    return v3_of(fresnel_metal(cosine, sin2, eta.x, k.x), fresnel_metal(cosine, sin2, eta.y, k.y),
                 fresnel_metal(cosine, sin2, eta.z, k.z));
}
