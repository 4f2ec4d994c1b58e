// fresnel: reflectance of a smooth boundary between dielectrics, unpolarised.

// The cosine of the refracted direction, given sin^2 on the near side and eta = far / near index; 0 beyond the critical angle.
static real refracted_cosine(real sin2, real eta) { return safe_sqrt(1 - sin2 / square(eta)); }

// Fresnel reflectance for cosine and sin^2 on the near side (indices near, far). The amplitudes
//   r_s = (c - eta c') / (c + eta c'),  r_p = (eta c - c') / (eta c + c')
// are multiplied out by Snell's law, so that no difference of nearly equal products is left:
//   r_s = (1 - eta^2) / (c + eta c')^2,  r_p = (eta^2 - 1)(c^2 - sin^2/eta^2) / (eta c + c')^2.
static real fresnel_dielectric(real cosine, real sin2, real near, real far) {
    real eta = far / near;
    real sin2_far = sin2 / square(eta);
    real far_cosine = safe_sqrt(1 - sin2_far);
    real step = (far - near) * (far + near) / square(near); // eta^2 - 1
    real r_s = -step / square(mul_add(eta, far_cosine, cosine));
    real r_p = step * (square(cosine) - sin2_far) / square(mul_add(eta, cosine, far_cosine));
    real reflectance = R(0.5) * (r_s * r_s + r_p * r_p);
    return (sin2_far >= 1) ? (real)(1) : real_min(reflectance, (real)(1));
}
