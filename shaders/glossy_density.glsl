// What a wide lobe, and the diffuse one beside it, show of the photons around (as Jensen 1996 evaluates all lobes).
#ifndef GLOSSY_DENSITY_GLSL
#define GLOSSY_DENSITY_GLSL
#include "common.glsl"
#include "density.glsl"
#include "directions.glsl"
#include "material.glsl"
#include "normal_map.glsl"
#include "shared_camera.h"
#include "surface.glsl"

// The surface that a query is on, with its mapped normal.
Surface surfaceOf(DeviceScene scene, Query query, Material material) {
    Primitive p = PrimitivePtr(scene.primitives).at[query.primitive];
    vec2 weights = vec2(0.0);
    Surface s;
    if (hasSpheres && (!hasTriangles || query.primitive >= scene.triangleCount)) {
        s = sphereSurface(p, query.position, Hit(0.0, query.primitive, weights));
    } else {
        weights = weightsAt(scene, query.primitive, query.position);
        s = triangleSurface(scene, p, Hit(0.0, query.primitive, weights));
    }
    mapNormal(scene, s, material, weights);
    return s;
}

// What the lobe sends to the viewer of a photon's colour. That has the factor by which light from its direction w
// arrives at the diffuse lobe of the material, if there is one, else the flux through the surface.
vec3 glossyWeight(DeviceScene scene, Material m, Surface s, Query query, vec3 viewer, vec3 w) {
    float pdf, arrived = dot(w, query.normal);
    if (hasWideGlass && arrived < 0.0) return evaluateBeyond(m, s, -viewer, w, pdf) / -arrived;
    if (!(arrived > 0.0)) return vec3(0.0);
    vec3 sent = evaluateGlossyAt(m, s, -viewer, w, pdf);
    if (isDiffuse(m)) {
        vec3 shading = dot(s.normal, query.normal) < 0.0 ? -s.shading : s.shading;
        if (isMapped(s)) arrived = weightOfArrival(scene, m, w, query.normal, shading, -1.0);
        else arrived = max(dot(w, shading), 0.0) * diffuseArrival(scene, m, dot(w, scatteringNormal(s, -w)));
    }
    return arrived > 0.0 ? sent / arrived : vec3(0.0);
}

// Radiance by way of the lobes that ask, per flux of a photon, as estimateWithin has the irradiance.
vec3 estimateByLobes(DeviceScene scene, PhotonMap map, Query query, float radius, out vec3 inner) {
    Material material = materialNear(scene, query.primitive, query.position, SLOT_COLOR);
    Surface surface = surfaceOf(scene, query, material);
    vec3 viewer = unpackUnit(query.viewer), diffuse = vec3(0.0);
    if ((query.lobes & BY_DIFFUSE) != 0u)
        diffuse = diffuseAlbedo(scene, material, dot(viewer, scatteringNormal(surface, -viewer))) / PI;
    Cells cells = cellsAround(map, query.position, query.normal, radius);
    Sums sums = Sums(vec3(0.0), vec3(0.0));
    for (uint corner = 0u; corner < 8u; corner++) {
        uvec2 range = cellRange(map, cells, corner);
        for (uint i = range.x; i < range.y; i++) {
            Photon photon = PhotonPtr(map.photons).at[i];
            vec3 d = photon.position - query.position;
            if (!isNear(d, query, radius) || !isOnSide(map, i, query)) continue;
            vec3 weight = diffuse + glossyWeight(scene, material, surface, query, viewer, unpackUnit(photon.direction));
            addPhoton(map, (hasWideGlass ? abs(photon.color) : photon.color) * weight, dot(d, d), radius, sums);
        }
    }
    float perArea = 1.0 / (PI * radius * radius);
    inner = 2.0 * perArea * sums.inner;
    return perArea * sums.outer;
}

#endif
