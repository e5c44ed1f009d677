// Microfacets of GGX (Walter et al. 2007) with height-correlated masking and shadowing of Smith (Heitz 2014).
// Directions point away from the surface; n is the normal on their side, alpha the square of the roughness that artists
// see (Burley 2012).
#ifndef GGX_GLSL
#define GGX_GLSL
#include "common.glsl"
#include "directions.glsl"
#include "sampling.glsl"
#include "scattering.glsl"

// Schlick's reflectance (1994, eq. 15) of a metal or a coat, from those at normal and at grazing incidence.
vec3 schlick(vec3 normalIncidence, float grazing, float cosine) {
    float x = 1.0 - min(1.0, cosine);
    float x2 = x * x;
    return normalIncidence + (grazing - normalIncidence) * (x2 * x2 * x);
}

vec3 schlick(vec3 normalIncidence, float cosine) { return schlick(normalIncidence, 1.0, cosine); }

// Density of microfacet normals h per area (Walter et al. 2007, eq. 33). The sine comes from a cross product: written
// by the cosine, the peak of a narrow lobe would be rounded away.
float ggxDensity(float alpha, vec3 n, vec3 h) {
    vec3 across = cross(n, h);
    float cosine = dot(n, h);
    float a2 = alpha * alpha;
    float d = a2 * cosine * cosine + dot(across, across);
    return a2 / (PI * d * d);
}

// The length of a direction of cosine z after the ellipsoid of the facets became a sphere: Smith's functions are made
// of it, G1 = 2 z / (z + length).
float stretched(float alpha, float z) { return sqrt(z * z + alpha * alpha * max(0.0, 1.0 - z * z)); }

// Part of the cap of visible normals whose reflections do not go below the horizon (Eto & Tokuyoshi 2023, eq. 5).
float boundedCap(float alpha, float z) {
    float s = 1.0 + sqrt(max(0.0, 1.0 - z * z));
    float s2 = s * s, a2 = alpha * alpha;
    return (1.0 - a2) * s2 / (s2 + a2 * z * z);
}

// Density over solid angle with which sampleGgx sends wo to wi.
float ggxPdf(float alpha, vec3 n, vec3 wo, vec3 wi) {
    float z = dot(wo, n);
    return ggxDensity(alpha, n, normalize(wo + wi)) / (2.0 * (boundedCap(alpha, z) * z + stretched(alpha, z)));
}

// Correlated G2 over 4 cos(wo) cos(wi), times cos(wi): the value of the lobe is this times density and reflectance.
float ggxVisibility(float alpha, float zo, float zi) {
    return zi / (2.0 * (zi * stretched(alpha, zo) + zo * stretched(alpha, zi)));
}

// The value of facets that reflect all light, times the cosine of wi; h is half-way between wo and wi.
float ggxValue(float alpha, vec3 n, vec3 h, vec3 wo, vec3 wi) {
    return ggxDensity(alpha, n, h) * ggxVisibility(alpha, dot(wo, n), dot(wi, n));
}

// Density over solid angle of reflections at all facets that wo sees.
float visibleFacetPdf(float alpha, vec3 n, vec3 h, vec3 wo) {
    float z = dot(wo, n);
    return ggxDensity(alpha, n, h) / (2.0 * (z + stretched(alpha, z)));
}

// A facet's normal in proportion to what wo sees of it, from the part k of the cap of visible normals (Dupuy & Benyoub
// 2023): 1 for all of them.
vec3 sampleFacet(float alpha, vec3 n, vec3 wo, float k, vec2 u) {
    float z = min(1.0, dot(wo, n)), stretch = stretched(alpha, z);
    float height = u.y * (1.0 + k * z / stretch); // of the cap's point below its top
    vec3 cap = vec3(sqrt(max(0.0, height * (2.0 - height))) * unitCircle(u.x), 1.0 - height);
    vec3 facet = mix(z * n, wo, alpha) / stretch + toWorld(cap, n);
    return normalize(mix(dot(facet, n) * n, facet, alpha));
}

// A reflection of the lobe of a metal or coat, by the facets that do not reflect below the horizon (Eto & Tokuyoshi
// 2023); its weight is the value over the density.
Scattering sampleGgx(float alpha, vec3 normalIncidence, vec3 d, vec3 n, vec2 u) {
    float z = min(1.0, -dot(d, n)), stretch = stretched(alpha, z), k = boundedCap(alpha, z);
    vec3 h = sampleFacet(alpha, n, -d, k, u), wi = reflect(d, h);
    float zi = max(0.0, dot(wi, n));
    float weight = zi * (k * z + stretch) / (zi * stretch + z * stretched(alpha, zi));
    return Scattering(wi, weight * schlick(normalIncidence, -dot(d, h)), n, 1.0, ggxPdf(alpha, n, -d, wi));
}

// The value of that lobe, times the cosine of wi.
vec3 evaluateGgx(float alpha, vec3 normalIncidence, vec3 n, vec3 wo, vec3 wi) {
    vec3 h = normalize(wo + wi);
    return ggxValue(alpha, n, h, wo, wi) * schlick(normalIncidence, dot(wo, h));
}

// Correlated G2 over G1 of wo, by the cosines of both directions, whatever their sides.
float maskingOfOther(float alpha, float zo, float zi) {
    float stretch = stretched(alpha, zo);
    return zi * (zo + stretch) / (zi * stretch + zo * stretched(alpha, zi));
}

#endif
