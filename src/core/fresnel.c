/* fresnel.c - asperity.h section 6 as functions */
#include "asperity.h"

#define ASP_PRECISION 64
#include "asperity/fresnel.h"

double asp_fresnel_dielectric(double c, double eta) { return aspi_fresnel_dielectric(c, eta); }
double asp_fresnel_conductor(double c, double eta, double k) { return aspi_fresnel_conductor(c, eta, k); }
double asp_fresnel_schlick(double c, double f0) { return aspi_fresnel_schlick(c, f0); }
double asp_fresnel_f82(double c, double f0, double tint) { return aspi_fresnel_f82(c, f0, tint); }

#undef ASP_PRECISION
#define ASP_PRECISION 32
#include "asperity/fresnel.h"

float asp_fresnel_dielectricf(float c, float eta) { return aspi_fresnel_dielectric(c, eta); }
float asp_fresnel_conductorf(float c, float eta, float k) { return aspi_fresnel_conductor(c, eta, k); }
float asp_fresnel_schlickf(float c, float f0) { return aspi_fresnel_schlick(c, f0); }
float asp_fresnel_f82f(float c, float f0, float tint) { return aspi_fresnel_f82(c, f0, tint); }
