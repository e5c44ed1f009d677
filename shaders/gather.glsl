// Adds what the photon map estimates at each point asked for, and by how much blur makes that wrong. A disc of radius r
// has the expectation E + c r^2 Laplace(E) + O(r^4), where c is the kernel's (Silverman 1986, section 4.3; 1/8 for the
// constant one): the difference to a disc of half the area is half of the bias (as in Hachisuka, Jarosz & Jensen 2010,
// from two radii).
#ifndef GATHER_GLSL
#define GATHER_GLSL
#include "common.glsl"
#include "density.glsl"
#include "film_layout.glsl"
#include "radius_field.glsl"
#include "shared_camera.h"
#include "shared_film.h"

// Answers the query of a path, unless a map of narrow discs leaves that to the next one. What is added to the samples
// is `radiance`, and `bias` to those of bias.
bool gather(PhotonMap map, Query query, out vec3 radiance, out vec3 bias) {
    float radius = hasNearest && map.nearest > 0u ? nearestRadius(map, query, map.nearest) * map.shrink
                                                  : radiusAt(map, query.position);
    if (map.partial != 0u) {
        // What is narrower than a pixel is not seen, and most paths from the eye would miss it.
        radius = radius > 0.0 ? max(radius, map.shrink * query.footprint) : GREATEST;
        if (radius > map.radius) return false;
    }
    vec3 inner;
    vec3 irradiance = estimateWithin(map, query, radius, inner) * map.photonFlux;
    radiance = query.weight * irradiance;
    bias = 2.0 * query.weight * (irradiance - inner * map.photonFlux);
    return true;
}

#endif
